"""Context capture: simulations, learning, inference, and the twin at the inferred context."""
