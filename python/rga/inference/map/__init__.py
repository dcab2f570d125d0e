"""The most probable contexts of measured rows under a simulator."""
