"""Contexts in, natural frequencies and mode shapes out."""

from collections.abc import Sequence
from pathlib import Path

import numpy as np

from rga import _core
from rga.arrays import FloatArray, IntArray
from rga.errors import InputError
from rga.model import as_model
from rga.model.effect import Effect, Values
from rga.model.readings import Readings
from rga.model.schema import ExpectedMode, Model
from rga.model.structure import Structure
from rga.simulation.contexts import Contexts
from rga.simulation.modal.expected import Expected
from rga.simulation.modal.pairing import Pairing, paired, turned
from rga.simulation.modal.points import motion_at
from rga.simulation.modal.structures import ModalStructures, computed_modes

#: modes beyond the expected ones that are computed, so that none is missed in its place
BEYOND = 4
#: shares of its frequency, in those that a mode may well differ by, within which it is looked for
REACH = 3.0
#: modes of a structure that are looked at, at most
MOST = 200


class ModalSimulator:
    """What frequency and mode_shape sensors read of a model.

    A mode is known by its shape: the computed mode that it is may have any number, and another one
    under other contexts.

    Args:
        model: the structure with its effects, points, modes and sensors, or its file.

    Attributes:
        model: itself.
        expected: modes of the model by name, those computed among them with their shapes.

    Raises:
        InputError: the model expects no mode, or one that cannot be computed.
    """

    def __init__(self, model: Model | str | Path) -> None:
        self.model = as_model(model)
        if not self.model.modes:
            raise InputError("no mode is expected", f"model {self.model.name!r}", "state its modes")
        self._structures = ModalStructures(self.model)
        names = list(self.model.points)
        self._points = {name: number for number, name in enumerate(names)}
        nodes = {name: number for number, name in enumerate(self.model.nodes)}
        points = self.model.points.values()
        self._nodes = np.array([nodes[one.node] for one in points], dtype=np.int64)
        directions = np.array([one.direction for one in points], dtype=float).reshape(-1, 3)
        self._directions = directions / np.linalg.norm(directions, axis=1, keepdims=True)
        self.expected = {name: self._look(name, one) for name, one in self.model.modes.items()}

    @property
    def needed(self) -> set[str]:
        """Context variables that change the structure."""
        return self._structures.needed

    def predict(self, contexts: Contexts | None = None) -> FloatArray:
        """What the sensors read.

        Args:
            contexts: as for `Simulator.predict`; None for a model that no context drives.

        Returns:
            float[rows, modal sensors] in their units, in the order of the model. A mode shape is to
            the scale of what is expected of the mode.

        Raises:
            InputError: as for `Simulator.predict`; the structure is not linear, or leaves no mode
                for one that is expected.
            UnstableStructureError: the structure can move; names node and direction.
        """
        found, of_row = self._side_by_side(contexts) or self._one_by_one(contexts)
        shown = found[of_row]
        recorded = [
            one
            for one in self.model.effects.values()
            if (one.on_sensors and one.on_modes) or one.points_named()
        ]
        if recorded:
            self._as_recorded(shown, recorded, self._structures.table(contexts))
        return shown

    def with_shapes(self) -> Model:
        """The model with shapes of its modes that were known by their number.

        Another model may have another mode of that number.
        """
        points = list(self.model.points)
        modes = dict(self.model.modes)
        for name, look in self.expected.items():
            if modes[name].computed is not None and not look.unseen:
                shape = {
                    points[at]: float(one) for at, one in zip(look.at, look.shape, strict=True)
                }
                modes[name] = modes[name].model_copy(update={"computed": None, "shape": shape})
        return self.model.model_copy(update={"modes": modes})

    def pair(self, contexts: Contexts | None = None) -> tuple[Pairing, FloatArray, FloatArray]:
        """Which computed mode is which, under one row of contexts.

        Returns:
            The pairing; computed frequencies [Hz], float[computed]; their shapes at the points of
            the model for a modal mass of 1 kg, float[computed, points].

        Raises:
            InputError: as `predict`; there is more than one row.
        """
        frequencies, shapes = self._computed(self._structures.one_under(contexts))
        return paired(list(self.expected.values()), frequencies, shapes), frequencies, shapes

    def _as_recorded(self, shown: FloatArray, effects: Sequence[Effect], given: Values) -> None:
        """Change what sensors read as clocks, trackers and accelerometers do, in place."""
        columns = {name: column for column, name in enumerate(self.model.modal_sensors)}
        modes: dict[str, dict[str, int]] = {}
        for name, sensor in self.model.modal_sensors.items():
            modes.setdefault(sensor.mode, {})[sensor.point or ""] = columns[name]
        hertz = [column for own in modes.values() for point, column in own.items() if not point]
        readings = Readings(shown, columns, given["time"], np.zeros(len(shown)), modes)
        for effect in effects:
            values = effect.values(given, len(shown))
            if effect.overrides("frequency_factor"):
                shown[:, hertz] *= effect.frequency_factor(values)[:, None]
            effect.change_readings(readings, values)

    def _look(self, name: str, mode: ExpectedMode) -> Expected:
        at = np.array([self._points[point] for point in mode.shape], dtype=np.int64)
        shape = np.array(list(mode.shape.values()), dtype=float)
        if mode.computed is not None:
            middle = {name: sum(one.range) / 2 for name, one in self.model.context.items()}
            structure = self._structures.one_under(middle)
            # Beside modes that move the points it shows whether this one does.
            count = max(mode.computed, len(self.model.modes)) + BEYOND
            frequencies, shapes = self._at_points(structure, count)
            if len(frequencies) < mode.computed:
                raise InputError(
                    f"the model has {len(frequencies)} modes, and mode {name!r} is number "
                    f"{mode.computed}",
                    f"modes of model {self.model.name!r}",
                    "state a lower number, or more masses",
                )
            at, shape = np.arange(len(self._points)), shapes[mode.computed - 1]
        return Expected(mode.near, mode.within, at, shape)

    def _one_by_one(self, contexts: Contexts | None) -> tuple[FloatArray, IntArray]:
        """What sensors read of structures, float[structures, sensors], and which is each row's."""
        structures, of_row = self._structures.under(contexts)
        found = np.array([self._read(*self._computed(structure)) for structure in structures])
        return found.reshape(len(structures), len(self.model.modal_sensors)), of_row

    def _side_by_side(self, contexts: Contexts | None) -> tuple[FloatArray, IntArray] | None:
        """The same where nothing but stiffnesses vary; None where something else does."""
        samples = self._structures.samples(contexts)
        if samples is None:
            return None
        structure, factors = samples.start.arrays, samples.factors
        found = np.empty((len(factors), len(self.model.modal_sensors)))
        left, count = np.arange(len(factors)), len(self.expected) + BEYOND
        dofs = (6 * self._nodes[:, None] + np.arange(3)).ravel()
        while len(left):
            try:
                batch = _core.ModalBatch(structure, samples.masses, samples.elements, count, dofs)
                squares, moving = batch.modes(factors[left])
            except (_core.UnstableStructure, _core.InvalidInput):
                return None  # a structure by itself tells what is wrong, or has fewer modes
            moving = moving.reshape(len(left), count, len(self._nodes), 3)
            shapes = motion_at(moving, self._directions)
            frequencies = np.sqrt(squares) / (2 * np.pi)
            enough = (frequencies[:, -1] > self._reach) | (count >= MOST)
            for number in np.flatnonzero(enough):
                found[left[number]] = self._read(frequencies[number], shapes[number])
            left, count = left[~enough], min(2 * count, MOST)
        return found, samples.state_of_row

    def _read(self, frequencies: FloatArray, shapes: FloatArray) -> FloatArray:
        modes = list(self.expected.values())
        pairing = paired(modes, frequencies, shapes)
        at_points = turned(modes, pairing, frequencies, shapes)
        numbers = {name: number for number, name in enumerate(self.expected)}
        found = np.empty(len(self.model.modal_sensors))
        for at, (name, sensor) in enumerate(self.model.modal_sensors.items()):
            mode = numbers[sensor.mode]
            if pairing.computed[mode] < 0:
                raise InputError(
                    f"no computed mode is left for {sensor.mode!r}",
                    f"sensor {name!r}",
                    "state modes that the model has, and masses for them",
                )
            found[at] = (
                frequencies[pairing.computed[mode]]
                if sensor.point is None
                else at_points[mode, self._points[sensor.point]]
            )
        return found

    @property
    def _reach(self) -> float:
        """Up to where the expected modes may be [Hz]."""
        each = (one.near * np.exp(REACH * one.within) for one in self.expected.values())
        return float(max(each))

    def _computed(self, structure: Structure) -> tuple[FloatArray, FloatArray]:
        """Modes up to where the expected ones may be, and some beyond."""
        count = len(self.expected) + BEYOND
        while True:
            frequencies, shapes = self._at_points(structure, count)
            if len(frequencies) < count or frequencies[-1] > self._reach or count >= MOST:
                return frequencies, shapes
            count = min(2 * count, MOST)

    def _at_points(self, structure: Structure, count: int) -> tuple[FloatArray, FloatArray]:
        frequencies, shapes, _, _ = computed_modes(structure, count)
        return frequencies, motion_at(shapes[:, self._nodes, :3], self._directions)
