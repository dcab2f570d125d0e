"""Figures of what a twin lived through."""
