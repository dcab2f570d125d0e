"""What may be hidden in a case: where, how large, and what the channels show of it."""
