"""Whether the model can be simulated over the ranges of its contexts."""

from collections.abc import Iterator

from rga.checking.finding import Finding, refused
from rga.checking.of_model.mechanisms import unstable
from rga.checking.over_ranges import OverRanges
from rga.errors import UnstableStructureError


def simulation(over: OverRanges) -> Iterator[Finding]:
    """What the simulation refuses in the middle of the ranges, or somewhere within them."""
    shown = over.readings
    if shown.trouble is None:
        return
    if not shown.anywhere:
        if not isinstance(shown.trouble, UnstableStructureError) or unstable(over) is None:
            yield from refused(shown.trouble)
        return
    for one in refused(shown.trouble, "warning"):
        what = f"somewhere within the ranges of the contexts, {one.what}"
        yield Finding(one.severity, one.where, what, one.remedy)
