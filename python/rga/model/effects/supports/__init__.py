"""Supports: bearings and bases that hold more or less than they should, or have moved."""
