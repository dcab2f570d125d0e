"""What a cause must stand before it is named: held-out rows, channels left out, rivals."""
