"""A page that shows a model from all sides, in one file."""
