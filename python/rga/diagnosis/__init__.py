"""Diagnosis: what a simulation gets wrong, why, where, and how sure that is."""

from rga.diagnosis.findings import Findings
from rga.diagnosis.pipeline import diagnose

__all__ = ["Findings", "diagnose"]
