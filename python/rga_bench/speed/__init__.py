"""What a diagnosis costs, by rows, sensors and members, and which of its stages take it."""
