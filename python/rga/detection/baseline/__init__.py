"""What a stream of readings is like while nothing changes, learned from a baseline record."""
