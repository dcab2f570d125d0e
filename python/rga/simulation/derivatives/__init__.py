"""Derivatives of the sensors by contexts and effects."""
