"""Drawings on paper, by matplotlib."""
