"""Where a twin gets its rows from: the interface, and what stands behind it."""
