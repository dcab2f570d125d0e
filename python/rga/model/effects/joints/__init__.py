"""Joints between members: how far they turn, and how far they slip."""
