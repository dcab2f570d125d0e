"""The joint posterior as the estimator of a run: contexts of rows, and a twin that is corrected."""

import io
import json
from collections.abc import Sequence
from functools import cached_property
from typing import Self
from zipfile import BadZipFile

import numpy as np
from numpy.typing import NDArray

from rga.arrays import FloatArray
from rga.errors import InputError
from rga.inference import Joint, MeasuredContexts, Rows, Unknowns, infer_jointly
from rga.inference.joint.checked_input import plausible
from rga.inference.joint.infer import RowModes
from rga.inference.joint.measured_contexts import BEYOND
from rga.inference.laws.over_time import follow_law
from rga.inference.map.laplace import BROKEN, birge_ratio
from rga.model import ContextVariable, Model
from rga.model.effect import seconds
from rga.twin.calibration.blocks import BLOCK, block, blocks
from rga.twin.calibration.correction import Correction
from rga.twin.calibration.lesson import Lesson
from rga.twin.simulation_model import SimulationModel

#: simulated rows that a search for contexts starts from
SOURCE = 512
#: least rows to calibrate on, and least channels for each context that nothing measures
LEAST_ROWS, LEAST_CHANNELS = 20, 2
#: changes that are named at most, and how sure one must be [standard deviations]
SHOWN, CHANGED = 2, 4.0
#: fields of a joint posterior that are stored as arrays
KEPT = (
    "values", "gains", "offsets", "independent", "pulled", "noise", "variance", "uncertainty",
    "source",
)  # fmt: skip


class JointEstimator:
    """Contexts as the joint posterior of contexts and structure has them.

    Args:
        found: the joint posterior.
        latent: contexts that nothing measures and some channel sees.
        watched: channels that it looks at, bool[channels].
        simulation: of the version that it learned about.
    """

    kind = "joint"
    remembers = False

    def __init__(
        self,
        found: Joint,
        latent: Sequence[str],
        watched: NDArray[np.bool_],
        simulation: SimulationModel,
    ) -> None:
        self.found, self.watched, self._simulation = found, watched, simulation
        self._latent = tuple(latent)
        self._modes: dict[int, RowModes] = {}
        self._blocks: dict[int, tuple[bytes, tuple[FloatArray, FloatArray]]] = {}

    @classmethod
    def learn(
        cls, lesson: Lesson, *, start: Joint | None = None, earlier: Joint | None = None
    ) -> Self:
        """Find contexts and structure.

        Args:
            lesson: what to learn from.
            start: what was found from some of its rows, to begin with.
            earlier: what was found from earlier rows, taken as prior.

        Raises:
            InputError: the model holds what is to be found already.
        """
        lesson = lesson.rows(slice(lesson.new, None))
        data, simulation = lesson.data, lesson.simulation
        watched = lesson.watched(() if earlier is None else earlier.unknowns.model.sensors)
        unknowns = Unknowns(of_channels(simulation.model, watched), lesson.clock)
        found = infer_jointly(
            unknowns,
            readings_of(lesson, unknowns, watched),
            lesson.noise[watched],
            data.contexts[:SOURCE],
            load_tests=None if earlier is not None else load_tests_of(lesson, watched),
            measured=instruments(simulation, data.real_contexts),
            start=start if start is not None and start.is_about(unknowns) else None,
            prior=earlier,
            progress=lesson.progress,
        )
        return cls(found, lesson.latent, watched, simulation)

    @classmethod
    def carried(cls, lesson: Lesson, earlier: Joint) -> Self:
        """What was found earlier, for a version of the model in which it cannot be found anew."""
        simulation, known = lesson.simulation, earlier.unknowns.model.sensors
        watched = np.array([name in known for name in simulation.model.sensors], dtype=bool)
        unknowns = Unknowns(of_channels(simulation.model, watched), lesson.clock)
        return cls(earlier.carried(unknowns), lesson.latent, watched, simulation)

    def refined(self, lesson: Lesson) -> "JointEstimator":
        """What it becomes by the new rows of a lesson, what it has found being their prior."""
        new = lesson.rows(slice(lesson.new, None))
        if not np.isfinite(readings_of(new, self.found.unknowns, self.watched)).any():
            return self
        return self.learn(lesson, earlier=self.found)

    @property
    def correction(self) -> Correction:
        """What it has found of structure and sensors."""
        zero = dict(zip(self._simulation.model.sensors, zero_of(self._simulation), strict=True))
        return Correction.of(self.found, zero)

    def infer(
        self,
        first: int,
        readings: FloatArray,
        contexts: FloatArray,
        time: FloatArray,
        laws: Sequence[ContextVariable],
    ) -> tuple[FloatArray, FloatArray]:
        """Latent contexts from a row on, and their standard deviations (`ContextEstimator`)."""
        columns = [list(self._simulation.model.context).index(name) for name in self._latent]
        moving = [number for number, one in enumerate(laws) if one.law != "independent"]
        begin = 0 if moving else first
        found = self._of_rows(begin, readings, contexts, time)
        value, spread = (table[:, columns].copy() for table in found)
        for number in moving:
            line = follow_law(time, value[:, number], spread[:, number], laws[number])
            value[:, number], spread[:, number] = line
        return value[first - begin :], spread[first - begin :]

    def to_bytes(self) -> bytes:
        """Everything but the simulation."""
        found = self.found
        head = {"latent": self._latent, "time": found.unknowns.time}
        content = io.BytesIO()
        np.savez(
            content,
            allow_pickle=False,
            head=np.frombuffer(json.dumps(head).encode(), dtype=np.uint8),
            watched=self.watched,
            contexts=found.rows.contexts,
            readings=found.rows.readings,
            **{name: getattr(found, name) for name in KEPT},
        )
        return content.getvalue()

    @classmethod
    def from_bytes(cls, content: bytes, simulation: SimulationModel) -> Self:
        """What `to_bytes` wrote, about the same simulation.

        Raises:
            InputError: the bytes hold something else.
        """
        try:
            with np.load(io.BytesIO(content), allow_pickle=False) as kept:
                table = {name: kept[name] for name in kept.files}
            head = json.loads(table["head"].tobytes())
            watched = table["watched"]
            unknowns = Unknowns(of_channels(simulation.model, watched), head["time"])
            rows = Rows(table["contexts"], table["readings"])
            found = Joint(unknowns=unknowns, rows=rows, **{name: table[name] for name in KEPT})
        except (ValueError, KeyError, OSError, BadZipFile) as error:
            problem = "these bytes hold no joint posterior"
            raise InputError(problem, "stored estimator", "begin a new run") from error
        return cls(found, head["latent"], watched, simulation)

    def _of_rows(
        self, first: int, readings: FloatArray, contexts: FloatArray, time: FloatArray
    ) -> tuple[FloatArray, FloatArray]:
        """Contexts of rows from one on, and their spreads, float[rows - first, contexts] each."""
        deviation = np.sqrt(self.found.variance)
        seen = plausible(self.found.unknowns, readings[:, self.watched] + self._zero, deviation)
        parts = []
        for number in blocks(first, len(readings)):
            rows = np.maximum(block(number, len(readings)), first)
            shown = b"".join(part[rows].tobytes() for part in (seen, contexts, time))
            if number in self._blocks and self._blocks[number][0] == shown:
                parts.append(self._blocks[number][1])
                continue
            parts.append(self._of_block(seen[rows], contexts[rows], time[rows]))
            if first == 0 and (number + 1) * BLOCK <= len(readings):
                self._blocks[number] = shown, parts[-1]
        lead = first % BLOCK
        value, spread = (np.concatenate(part)[lead:] for part in zip(*parts, strict=True))
        return value[: len(readings) - first], spread[: len(readings) - first]

    def _of_block(
        self, readings: FloatArray, contexts: FloatArray, time: FloatArray
    ) -> tuple[FloatArray, FloatArray]:
        """Contexts of the rows of a block, and their spreads, float[BLOCK, contexts] each."""
        measured = instruments(self._simulation, contexts[:, self._measured_columns])
        phase = np.searchsorted(self._onsets, time, side="right")
        value, spread = np.empty_like(contexts), np.empty_like(contexts)
        for number in np.unique(phase).tolist():
            infer = self._inference(number, measured)
            found = infer(readings, measured)
            deviation = np.sqrt(np.diagonal(self.found.covariance))
            off = np.abs(readings - infer.simulate(found.value)) / deviation
            # A channel that is broken in a row says nothing of its contexts.
            usual = np.maximum(_median(off), 1.0)
            sound = np.where(off > BROKEN * usual, np.nan, readings)
            if np.isnan(sound).sum() > np.isnan(readings).sum():
                found = infer(sound, measured)
            gaps = (sound - infer.simulate(found.value)) ** 2
            variance = self.found.variance * birge_ratio(gaps, deviation)[:, None] ** 2
            unsure = self.found.spread(found.value, np.isfinite(sound), measured, variance)
            own = phase == number
            value[own] = found.value[own]
            spread[own] = np.maximum(found.spread, unsure)[own]
        return value, spread

    def _inference(self, phase: int, measured: MeasuredContexts) -> RowModes:
        """Inference of rows before the first onset (phase 0), after it, and so on."""
        if phase not in self._modes:
            onsets = self._onsets
            time = None
            if len(onsets):
                time = float(onsets[phase - 1] if phase else np.nextafter(onsets[0], -np.inf))
            found = self.found
            self._modes[phase] = RowModes(
                found.twin_at(time), found.variance, found.source, measured, found.uncertainty
            )
        return self._modes[phase]

    @cached_property
    def _onsets(self) -> FloatArray:
        """Times at which effects begin, in order [s]."""
        effects = self._simulation.model.effects.values()
        return np.unique([seconds(one.onset) for one in effects if one.onset is not None])

    @cached_property
    def _zero(self) -> FloatArray:
        return zero_of(self._simulation)[self.watched]

    @property
    def _measured_columns(self) -> list[int]:
        names = list(self._simulation.model.context)
        return [names.index(name) for name in self._simulation.station.measured]


def load_tests_of(lesson: Lesson, watched: NDArray[np.bool_]) -> Rows | None:
    """Load tests of a lesson as sensors show them without a logger's zero."""
    tests = lesson.load_tests
    if tests is None:
        return None
    return Rows(tests.contexts, (tests.readings + zero_of(lesson.simulation))[:, watched])


def why_not(lesson: Lesson, earlier: Joint | None = None) -> str | None:
    """Why the joint posterior cannot be had of a lesson, in words; None where it can.

    Args:
        lesson: what would be learned from.
        earlier: what was found from earlier rows.
    """
    model, rows, latent = lesson.simulation.model, len(lesson.data.real), lesson.latent
    channels = int(lesson.watched().sum())
    if rows < LEAST_ROWS and earlier is None:
        return f"{rows} rows are too few, it needs {LEAST_ROWS}"
    if channels < LEAST_CHANNELS * len(latent):
        return f"{channels} channels do not outnumber {len(latent)} contexts by far"
    for name in latent:
        if model.context[name].law == "linear":
            return f"context {name!r} moves along a line"
    for name, effect in model.effects.items():
        if effect.remembers:
            return f"effect {name!r} remembers what was before"
        if effect.onset is not None and effect.profile == "ramp":
            return f"effect {name!r} grows over time"
    try:
        Unknowns(model)
    except InputError as error:
        return error.what
    return None


def changes(before: Joint | None, after: Joint | None) -> tuple[str, ...]:
    """What structure and sensors differ by most, by far more than was left open, in words.

    Args:
        before, after: what was found; None: nothing. What one alone has is passed over.
    """
    if before is None or after is None:
        return ()
    known, *open_before = before.about(after.unknowns)
    left = np.diagonal(open_before[0]) + (open_before[1] ** 2).sum(axis=0)
    shared = [label in before.labels for label in after.labels]
    moved = np.where(shared, after.parameters - known, 0.0)
    size = np.abs(moved / after.units) / np.sqrt(left + np.diagonal(after.sure))
    sensors, count = after.unknowns.model.sensors, len(after.values)
    parts = zip(after.unknowns.parts, known[:count], after.values, strict=True)
    gains, offsets = np.split(moved[count:], 2)
    words = [
        *(part.changed(old, new) for part, old, new in parts),
        *(f"gain of {name} {gain:+.2%}" for name, gain in zip(sensors, gains, strict=True)),
        *(
            f"zero of {name} {offset:+.2g} {sensor.unit}"
            for (name, sensor), offset in zip(sensors.items(), offsets, strict=True)
        ),
    ]
    return tuple(words[one] for one in np.argsort(-size)[:SHOWN] if size[one] > CHANGED)


def readings_of(lesson: Lesson, unknowns: Unknowns, watched: NDArray[np.bool_]) -> FloatArray:
    """Readings of the channels that are looked at, the zero of the logger put back.

    Args:
        lesson: what is learned from.
        unknowns: of the model with these channels.
        watched: channels that are looked at, bool[channels].

    Returns:
        float[rows, channels looked at], NaN where a reading is missing or none.
    """
    readings = (lesson.data.real + zero_of(lesson.simulation))[:, watched]
    return plausible(unknowns, readings, lesson.noise[watched])


def of_channels(model: Model, watched: NDArray[np.bool_]) -> Model:
    """The model with the sensors that are looked at."""
    chosen = zip(model.sensors.items(), watched, strict=True)
    return model.with_sensors({name: sensor for (name, sensor), own in chosen if own})


def instruments(simulation: SimulationModel, measured: FloatArray) -> MeasuredContexts:
    """What instruments read of the contexts, float[rows, measured], held to what can be."""
    context = simulation.model.context
    columns = [list(context).index(name) for name in simulation.station.measured]
    ranges = np.array([variable.range for variable in context.values()])
    noise = np.array([variable.noise or 0.0 for variable in context.values()])
    values = np.full((len(measured), len(context)), np.nan)
    reach = BEYOND * np.ptp(ranges[columns], axis=1)
    low, high = ranges[columns, 0] - reach, ranges[columns, 1] + reach
    values[:, columns] = np.clip(measured, low, high)
    return MeasuredContexts.of(values, noise, ranges)


def zero_of(simulation: SimulationModel) -> FloatArray:
    """What the logger took off every channel, under contexts in the middle, float[channels]."""
    middle = np.array([np.mean(one.range) for one in simulation.model.context.values()])
    zero = simulation.zero(np.full(1, simulation.station.origin), middle[None])
    return np.nan_to_num(zero)  # none is simulated of a channel that is broken by the model


def _median(off: FloatArray) -> FloatArray:
    """Median of each row, float[rows, 1]; 0 where nothing is known of one."""
    known = np.isfinite(off).any(axis=1)
    found = np.zeros((len(off), 1))
    found[known, 0] = np.nanmedian(off[known], axis=1)
    return found
