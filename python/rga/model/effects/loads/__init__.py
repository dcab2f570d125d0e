"""Loads, and what is wrong about them."""
