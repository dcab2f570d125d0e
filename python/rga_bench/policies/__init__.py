"""What each policy of synchronisation costs, and what gap it leaves: one stream, many twins."""
