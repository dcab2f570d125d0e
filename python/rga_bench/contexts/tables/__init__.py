"""The tables and figures of context inference."""
