"""Measurements of the contexts that are off."""
