"""Temperature: what warms, how much, how fast, and how far it makes members expand."""
