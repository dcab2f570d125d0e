"""Sensors that do not show what they should."""
