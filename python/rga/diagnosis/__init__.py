"""Diagnosis: what a simulation gets wrong, why, where, and how sure that is."""

from typing import TYPE_CHECKING

from rga.lazy import listing, opening

if TYPE_CHECKING:
    from rga.diagnosis.modal.pipeline import diagnose_modes
    from rga.diagnosis.pipeline import diagnose

__all__ = [
    "diagnose",
    "diagnose_modes",
]

# They are opened on first use, so that a part is used without the others.
_HOMES = {
    "diagnose": "rga.diagnosis.pipeline",
    "diagnose_modes": "rga.diagnosis.modal.pipeline",
}
__getattr__ = opening(__name__, _HOMES)
__dir__ = listing(__name__, __all__)
