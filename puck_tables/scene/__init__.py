"""Scenes: a puck, a floor, a launch and what acts on it, with the cheapest exact model."""
