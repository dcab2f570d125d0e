"""Exact paths from loads to responses, by what varies between rows."""
