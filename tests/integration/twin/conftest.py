"""An empty place for a repository on every kind of database."""

from empty_repositories import place

__all__ = ["place"]
