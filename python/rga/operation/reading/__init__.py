"""What a twin that is served says of itself: where it stands, and its past at any length."""
