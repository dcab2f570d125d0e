"""Checks of a model by itself: a file each."""
