"""What is run: streams of each sort, and ways to infer contexts."""

from dataclasses import dataclass

from rga.twin.settings import Inference

#: sorts of streams, in words
SORTS = {
    "null": "ordinary days, nothing changes",
    "drift": "contexts come that no day had, and go again",
    "structure": "the same, and later something in the structure changes",
    "gauge": "ordinary days, and one gauge breaks",
    "mast": "a lattice mast in wind, nothing changes and no context is measured",
    "roof": "a roof under snow, nothing changes and no context is measured",
    "portal": "a portal frame under snow and wind, nothing changes and no context is measured",
}
#: sorts that are streams of another structure than that of the case study
ELSEWHERE = ("mast", "roof", "portal")
#: rows of a stream, as of that of the case study
USUAL = 480


@dataclass(frozen=True)
class StreamTask:
    """A stream that a twin runs through, with settings that nobody has touched.

    Attributes:
        sort: of `SORTS`.
        seed: of the stream and of the twin.
        rows: of the stream.
        inference: of contexts.
    """

    sort: str
    seed: int
    rows: int
    inference: Inference

    @property
    def id(self) -> str:
        """Its name."""
        return f"{self.sort}/{self.seed}/{self.inference}"


@dataclass(frozen=True)
class StreamSetting:
    """How much is run.

    Attributes:
        seed: the first of the streams'.
        nulls: null streams, by the default inference.
        rows: of a null stream.
        streams: of each other sort and inference.
        elsewhere: of each other structure.
        compared: ways to infer that stand beside the default.
    """

    seed: int = 1
    nulls: int = 40
    rows: int = 500
    streams: int = 8
    elsewhere: int = 4
    compared: tuple[Inference, ...] = ("networks", "amortised")

    def tasks(self) -> list[StreamTask]:
        """Every twin on every stream; where time runs out, what compares is left out first."""
        seeds = range(self.seed, self.seed + self.streams)
        nulls = range(self.seed, self.seed + self.nulls)
        return [
            *(StreamTask("null", seed, self.rows, "auto") for seed in nulls),
            *(StreamTask("structure", seed, USUAL, "auto") for seed in seeds),
            *(
                StreamTask(sort, seed, USUAL, "auto")
                for seed in seeds
                for sort in ("gauge", "drift")
            ),
            *(
                StreamTask(sort, seed, USUAL, "auto")
                for seed in range(self.seed, self.seed + self.elsewhere)
                for sort in ELSEWHERE
            ),
            *(
                StreamTask("structure", seed, USUAL, inference)
                for seed in seeds
                for inference in self.compared
            ),
        ]


def shorter(seed: int) -> StreamSetting:
    """What takes some minutes: one stream of each sort."""
    return StreamSetting(seed=seed, nulls=1, streams=1, elsewhere=1, compared=())
