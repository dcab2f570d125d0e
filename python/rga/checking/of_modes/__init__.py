"""Checks of the modes that a model expects."""
