"""Stops and states for programs that differentiate: one module for each such library."""
