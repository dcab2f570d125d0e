"""How much is measured, and of what."""

from dataclasses import dataclass

from rga_bench.detection.faults import Drift, Spikes, Spread, Step, StreamChange, Stuck
from rga_bench.detection.noise import WHITE
from rga_bench.detection.watch import StreamWorld, WatchedCase

#: the change whose delay is shown against false alarms
EXAMPLE = Step(1.0)
#: rows of a baseline
BASELINE = 2000
#: run lengths without a change are watched for so many times the average, delays for so many
PATIENCE_NULL, PATIENCE_DELAY = 2.0, 5.0


@dataclass(frozen=True)
class DetectionSetting:
    """How much is measured, and of what.

    Attributes:
        seed: of all that is random.
        arl0: rows between false alarms that every detector is set to.
        null: streams by which limits are set, and the same again by which they are checked.
        streams: to a delay.
        baselines: drawn in every world of noise.
        each: streams to a baseline.
        onset: rows before a change: enough for every detector to be filled.
        sensors: in a row.
        sizes: of steps [sd]; 1 is among them.
        counts: of sensors that change; 1 is among them.
        seconds: that what a detector costs is measured for, a figure.
        judged: whether figures are held against their targets.
    """

    seed: int = 0
    arl0: float = 10_000.0
    null: int = 400
    streams: int = 200
    baselines: int = 60
    each: int = 4
    onset: int = 300
    sensors: int = 84
    sizes: tuple[float, ...] = (0.25, 0.5, 1.0, 2.0)
    counts: tuple[int, ...] = (1, 5, 84)
    seconds: float = 2.0
    judged: bool = True

    @property
    def known(self) -> StreamWorld:
        """White noise, known to all."""
        return StreamWorld(self.seed, WHITE, self.sensors)

    def faults(self) -> list[StreamChange]:
        """That are measured where the noise is known."""
        steps: list[StreamChange] = [
            Step(size, count) for count in self.counts for size in self.sizes
        ]
        many = [count for count in self.counts if count > 1]
        return [
            *steps,
            *(Step(1.0, count, signed=True) for count in many),
            *(Drift(0.01, count) for count in self.counts),
            *(Spread(2.0, count) for count in self.counts),
            Step(5.0),
            Stuck(0.0),
            Spikes(8.0),
        ]

    def faults_estimated(self) -> list[StreamChange]:
        """That are measured where the noise is estimated."""
        return [
            *(Step(size, count) for count in self.counts for size in (0.5, 1.0)),
            Drift(0.01),
            Spread(2.0),
            Step(5.0),
            Stuck(0.0),
            Spikes(8.0),
        ]

    def undisturbed(self, purpose: str, fill: int, streams: int) -> WatchedCase:
        """Streams without a change, counted from where a detector is filled."""
        return WatchedCase(streams, int(PATIENCE_NULL * self.arl0), fill, purpose=purpose)

    def changed(self, fault: StreamChange, streams: int) -> WatchedCase:
        """Streams with a change."""
        return WatchedCase(streams, int(PATIENCE_DELAY * self.arl0), self.onset, fault, "delay")


def shorter(seed: int) -> DetectionSetting:
    """What takes less than a minute: too short to judge by."""
    return DetectionSetting(
        seed,
        arl0=1000.0,
        null=40,
        streams=10,
        baselines=2,
        each=2,
        onset=150,
        sizes=(1.0, 2.0),
        seconds=0.2,
        judged=False,
    )
