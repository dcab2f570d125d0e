"""Whole jobs, from models and records to files: a run of the twin, many diagnoses."""
