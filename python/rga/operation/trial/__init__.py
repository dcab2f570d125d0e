"""What would go wrong if a service began: looked at without writing anything (`--check`)."""
