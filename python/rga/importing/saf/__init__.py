"""Workbooks of the Structural Analysis Format (SAF)."""

from rga.importing.saf.read import is_saf, read_saf

__all__ = ["is_saf", "read_saf"]
