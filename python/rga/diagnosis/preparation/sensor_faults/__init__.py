"""Channels that do not work: by their own readings, and beside the loads and other channels."""
