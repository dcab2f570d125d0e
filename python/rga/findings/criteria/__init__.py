"""Criteria: the figures that decide what findings say."""

from rga.findings.criteria.criteria import Criteria
from rga.findings.criteria.read import as_criteria, load_criteria

__all__ = ["Criteria", "as_criteria", "load_criteria"]
