"""A logger to try a service with: plays a record as one would send it, with faults."""
