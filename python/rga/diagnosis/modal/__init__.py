"""Diagnosis by natural frequencies and mode shapes: what a model gets wrong of how it swings."""
