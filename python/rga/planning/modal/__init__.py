"""Measurements of modes that could be made: accelerometers, windows, seasons, parked masses."""
