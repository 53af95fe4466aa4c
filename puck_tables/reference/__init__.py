"""Named motions with their exact answer, and what an engine's run of one of them is off by."""
