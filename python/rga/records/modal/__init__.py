"""Modal records: natural frequencies and mode shapes that were found in windows of time."""
