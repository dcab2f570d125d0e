"""Ways to infer contexts from readings, each calibrated on the same data."""
