"""Measurements of rga: blind cases with known answers, and tables beside named peers."""
