"""Compiled building blocks: the friction law as the hot loop reads it."""
