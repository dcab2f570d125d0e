"""Findings: what a diagnosis says, as pure data; its words, its file."""

from rga.findings.load import load_findings
from rga.findings.schema import Findings

__all__ = ["Findings", "load_findings"]
