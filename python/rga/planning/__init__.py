"""Planning: the sensors and load tests that best tell rival explanations apart."""
