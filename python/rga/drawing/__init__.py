"""Pictures of a model, and the look that all figures share."""
