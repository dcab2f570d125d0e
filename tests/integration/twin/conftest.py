"""An empty place for a repository on every kind of database."""

from stored_runs import place

__all__ = ["place"]
