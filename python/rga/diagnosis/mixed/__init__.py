"""A record and the modes of the same structure, diagnosed in one posterior."""
