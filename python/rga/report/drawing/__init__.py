"""Drawings of the structure with a value at every sensor."""
