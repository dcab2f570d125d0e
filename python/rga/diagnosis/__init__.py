"""Diagnosis: what a simulation gets wrong, why, where, and how sure that is."""

from rga.diagnosis.pipeline import diagnose
from rga.findings.schema import Findings

__all__ = ["Findings", "diagnose"]
