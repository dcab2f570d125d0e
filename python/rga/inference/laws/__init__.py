"""How a context moves over time: estimates of single rows, combined."""
