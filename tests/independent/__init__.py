"""What the product is held against: code that shares nothing with it."""
