"""The part of a record that a diagnosis works on: observations, their zero, held-out rows."""
