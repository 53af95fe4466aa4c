"""Resultants computed once and looked up ever after."""
