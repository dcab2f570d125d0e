"""how much is run, and of what."""

from dataclasses import dataclass
from zlib import crc32

from rga.twin.settings import Level
from rga_bench.contexts.context_regime import MANNERS
from rga_bench.contexts.drift import DRIFTS
from rga_bench.synthetic.physical_twin import GAPS

#: a task of this manner has all drifts; its ordinary rows lack what drifts bring
DRIFTING = "drifting"
#: of integration
LEVELS: tuple[Level, ...] = ("A", "B", "C")


@dataclass(frozen=True)
class Sizes:
    """How many rows there are.

    Attributes:
        source: simulated rows, as many as `rga run` draws.
        unlabelled: measured rows that a method is calibrated on.
        stream: measured rows among which a drift comes.
        test: measured rows that are scored; one half of them under the drift.
    """

    source: int = 4096
    unlabelled: int = 200
    stream: int = 200
    test: int = 300


@dataclass(frozen=True)
class ContextsTask:
    """A row of the table on a split.

    Attributes:
        seed: of everything.
        split: its number.
        gap: in what the physical twin differs from the model.
        manner: how contexts of measured rows lie in their ranges, or `DRIFTING`.
        row: name of the method, or of a floor.
        drifts: that are run where the manner is `DRIFTING`.
        sizes: how much there is of everything.
    """

    seed: int
    split: int
    gap: str
    manner: str
    row: str
    drifts: tuple[str, ...]
    sizes: Sizes

    @property
    def id(self) -> str:
        """Its name; what is played in another way has another name."""
        way = crc32(repr((self.drifts, self.sizes)).encode())
        return f"{self.seed}/{self.split}/{self.gap}/{self.manner}/{self.row}/{way:08x}"


@dataclass(frozen=True)
class ContextsSetting:
    """how much is run, and of what.

    Attributes:
        seed: of everything.
        splits: of the full gap, at the same contexts and with drifts.
        few: splits of every other gap and manner.
        gaps: in what the physical twin differs from the model; the last one is the full gap.
        manners: of contexts; the first one is that of all gaps.
        drifts: that come into streams.
        rows: names of methods and floors; all there are if left out.
        sizes: how much there is of everything.
    """

    seed: int = 0
    splits: int = 10
    few: int = 1
    gaps: tuple[str, ...] = GAPS
    manners: tuple[str, ...] = MANNERS
    drifts: tuple[str, ...] = DRIFTS
    rows: tuple[str, ...] | None = None
    sizes: Sizes = Sizes()

    def tasks(self, rows: tuple[str, ...]) -> list[ContextsTask]:
        """Every row on every split, those that share their data one after the other.

        Drifts come last: they take most of the time.
        """
        full, first = self.gaps[-1], self.manners[0]
        seldom = [(gap, first) for gap in self.gaps[:-1]]
        seldom += [(full, manner) for manner in self.manners[1:]]
        played = [(split, full, first) for split in range(self.splits)]
        played += [(split, *one) for split in range(self.few) for one in seldom]
        if self.drifts:
            played += [(split, full, DRIFTING) for split in range(self.splits)]
        return [
            ContextsTask(self.seed, split, gap, manner, row, self.drifts, self.sizes)
            for split, gap, manner in played
            for row in rows
        ]


def shorter(seed: int, rows: tuple[str, ...]) -> ContextsSetting:
    """What takes less than three minutes, and is too little to judge by.

    Args:
        seed: of everything.
        rows: names of methods and floors that are played.
    """
    return ContextsSetting(
        seed,
        splits=1,
        few=1,
        gaps=("all",),
        manners=("same",),
        drifts=("none", "recurring"),
        rows=rows,
        sizes=Sizes(source=512, unlabelled=100, test=120),
    )
