"""What a structure does under given contexts, ready to be drawn."""
