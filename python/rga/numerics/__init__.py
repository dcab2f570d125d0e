"""Numerical methods that several floors share."""
