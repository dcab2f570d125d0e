"""Masses that the model does not have, or has with another size."""
