"""Tracks of real pucks: what a film tells, read from the files that people have."""
