"""The data-driven model: from live readings to the contexts that nothing measures."""

import json
from collections.abc import Sequence
from functools import partial
from typing import Self

import numpy as np
import torch
from numpy.typing import NDArray
from torch import Tensor, nn

from rga.arrays import FloatArray
from rga.errors import InputError
from rga.inference import ContextNetwork, Samples, Variables, train
from rga.inference.joint.sensor_errors import CorrectedTwin
from rga.inference.laws.mixture import Candidates, joined
from rga.inference.laws.over_time import follow_law
from rga.inference.laws.refine import polish_line
from rga.inference.map.array_simulator import TwinOnArrays
from rga.inference.map.laplace import birge_ratio, covering_factor, laplace_spread
from rga.inference.networks.selection import unlabelled_gap
from rga.inference.networks.travel_direction import EitherWay
from rga.model import ContextVariable
from rga.twin.calibration.blocks import BLOCK, block, blocks
from rga.twin.calibration.lesson import Lesson
from rga.twin.simulation_model import SimulationModel, broken

#: one simulation in so many is held out from training, to measure how far intervals must reach,
#: and one measured row in so many, to tell when to stop
HELD_OUT, JUDGES = 8, 5
#: how far networks reach from the middle of a range, in widths of it, and a little more
OUTERMOST = 0.76
#: rows on which lines are compared
ROWS_COMPARED = 200


class NetworkEstimator:
    """Encoder and context predictor, with what their intervals must be stretched by.

    Args:
        network: what infers.
        simulation: of the version that it learned from.
        faulty: channels that are not looked at, bool[channels].
        noise: standard deviation of channels, then of contexts that are not inferred.
        factor: on the spread of each latent context, float[latent].
    """

    kind = "networks"
    remembers = False

    def __init__(
        self,
        network: ContextNetwork,
        simulation: SimulationModel,
        faulty: NDArray[np.bool_],
        noise: FloatArray,
        factor: FloatArray,
    ) -> None:
        self._network, self._simulation = network, simulation
        self._faulty, self._noise, self._factor = faulty, noise, factor
        self._known: dict[int, tuple[bytes, Candidates]] = {}

    @classmethod
    def learn(cls, lesson: Lesson, start: Self | None = None) -> Self:
        """Learn from simulated and measured rows.

        Args:
            lesson: what to learn from.
            start: a model to refine; None: from new networks.
        """
        data, simulation, latent = lesson.data, lesson.simulation, lesson.latent
        noise, settings, clock = lesson.noise, lesson.training, lesson.clock
        model = simulation.model
        variables = Variables.of(model, latent)
        faulty = broken(data.readings) | np.isnan(noise)
        source = Samples(
            np.where(faulty, 0.0, data.readings),
            data.contexts[:, variables.measured_columns],
            data.contexts[:, variables.latent_columns],
            data.falling if data.falling.any() else None,
        )
        unheld = np.arange(len(source)) % HELD_OUT != HELD_OUT - 1
        contexts = np.tile(variables.middle, (len(data.real), 1))
        columns = [variables.contexts.index(name) for name in simulation.station.measured]
        contexts[:, columns] = data.real_contexts
        real = Samples(np.where(faulty, np.nan, data.real), contexts[:, variables.measured_columns])
        read = np.isfinite(real.readings).any(axis=1)
        judges = read & (np.cumsum(read) % JUDGES == 0)
        known = [model.context[name].noise or 0.0 for name in variables.measured]
        level = np.concatenate([np.where(np.isnan(noise), 1.0, noise), known])
        kind = settings.physics if start is None else settings.fine_physics
        physics: nn.Module | TwinOnArrays | None = None
        if kind == "exact":
            physics = _exact(lesson, faulty)
            if physics is None:
                reduced = {"physics": "reduced", "fine_physics": "reduced"}
                settings = settings.model_copy(update=reduced)

        def simulate(contexts: FloatArray) -> FloatArray:
            return simulation.readings(np.full(len(contexts), clock), contexts)

        network = train(
            source.rows(unheld),
            real.rows(~judges),
            settings,
            variables=variables,
            noise=level,
            seed=lesson.seed,
            physics=physics,
            start=None if start is None else start._network,
            held_out=partial(unlabelled_gap, simulate=simulate, rows=real.rows(judges), noise=noise)
            if judges.any()
            else None,
            progress=lesson.progress,
        )
        learned = cls(network, simulation, faulty, level, np.ones(len(latent)))
        learned._stretch(source.rows(~unheld), clock, lesson.seed)
        return learned

    def refined(self, lesson: Lesson) -> Self:
        """What it becomes by a lesson."""
        return self.learn(lesson, self)

    @property
    def found(self) -> None:
        """None: networks take the model as it is."""
        return None

    @property
    def correction(self) -> None:
        """None: networks take the model as it is."""
        return None

    def infer(
        self,
        first: int,
        readings: FloatArray,
        contexts: FloatArray,
        time: FloatArray,
        laws: Sequence[ContextVariable],
    ) -> tuple[FloatArray, FloatArray]:
        """Latent contexts from a row on, and their standard deviations (`ContextEstimator`)."""
        moving = [number for number, one in enumerate(laws) if one.law != "independent"]
        alone = [number for number, one in enumerate(laws) if one.law == "independent"]
        several = self._several(0 if moving else first, readings, contexts)
        value, spread = several.rows(slice(first if moving else 0, None)).best()
        if moving:
            either = several.reversed if self._network.ways == 2 else None
            likely = contexts.copy()
            likely[:, self._network.variables.latent_columns] = several.best()[0]
            for number in moving:
                line = follow_law(
                    time,
                    several.value[:, :, number],
                    several.spread[:, :, number],
                    laws[number],
                    several.share,
                    either,
                )
                if laws[number].law == "linear":
                    line = self._arrived(readings, likely, time, number, laws[number], line)
                value[:, number], spread[:, number] = (part[first:] for part in line)
        if alone:
            near = self._laplace(first, readings, contexts, value, time)
            wider = np.maximum(spread, near) * self._factor
            spread[:, alone] = wider[:, alone]
        return value, spread

    def to_bytes(self) -> bytes:
        """Everything but the simulation."""
        head = {
            "faulty": self._faulty.tolist(),
            "noise": self._noise.tolist(),
            "factor": self._factor.tolist(),
        }
        return json.dumps(head).encode() + b"\n" + self._network.to_bytes()

    @classmethod
    def from_bytes(cls, content: bytes, simulation: SimulationModel) -> Self:
        """What `to_bytes` wrote, about the same simulation."""
        head, network = content.split(b"\n", 1)
        known = json.loads(head)
        return cls(
            ContextNetwork.from_bytes(network),
            simulation,
            np.array(known["faulty"], dtype=bool),
            np.array(known["noise"], dtype=float),
            np.array(known["factor"], dtype=float),
        )

    def _several(self, first: int, readings: FloatArray, contexts: FloatArray) -> Candidates:
        """What the network holds possible for rows from `first` on, each from its own readings."""
        measured = contexts[:, self._network.variables.measured_columns]
        seen = np.where(self._faulty, np.nan, readings)
        parts = []
        for number in blocks(first, len(readings)):
            rows = block(number, len(readings))
            shown = seen[rows].tobytes() + measured[rows].tobytes()
            if number not in self._known or self._known[number][0] != shown:
                found = self._network.candidates(seen[rows], measured[rows])
                if (number + 1) * BLOCK > len(readings):
                    parts.append(found)
                    break
                self._known[number] = shown, found
            parts.append(self._known[number][1])
        lead = first % BLOCK
        return joined(parts).rows(slice(lead, lead + len(readings) - first))

    def _arrived(
        self,
        readings: FloatArray,
        contexts: FloatArray,
        time: FloatArray,
        number: int,
        variable: ContextVariable,
        line: tuple[FloatArray, FloatArray],
    ) -> tuple[FloatArray, FloatArray]:
        """The line of a context where the simulation follows it best, or an end of its range.

        Rows without load show a network nothing of where a train is, and a line through nothing
        may well stand on the bridge. What the rows show decides.
        """
        chosen = np.unique(np.linspace(0, len(time) - 1, ROWS_COMPARED).astype(int))
        column = self._network.variables.latent_columns[number]
        seen = np.where(self._faulty, np.nan, readings)[chosen]
        noise = self._noise[: seen.shape[1]]
        low, high = variable.range

        def read(value: FloatArray) -> FloatArray:
            table = contexts[chosen].copy()
            table[:, column] = value
            return self._simulation.readings(time[chosen], table)

        unknown = np.full(len(time), (high - low) / np.sqrt(12))
        lines = [(np.full(len(time), end), unknown) for end in variable.range]
        lines.append(line)
        if variable.rate is not None and len(chosen) > 2:
            found, covariance = polish_line(
                read, seen, noise, time[chosen], line[0][chosen], variable.range, variable.rate
            )
            basis = np.column_stack([np.ones(len(time)), time - time[chosen].mean()])
            spread = np.sqrt(np.einsum("ni,ij,nj->n", basis, covariance, basis))
            lines.append((basis @ found, spread))
        # A line has two numbers to fit with: it must be worth more than that (Schwarz, 1978).
        costs = [0.0, 0.0, *[np.log(np.isfinite(seen).sum())] * (len(lines) - 2)]
        for number, (value, _) in enumerate(lines):
            off = (seen - read(value[chosen])) / noise
            costs[number] += float(np.nansum(np.log1p(off**2)))
        value, spread = lines[int(np.argmin(costs))]
        return value, np.minimum(spread, unknown)

    def _laplace(
        self,
        first: int,
        readings: FloatArray,
        contexts: FloatArray,
        value: FloatArray,
        clock: FloatArray,
    ) -> FloatArray:
        """Spread of rows from `first` on that the sensors leave, by their sensitivity and gap."""
        variables = self._network.variables
        noise = self._noise[: readings.shape[1]]
        measured = contexts[:, variables.measured_columns]
        seen = np.isfinite(np.where(self._faulty, np.nan, readings))
        whole = np.concatenate([np.zeros((first, value.shape[1])), value])
        parts = []
        for number in blocks(first, len(readings)):
            rows = np.maximum(block(number, len(readings)), first)
            spread = laplace_spread(
                self._simulation.simulator,
                variables,
                measured[rows],
                whole[rows],
                seen[rows],
                self._noise,
                clock[rows],
            )
            simulated = self._simulation.readings(
                clock[rows], variables.together(measured[rows], whole[rows])
            )
            gaps = np.where(seen[rows], (readings[rows] - simulated) ** 2, np.nan)
            parts.append(spread * birge_ratio(gaps, noise)[:, None])
        lead = first % BLOCK
        return np.concatenate(parts)[lead : lead + len(value)]

    def _stretch(self, unseen: Samples, clock: float, seed: int) -> None:
        """Measure on simulations that no training saw how far the intervals must reach."""
        assert unseen.latent is not None
        generator = np.random.default_rng(seed)
        sensors = unseen.readings.shape[1]
        readings = unseen.readings + self._noise[:sensors] * generator.standard_normal(
            unseen.readings.shape
        )
        measured = unseen.measured + self._noise[sensors:] * generator.standard_normal(
            unseen.measured.shape
        )
        contexts = self._network.variables.together(measured, unseen.latent)
        alone = ContextVariable(unit="-", range=(0, 1))
        laws = [alone] * unseen.latent.shape[1]
        time = np.full(len(unseen), clock)
        value, spread = self.infer(0, readings, contexts, time, laws)
        self._factor = covering_factor(value - unseen.latent, spread)
        self._known.clear()


def _exact(lesson: Lesson, faulty: NDArray[np.bool_]) -> nn.Module | TwinOnArrays | None:
    """The exact simulation, as the physics loss takes it.

    None where rows hang together and each has a structure of its own, or where none stands as far
    out as networks reach.
    """
    simulation, clock = lesson.simulation, lesson.clock
    model, either = simulation.model, lesson.data.falling.any()
    structural = (effect for effect in model.effects.values() if effect.structural)
    if any(effect.drivers() & set(lesson.latent) for effect in structural):
        if either or any(effect.remembers for effect in model.effects.values()):
            return None
        # A structure of its own for every row takes a solve each: tangents do without.
        middle = np.array([[np.mean(one.range) for one in model.context.values()]])
        offsets = simulation.offsets(np.full(1, clock), middle)
        gains = np.where(faulty, np.nan, simulation.gains)
        twin = CorrectedTwin(simulation.simulator, gains, offsets, time=clock)
        return twin if _stands(twin) else None
    exact = _Exact(simulation, faulty, clock)
    if not either:
        return exact
    column = list(model.context).index(lesson.latent[0])
    return EitherWay(exact, column)


def _stands(twin: TwinOnArrays) -> bool:
    """Whether there is a structure at each context as far out as networks reach."""
    middle, width = twin.ranges.mean(axis=1), np.ptp(twin.ranges, axis=1)
    ends = np.concatenate([side * OUTERMOST * np.diag(width) for side in (-1.0, 1.0)])
    try:
        twin.simulate(middle + ends)
    except InputError:
        return False
    return True


class _Exact(nn.Module):
    """The exact simulation as the physics loss takes it: contexts in, readings out."""

    def __init__(
        self, simulation: SimulationModel, faulty: NDArray[np.bool_], clock: float
    ) -> None:
        super().__init__()
        self._layer = simulation.simulator.as_torch()
        self._simulation, self._clock = simulation, clock
        self._faulty = torch.from_numpy(faulty)

    def forward(self, contexts: Tensor) -> Tensor:
        found = contexts.detach().numpy()
        time = np.full(len(found), self._clock)
        offsets = torch.from_numpy(self._simulation.offsets(time[:1], found[:1]))
        gains = torch.from_numpy(self._simulation.gains)
        readings: Tensor = gains * self._layer(contexts, time) + offsets
        return torch.where(self._faulty, 0.0, readings)
