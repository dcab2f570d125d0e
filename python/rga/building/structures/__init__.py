"""Whole structures: each a builder to go on with, with named nodes, groups and supports."""
