"""Commands of the twin of a structure in use."""
