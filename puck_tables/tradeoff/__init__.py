"""Accuracy against speed, measured: every way of answering, its rivals, the front."""
