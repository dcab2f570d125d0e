"""The disk of a service: whether there is room on it, and what a year takes of it."""
