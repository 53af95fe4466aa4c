"""Accuracy against speed, measured: every method of answering, its rivals, the front."""
