"""Contexts of all rows and unknowns of the structure, inferred together."""
