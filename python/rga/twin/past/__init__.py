"""What of a long past a diagnosis is to see."""
