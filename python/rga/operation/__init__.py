"""Live operation: packets of loggers, kept, accounted for, and made into the rows of a twin."""
