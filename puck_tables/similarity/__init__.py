"""The motion's symmetry at work: stops and states by look-up, nothing integrated."""
