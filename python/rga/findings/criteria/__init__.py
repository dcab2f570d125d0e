"""Criteria: the figures that decide what findings say."""

from rga.findings.criteria.criteria import Criteria
from rga.findings.criteria.read import load_criteria

__all__ = ["Criteria", "load_criteria"]
