"""Modes: natural frequencies and shapes of a structure, and which is which."""
