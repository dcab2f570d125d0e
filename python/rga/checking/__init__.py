"""Checks of a model and of a record beside it: all that looks wrong, each with its remedy."""

from rga.checking.checked import Checked
from rga.checking.checks import check
from rga.checking.finding import Finding

__all__ = ["Checked", "Finding", "check"]
