"""Commands that say what is wrong, and what to measure next."""
