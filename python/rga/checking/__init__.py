"""Checks of a model and of a record beside it: all that looks wrong, each with its remedy."""

from rga.checking.checked import CheckResult
from rga.checking.checks import check
from rga.checking.finding import Finding

__all__ = ["CheckResult", "Finding", "check"]
