"""What is run: streams of each sort, and ways to infer contexts."""

from dataclasses import dataclass

from rga.twin.settings import Inference

#: sorts of streams, in words
SORTS = {
    "null": "ordinary days, nothing changes",
    "drift": "contexts come that no day had, and go again",
    "structure": "the same, and later something in the structure changes",
    "gauge": "ordinary days, and one gauge breaks",
}


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
        rows: of a null stream; others have 480, as that of the case study.
        streams: of each other sort and inference.
        compared: ways to infer that stand beside the default.
    """

    seed: int = 1
    nulls: int = 40
    rows: int = 500
    streams: int = 8
    compared: tuple[Inference, ...] = ("networks", "amortised")

    def tasks(self) -> list[StreamTask]:
        """Every twin on every stream, those of few streams first."""
        others = [sort for sort in SORTS if sort != "null"]
        seeds = range(self.seed, self.seed + self.streams)
        tasks = [StreamTask(sort, seed, 480, "auto") for seed in seeds for sort in others]
        tasks += [
            StreamTask("structure", seed, 480, inference)
            for seed in seeds
            for inference in self.compared
        ]
        nulls = range(self.seed, self.seed + self.nulls)
        return [*tasks, *(StreamTask("null", seed, self.rows, "auto") for seed in nulls)]


def shorter(seed: int) -> StreamSetting:
    """What takes some minutes: one stream of each sort."""
    return StreamSetting(seed=seed, nulls=1, streams=1, compared=())
