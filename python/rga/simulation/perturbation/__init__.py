"""A simulation at given contexts, and what more effects make of it."""
