"""Commands that say what a model predicts."""
