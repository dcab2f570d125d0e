"""Queries, responses and packets: all that passes between the parts of the twin."""
