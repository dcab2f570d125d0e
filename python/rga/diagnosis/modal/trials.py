"""What a model with effects predicts of the modes that were measured."""

from collections.abc import Iterator, Mapping, Sequence
from dataclasses import replace
from functools import cached_property
from typing import Generic, TypeVar

import numpy as np

from rga import _core
from rga.arrays import FloatArray, IntArray
from rga.diagnosis.modal.points.errors import WRONG, PointErrors, mixing, stiffness_off
from rga.diagnosis.modal.points.recorded import as_recorded
from rga.diagnosis.modal.prediction import Computed, Prediction
from rga.diagnosis.modal.readings import ModalWindows
from rga.diagnosis.modal.stages import of_windows, stages
from rga.diagnosis.modal.standing import stands_late, without_standing
from rga.diagnosis.modal.supports import supports, window_contexts
from rga.errors import InputError
from rga.model.effect import Effect, Values
from rga.model.effects.members.stiffness_temperature import contexts_of_temperature
from rga.model.schema import Model
from rga.model.structure import Structure
from rga.simulation.modal.expected import Expected, mac
from rga.simulation.modal.mixed_shapes import couplings, parts_of_others, unlike_computed
from rga.simulation.modal.pairing import DOUBTFUL, Pairing, mixture, paired
from rga.simulation.modal.points import motion_at
from rga.simulation.modal.structures import ModalStructures
from rga.simulation.paths.response import refused

#: modes computed beyond those that are looked for, so that none is missed in its place
BEYOND = 4
#: shares of its frequency, in those that a mode may well differ by, within which it is looked for
REACH = 3.0
#: part of a frequency that a model leaves which is right in all that one can name
RIGHT = 0.03
#: modes that are looked at, at most; numbers in the states that are kept, and structures of which
#: all modes are
MOST, KEPT, SOLVED = 200, 2**24, 8

AnyWindows = TypeVar("AnyWindows", bound=ModalWindows)


class ModalTrials(Generic[AnyWindows]):
    """A model, to which effects are added in turn, under the contexts of measured windows.

    The pairing of computed modes with measured ones is made anew for every trial.

    Args:
        model: with its effects.
        readings: what was measured.

    Raises:
        InputError: a context that drives the structure was not measured; or as `ModalStructures`.
        UnstableStructureError: the structure can move.
    """

    def __init__(self, model: Model, readings: AnyWindows) -> None:
        self.model, self.readings = model, readings
        points = list(model.points.values())
        nodes = {name: number for number, name in enumerate(model.nodes)}
        self._nodes = np.array([nodes[one.node] for one in points], dtype=np.int64)
        axes = np.array([one.direction for one in points], dtype=float).reshape(-1, 3)
        self._axes = axes / np.linalg.norm(axes, axis=1, keepdims=True)
        # What begins late, or is in the clock, acts window by window as hypotheses do.
        self._own = {name: one for name, one in model.effects.items() if of_windows(one)}
        always = {name: one for name, one in model.effects.items() if name not in self._own}
        structures = ModalStructures(model.model_copy(update={"effects": always}))
        self._given = window_contexts(model, structures.needed, readings)
        following = structures.needed or contexts_of_temperature(model)
        driving = [self._given[name] for name in sorted(following)]
        standing = [one.weight(readings.time) for one in always.values() if stands_late(one)]
        chosen, self._weights, self._middle = supports(readings, driving, standing)
        self._contexts: Values = {name: column[chosen] for name, column in self._given.items()} | {
            "time": readings.time[chosen]
        }
        self._structures = structures.each_under(self._contexts)
        # What is tried may ask for values of effects that move no mode by themselves.
        asked = {
            name: one.values(self._contexts, len(chosen))
            for name, one in always.items()
            if not one.at_sensors() and not one.is_load
        }
        self._values = asked | structures.parameters(self._contexts)
        reach = max(look.near * np.exp(REACH * look.within) for look in readings.looks)
        self._below = float((2 * np.pi * reach) ** 2)
        self._known: dict[str, Prediction] = {}
        self._kept = 0
        self._modes_known: dict[str, list[Computed]] = {}
        usual = self._structures[self._middle]
        self._count = len(readings.modes) + BEYOND
        self._near = self._reanalysis(usual)
        self._count = max(self._count, len(self._modes(usual)[0]) - 1 + BEYOND)
        self._near = self._reanalysis(usual)
        self._wrong = max(WRONG)
        self._wrong = stiffness_off(np.nanmean(readings.log_f - self.predict({}).log_f, axis=0))
        self._known, self._kept = {}, 0

    @property
    def follows_contexts(self) -> bool:
        """Whether contexts may change the structure, and so more than one of them is looked at."""
        return len(self._structures) > 1

    @cached_property
    def by_standing(self) -> FloatArray:
        """What loads that bring their mass change of ln f by the model, float[windows, modes]."""
        bare = without_standing(self.model)
        if bare is self.model:
            return np.zeros(self.readings.log_f.shape)
        without = ModalTrials(bare, self.readings).predict({})
        return np.asarray(self.predict({}).log_f - without.log_f)

    @cached_property
    def point_errors(self) -> PointErrors:
        """How far single points lie off what structures make of shapes."""
        nothing = self.predict({})
        return PointErrors(self.readings.looks, nothing.every, nothing.mixing)

    def predict(self, effects: Mapping[str, Effect]) -> Prediction:
        """The modes with more effects.

        Effects that begin late act in the windows from then on: windows in which the same ones act
        have the same structure.

        Args:
            effects: by name; those that are no part of a structure or of a clock do nothing here.

        Raises:
            InputError: the effects cannot be simulated, or leave no mode for one that was
                measured.
        """
        log_f = np.empty(self.readings.log_f.shape)
        shares, states = [], []
        for own, acting in stages({**self._own, **effects}, self.readings.time):
            state = self._state(acting)
            log_f[own] = self._weights[own] @ state.log_f
            shares.append(float(own.mean()))
            states.append(state)
        first = states[int(np.argmax(shares))]
        shapes, at_points = np.zeros_like(first.shapes), np.zeros_like(first.at_points)
        for share, state in zip(shares, states, strict=True):
            turned = share * np.sign(np.einsum("mna,mna->m", state.shapes, first.shapes))
            shapes += turned[:, None, None] * state.shapes
            at_points += turned[:, None] * state.at_points
        return replace(
            first,
            log_f=log_f,
            shapes=shapes,
            at_points=at_points,
            every=np.concatenate([state.every for state in states]),
            recorded=np.concatenate([state.recorded for state in states]),
            mixing=np.concatenate(
                [share * one.mixing for share, one in zip(shares, states, strict=True)], axis=1
            ),
            doubtful=frozenset().union(*(one.doubtful for one in states)),
        )

    def looks(self, effects: Mapping[str, Effect]) -> dict[int, dict[str, Expected]]:
        """What modes look like where effects act, by number of the window and name of the mode."""
        found: dict[int, dict[str, Expected]] = {}
        for own, acting in stages({**self._own, **effects}, self.readings.time):
            if not acting:
                continue
            state = self._state(acting)
            for window in np.flatnonzero(own):
                near = np.exp(self._weights[window] @ state.log_f)
                found[int(window)] = {
                    name: Expected(float(one), min(look.within, RIGHT), look.at, shape[look.at])
                    for name, look, one, shape in zip(
                        self.readings.modes, self.readings.looks, near, state.at_points, strict=True
                    )
                }
        return found

    def at_points_by_window(self, effects: Mapping[str, Effect]) -> FloatArray:
        """Shapes as sensors at the points record them, float[windows, modes, points]."""
        readings = self.readings
        found = np.empty((len(readings.time), len(readings.modes), len(self.model.points)))
        for own, acting in stages({**self._own, **effects}, readings.time):
            found[own] = self._state(acting).at_points
        return found

    def slopes(self) -> tuple[FloatArray, FloatArray]:
        """Derivatives of ln f by what members and nodes have, without the model's more effects.

        Returns:
            By the logarithm of the stiffness of members, then of springs,
            float[modes, members + springs]; by a mass on nodes [1/kg], float[modes, nodes].
        """
        structure = self._structures[self._middle]
        found = self._state([])
        squares, shapes, *_ = self._modes(structure)
        strain, _ = _core.modal_energies(structure.arrays, structure.masses, shapes)
        own = squares[found.number][:, None]
        moving = shapes[found.number, : len(self.model.nodes), :3]
        return 0.5 * strain[found.number] / own, -0.5 * (moving**2).sum(axis=2)

    def _state(self, effects: Sequence[Effect]) -> Prediction:
        """The modes where effects act all the time, under the contexts that stand for all."""
        key = repr(effects)
        if key not in self._known:
            state = self._known[key] = self._simulated(effects)
            self._kept += state.size
            while self._kept > KEPT and len(self._known) > 1:
                self._kept -= self._known.pop(next(iter(self._known))).size
        return self._known[key]

    def _simulated(self, effects: Sequence[Effect]) -> Prediction:
        recording = [one for one in effects if one.points_named()]
        solved = self._solved([one for one in effects if not one.points_named()])
        true = [one.at_points for one in solved]
        recorded = as_recorded(true, recording, self.model.points, self._contexts)
        states: list[Prediction] = []
        for row, (one, seen) in enumerate(zip(solved, recorded, strict=True)):
            again = row > 0 and one is solved[row - 1] and np.array_equal(seen, recorded[row - 1])
            states.append(states[-1] if again else self._paired(one, seen))
        return replace(states[self._middle], log_f=np.array([state.log_f for state in states]))

    def _solved(self, effects: Sequence[Effect]) -> list[Computed]:
        """Modes under each of the contexts that stand for all; of few structures they are kept.

        What acts at points leaves them as they are: none is solved anew for it.
        """
        key = repr(effects)
        if key not in self._modes_known:
            self._modes_known[key] = list(self._each_solved(effects))
            if len(self._modes_known) > SOLVED:
                del self._modes_known[next(iter(self._modes_known))]
        return self._modes_known[key]

    def _each_solved(self, effects: Sequence[Effect]) -> Iterator[Computed]:
        values: list[Values] = []
        rows = len(self._structures)
        for effect in effects:
            own = effect.values(self._contexts, rows)
            if effect.overrides("change_values"):
                effect.change_values({**self._values, "": own}, own, self._contexts["time"])
            values.append(own)
        known: dict[str, Computed] = {}
        for row, structure in enumerate(self._structures):
            here = [{name: column[[row]] for name, column in own.items()} for own in values]
            # Where nothing follows a context, all rows have one structure.
            key = repr((id(structure), [[float(x[0]) for x in own.values()] for own in here]))
            if key not in known:
                known[key] = self._computed(structure, list(zip(effects, here, strict=True)))
            yield known[key]

    def _computed(self, structure: Structure, acting: Sequence[tuple[Effect, Values]]) -> Computed:
        """Modes of a structure with effects, each with its values in one row."""
        if any(effect.structural for effect, _ in acting):
            structure = structure.copy()
            for effect, own in acting:
                if effect.structural:
                    effect.change_structure(structure, {k: float(c[0]) for k, c in own.items()})
            if not structure.linear:
                raise InputError(
                    "an effect leaves no natural frequency of its own", "modes", "leave it out"
                )
        factor = [
            float(effect.frequency_factor(own)[0])
            for effect, own in acting
            if effect.overrides("frequency_factor")
        ]
        squares, shapes, *_ = self._modes(structure)
        if not len(squares):
            raise InputError("no computed mode is left", "modes", "state more masses")
        moving = shapes[:, : len(self.model.nodes), :3]
        log_f = np.log(np.sqrt(squares) / (2 * np.pi))
        return Computed(log_f, moving, self.at_points(moving), float(np.log(factor).sum()))

    def _paired(self, solved: Computed, recorded: FloatArray) -> Prediction:
        looks, log_f = self.readings.looks, solved.log_f
        unlike, freedom = unlike_computed(looks, couplings(log_f), recorded)
        pairing = paired(looks, np.exp(log_f), recorded, unlike=unlike, freedom=freedom)
        if (pairing.computed < 0).any():
            lacking = self.readings.modes[int(np.argmin(pairing.computed))]
            raise InputError(
                f"no computed mode is left for {lacking!r}", "modes", "state more masses"
            )
        number = pairing.computed
        turn = mixture(looks, number, log_f, recorded)
        at_points, true = turn @ recorded, turn @ solved.at_points
        own = [at_points[one, look.at] for look, one in zip(looks, number, strict=True)]
        return Prediction(
            log_f[number] + solved.shift,
            np.tensordot(turn[number], solved.moving, 1),
            number,
            at_points[number],
            true,
            at_points,
            mixing(looks, log_f, true, number, self._wrong),
            np.array(
                [
                    mac(look.shape, one) if len(look.at) else np.nan
                    for look, one in zip(looks, own, strict=True)
                ]
            ),
            frozenset(
                (mode, int(number[mode]), int(other[0][mode]))
                for other in pairing.others
                if self._as_probable(pairing, other, log_f)
                for mode in np.flatnonzero(other[0] != number).tolist()
            ),
            tuple(
                parts_of_others(log_f, at_points[:, look.at], int(one))
                for look, one in zip(looks, number, strict=True)
            ),
        )

    def _as_probable(
        self, pairing: Pairing, other: tuple[IntArray, float], log_f: FloatArray
    ) -> bool:
        """Whether another pairing would be nearly as probable in a model that is right.

        Pairs are made for models that are wrong by as much as a mode may well differ.
        """
        computed, cost = other
        log_near = np.log([look.near for look in self.readings.looks])
        within = np.array([look.within for look in self.readings.looks])
        told = np.minimum(within, RIGHT) ** -2.0 - within**-2.0
        known = (computed >= 0) & (pairing.computed >= 0)
        squares = [
            np.where(known, (log_f[one] - log_near) ** 2, 0.0)
            for one in (computed, pairing.computed)
        ]
        dearer = cost - pairing.cost + 0.5 * float(told @ (squares[0] - squares[1]))
        return dearer < DOUBTFUL

    def at_points(self, shapes: FloatArray) -> FloatArray:
        """Motion of shapes float[modes, nodes, 3] at the points, float[modes, points]."""
        return motion_at(shapes[:, self._nodes], self._axes)

    def _modes(self, structure: Structure) -> tuple[FloatArray, FloatArray, FloatArray, FloatArray]:
        """Modes up to where the measured ones may be; as many as of the model itself at least."""
        try:
            return self._near.modes_below(
                structure.arrays, structure.masses, self._below, self._count, MOST
            )
        except (_core.UnstableStructure, _core.InvalidInput) as error:
            raise refused(structure, error) from None

    def _reanalysis(self, usual: Structure) -> _core.ModalReanalysis:
        try:
            return _core.ModalReanalysis(usual.arrays, usual.masses, self._count)
        except (_core.UnstableStructure, _core.InvalidInput) as error:
            raise refused(usual, error) from None
