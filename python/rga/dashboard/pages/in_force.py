"""When which version of the model was in force."""

from dataclasses import dataclass

from rga.twin.repository import RunView

#: by which a stretch begins behind the row at which its version was stored [s]
BEHIND = 1e-3


@dataclass(frozen=True)
class InForce:
    """A stretch of time in which a version was in force [s since the first row]."""

    version: int
    begin: float
    end: float


def in_force(view: RunView, end: float) -> list[InForce]:
    """The stretches of versions that were in force, in their order.

    Args:
        view: a run.
        end: of the last of them [s since the first row].
    """
    begun = _begun(view)
    ends = [*(begin for begin, _ in begun[1:]), end]
    return [
        InForce(version, begin, until)
        for (begin, version), until in zip(begun, ends, strict=True)
        if until > begin
    ]


def first_in_force(view: RunView) -> dict[int, float]:
    """When each version was first in force [s since the first row], be it for no row yet."""
    return {version: begin for begin, version in reversed(_begun(view))}


def _begun(view: RunView) -> list[tuple[float, int]]:
    """From when on which version was in force, in their order."""
    found = []
    for row, version in view.in_force():
        time = view.measured(row, row + 1).time
        found.append((float(time[0]) + BEHIND if row and len(time) else 0.0, version))
    return found
