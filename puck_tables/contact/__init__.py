"""What the floor does to the puck: slow, trusted, independent of the compiled code."""
