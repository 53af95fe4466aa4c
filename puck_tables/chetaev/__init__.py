"""Constraints with friction after Chetaev: general systems, and dry friction from asperities."""
