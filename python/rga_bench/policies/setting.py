"""What is run: streams, and policies with their intervals."""

from dataclasses import dataclass, field
from typing import Any

from rga.inference.networks.settings import TrainingSettings
from rga.twin.settings import Settings

#: streams by their name, as `draw_stream` draws them: nothing but contexts ever changes
STREAMS: dict[str, dict[str, Any]] = {
    "null twin": {"drift": False},
    "sudden drift": {},
    "slow drift": {"slow": True},
}
#: a row is out of sync where its gap is more than what noise and scatter let expect by this factor
OUT_OF_SYNC = 1.8


@dataclass(frozen=True)
class PolicySetting:
    """How much is run.

    Attributes:
        streams: drawn of each sort.
        rows: of a stream.
        seed: of streams and twins.
        clocks: recalibrations that a record has room for, by the clock of each `time`.
        settings: of every twin, but for its policy.
    """

    streams: int = 4
    rows: int = 480
    seed: int = 0
    clocks: tuple[int, ...] = (12, 6, 3)
    settings: Settings = field(default_factory=lambda: Settings(inference="networks"))

    def policies(self) -> dict[str, Settings]:
        """Settings of the twins, by the name of their policy."""
        usual = self.rows // 6
        chosen: dict[str, dict[str, Any]] = {"event": {"policy": "event"}}
        for rows in (self.rows // parts for parts in self.clocks):
            chosen[f"time, {rows} rows"] = {"policy": "time", "interval": rows}
        for policy in ("hybrid", "adaptive"):
            chosen[f"{policy}, {usual} rows"] = {"policy": policy, "interval": usual}
        return {name: self.settings.model_copy(update=one) for name, one in chosen.items()}

    def tasks(self) -> list["PolicyTask"]:
        """Every twin of every stream."""
        seeds = range(self.seed * self.streams, (self.seed + 1) * self.streams)
        return [
            PolicyTask(stream, seed, self.rows, policy, settings)
            for seed in seeds
            for stream in STREAMS
            for policy, settings in self.policies().items()
        ]


@dataclass(frozen=True)
class PolicyTask:
    """A stream that a twin is to run through.

    Attributes:
        stream: its name.
        seed: of the stream and of the twin.
        rows: of the stream.
        policy: its name.
        settings: of the twin.
    """

    stream: str
    seed: int
    rows: int
    policy: str
    settings: Settings

    @property
    def id(self) -> str:
        """Its name."""
        return f"{self.seed}/{self.stream}/{self.policy}"


def shorter(seed: int) -> PolicySetting:
    """What takes less than a minute: one stream of each sort, and networks that learn little."""
    training = TrainingSettings(steps=700, reduced_steps=500)
    settings = Settings(inference="networks", design_rows=2048, training=training)
    return PolicySetting(streams=1, rows=240, seed=seed, clocks=(6,), settings=settings)
