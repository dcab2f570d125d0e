"""Planning: the sensors and load tests that best separate rival explanations."""
