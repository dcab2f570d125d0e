"""What loggers send: packets, and how they are written."""
