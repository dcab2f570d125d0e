"""Diagnosis: what a simulation gets wrong, why, where, and how sure that is."""

from rga.diagnosis.pipeline import diagnose

__all__ = ["diagnose"]
