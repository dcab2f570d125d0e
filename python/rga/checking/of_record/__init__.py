"""Checks of a record beside its model: a file each."""
