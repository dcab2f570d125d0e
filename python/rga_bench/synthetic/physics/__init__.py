"""A physics of its own: plain NumPy, nothing of the simulator."""
