"""The look-ups as source code of other languages."""
