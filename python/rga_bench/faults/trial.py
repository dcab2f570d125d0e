"""The trials: which channels of which record are broken, how, and from when on."""

from collections.abc import Sequence
from dataclasses import dataclass

from rga_bench.faults.base import GENERATORS, Base
from rga_bench.faults.library import FAULTS

#: one channel from the first row; one from an onset; two; three of twenty
WAYS = ("whole", "late", "whole", "late", "pair", "several")
#: nothing is broken; as many channels as in `several` are left out: what the others can show
SOUND, LEFT_OUT = "sound", "left out"
#: broken records of a quick run, and the rows of its drawn ones; those of another run
QUICK, QUICK_ROWS, ROWS = 18, 100, 200


@dataclass(frozen=True)
class FaultTrial:
    """A record to be diagnosed.

    Attributes:
        base: the sound record.
        seed: of all that is drawn.
        number: of the trial; 0: nothing is broken.
        way: one of `WAYS`, or that nothing is broken, or that channels are left out.
        fault: of the first channel; "": none.
    """

    base: Base
    seed: int
    number: int
    way: str
    fault: str = ""

    @property
    def id(self) -> str:
        """Its name."""
        words = [f"{self.base.name}, {self.base.rows} rows, seed {self.seed}", self.way]
        if self.number:
            words.append(f"{self.fault or 'nothing'} {self.number}")
        return ", ".join(words)


def trials(seed: int, count: int, rows: int, given: Sequence[Base] = ()) -> list[FaultTrial]:
    """About `count` broken records, each record's sound twin before them.

    Records take turns: those of every generator, and the `given` ones. A record is broken in
    every way in turn, then the next. Their number has no common divisor with that of the faults,
    so every fault meets every way, and every beginning of the list is balanced.
    """
    order: list[FaultTrial] = []
    begun = set()
    names = list(FAULTS)
    for block in range(-(-count // len(WAYS))):
        base = _base(block, rows, given)
        if base.name not in begun:
            begun.add(base.name)
            order.append(FaultTrial(base, seed, 0, SOUND))
        first = block * len(WAYS)
        order += [
            FaultTrial(base, seed, first + k + 1, way, names[(first + k) % len(names)])
            for k, way in enumerate(WAYS)
        ]
        order.append(FaultTrial(base, seed, block + 1, LEFT_OUT))
    return order


def _base(block: int, rows: int, given: Sequence[Base]) -> Base:
    sources = [*GENERATORS, *(["given"] if given else [])]
    turn, which = divmod(block, len(sources))
    if sources[which] == "given":
        return given[turn % len(given)]
    return Base(f"{sources[which]}-{turn}", rows)
