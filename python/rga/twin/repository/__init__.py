"""The historical repository: what a twin measured, simulated, inferred and decided, and when."""

from rga.twin.repository.entries import (
    Identity,
    Inferred,
    ModelVersion,
    Proposal,
    StoredCommand,
    StoredFindings,
    StoredGaps,
    StoredMessage,
    StoredReadings,
    StoredSimulations,
)
from rga.twin.repository.faults import InUse
from rga.twin.repository.step import Transaction
from rga.twin.repository.store import Repository, Run
from rga.twin.repository.view import RunView

__all__ = [
    "Identity",
    "InUse",
    "Inferred",
    "ModelVersion",
    "Proposal",
    "Repository",
    "Run",
    "RunView",
    "StoredCommand",
    "StoredFindings",
    "StoredGaps",
    "StoredMessage",
    "StoredReadings",
    "StoredSimulations",
    "Transaction",
]
