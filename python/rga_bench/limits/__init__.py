"""How much a diagnosis can be given."""
