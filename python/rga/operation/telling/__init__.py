"""What brokers are told of a twin."""
