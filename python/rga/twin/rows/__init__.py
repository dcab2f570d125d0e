"""The rows of a run in memory: the latest, and what is kept of those that have gone by."""
