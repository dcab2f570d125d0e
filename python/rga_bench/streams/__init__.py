"""The twin as it is shipped, on streams of a bridge that changes or does not."""
