"""Diagnosis: what a simulation gets wrong, why, where, and how sure that is."""

from rga.diagnosis.diagnose import diagnose
from rga.diagnosis.findings import Findings

__all__ = ["Findings", "diagnose"]
