"""Where and when pucks stop, and the way there: look-up, sections, sweeps, aim."""
