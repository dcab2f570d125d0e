"""The historical repository: what a twin measured, simulated, inferred and decided, and when."""

from rga.twin.repository.entries import (
    Findings,
    Gaps,
    Identity,
    Inferred,
    Measured,
    Message,
    ModelVersion,
    Simulated,
)
from rga.twin.repository.step import Step
from rga.twin.repository.store import Repository, Run
from rga.twin.repository.view import View

__all__ = [
    "Findings",
    "Gaps",
    "Identity",
    "Inferred",
    "Measured",
    "Message",
    "ModelVersion",
    "Repository",
    "Run",
    "Simulated",
    "Step",
    "View",
]
