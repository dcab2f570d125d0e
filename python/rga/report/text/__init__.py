"""Numbers, units and advice in words."""
