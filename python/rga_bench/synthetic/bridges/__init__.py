"""The bridges a case may stand on, as model files."""
