"""What a structure may have otherwise than its model says, as parameters to be inferred."""

from collections.abc import Iterable, Iterator, Sequence
from dataclasses import dataclass, replace
from functools import cached_property
from itertools import chain, count
from typing import Any

import numpy as np
import scipy

from rga.arrays import FloatArray
from rga.errors import InputError
from rga.inference.joint.joint_stiffness_surrogate import BENDING, with_bending
from rga.model import Model, model_content, read_effect, read_model
from rga.model.parameter import listed
from rga.simulation import Simulator

#: relative spread of the stiffness of a whole group of members (decks, joints), and of a stretch
GROUP, STRETCH = 0.08, 0.04
#: stretches that a group of so many members is cut into, along the bridge
STRETCHES, MANY = 5, 12
#: decimal logarithm of the share of rigid joints' bending, and its spread
FIXITY, FIXITY_SPREAD = -0.5, 0.6
#: decimal logarithm of the stiffness [N/m] of a bearing that the model takes as rigid
BEARING, BEARING_SPREAD = 9.0, 0.7
#: spread of the settlement of a support [m], and what it cannot exceed
SETTLEMENT, SUNK = 0.005, 0.1
#: contexts that are spread over their ranges
SPREAD = 32
#: how much warmer one side gets than the other, per unit of a context that warms
SIDEWAYS = 0.5
#: relative change from which on it is told as a multiple
LARGE = 0.5


@dataclass(frozen=True)
class StructuralParameter:
    """A parameter that the model does not have.

    Attributes:
        name: in words; of the context variable that stands for it.
        effect: as in a model file, without the parameter.
        key: the parameter.
        driven: how the parameter follows the unknown, as in a model file.
        centre, spread: of its normal prior.
        bounds: beyond which it makes no sense.
        follows: context that it is a rate of; None where it is constant.
        linear: whether readings are linear in it.
    """

    name: str
    effect: dict[str, Any]
    key: str
    driven: dict[str, Any]
    centre: float
    spread: float
    bounds: tuple[float, float]
    follows: str | None = None
    linear: bool = False

    def at(self, value: float) -> dict[str, Any]:
        """The effect with the unknown at a value."""
        if self.follows is not None:
            return {**self.effect, self.key: {"context": self.follows, "times": value}}
        moved = self.driven.get("times", 1.0) * value
        return {**self.effect, self.key: 10.0**moved if self.driven.get("log10") else moved}

    def changed(self, before: float, after: float) -> str:
        """A change of it in words.

        >>> sunk = StructuralParameter("settlement of east", {}, "displacement", {}, 0, 1, (-1, 1))
        >>> sunk.changed(0.0, -0.0011)
        'settlement of east -1.1 mm'
        >>> soft = replace(sunk, name="bearing east", key="factor", driven={"log10": True})
        >>> soft.changed(0.0, 0.02), soft.changed(0.0, -1.4)
        ('bearing east +4.7 %', 'bearing east 0.04 times what it was')
        """
        if self.driven.get("log10"):
            factor = 10.0 ** (after - before)
            if abs(factor - 1.0) < LARGE:
                return f"{self.name} {100 * (factor - 1.0):+.2g} %"
            return f"{self.name} {factor:.2g} times what it was"
        if self.follows is not None:
            return f"{self.name} {after - before:+.2g}"
        return f"{self.name} {1e3 * (after - before):+.2g} mm"


class Unknowns:
    """All unknowns of a model, and the model with them.

    Stretches of every group of members may be stiffer or softer, pinned joints may be stiff, rigid
    bearings may give way, supports may have settled, and the sun may warm one side more than the
    other.

    Args:
        model: as it was given.
        time: clock [s] that effects with an onset go by; None where there are none.

    Raises:
        InputError: the model is one that was found with its unknowns.

    Attributes:
        model: as it was given.
        time: the clock.
        parts: the unknowns.
        centre, spread: of their priors, float[unknowns].
        low, high: bounds, float[unknowns].
    """

    def __init__(self, model: Model, time: float | None = None) -> None:
        self.model, self.time = model, time
        self._bending = with_bending(model)
        parts = [
            *_stretches(model), *_joints(self._bending), *_bearings(model), *_settlements(model),
            *_sides(model),
        ]  # fmt: skip
        self.parts = _apart(parts, model.context)
        twice = [part.name for part in self.parts if part.name in model.effects]
        if twice or BENDING in model.groups:
            raise InputError(
                f"the model holds unknowns already, {(twice or [BENDING])[0]!r} among them",
                "unknowns",
                "give the model without them, and what was found as `start` or `prior`",
            )
        self.centre = np.array([part.centre for part in self.parts])
        self.spread = np.array([part.spread for part in self.parts])
        self.low, self.high = np.array([part.bounds for part in self.parts]).reshape(-1, 2).T

    @property
    def names(self) -> list[str]:
        """Of contexts and unknowns."""
        return [*self.model.context, *(part.name for part in self.parts)]

    @cached_property
    def spread_contexts(self) -> FloatArray:
        """Contexts spread over their ranges, float[SPREAD, contexts]."""
        low, high = np.array([one.range for one in self.model.context.values()]).T
        share = scipy.stats.qmc.Sobol(len(low), scramble=True, rng=0).random(SPREAD)
        return np.asarray(low + (high - low) * share)

    def at(self, values: FloatArray) -> Model:
        """The model extended by the unknowns at values, float[unknowns]."""
        # They come first: what does not vary is put on the structure once.
        found = {
            part.name: read_effect(part.at(float(value)), part.name)
            for part, value in zip(self.parts, values, strict=True)
        }
        return self._bending.model_copy(update={"effects": {**found, **self._bending.effects}})

    def linearise(
        self, contexts: FloatArray, values: FloatArray
    ) -> tuple[FloatArray, FloatArray, FloatArray]:
        """Readings, and their derivatives by contexts and by unknowns.

        Args:
            contexts: float[n, contexts].
            values: of the unknowns, float[unknowns].

        Returns:
            float[n, sensors], float[n, sensors, contexts] and float[n, sensors, unknowns].
        """
        many, rates = contexts.shape[1], self._rates
        linear = [number for number, part in enumerate(self.parts) if part.linear]
        driven = [number for number, part in enumerate(self.parts) if not part.linear]
        readings = self.predict(contexts, values)
        by_unknowns = np.empty((*readings.shape, len(values)))
        # Where readings are linear, a difference is the derivative. That it changes with
        # contexts is left out: it hardly does.
        moved = np.vstack([values, values + np.diag(self.spread)[linear]])
        middle = [np.mean(one.range) for one in self.model.context.values()]
        one = np.tile(middle, (len(moved), 1))
        there = self.predict(one, moved)
        by_unknowns[:, :, linear] = (there[1:] - there[0]).T / self.spread[linear]
        slopes = self._of_driven.jacobian(self._table(contexts, values, driven))
        by_contexts, by_unknowns[:, :, driven] = slopes[:, :, :many].copy(), slopes[:, :, many:]
        for number, followed in rates.items():
            by_contexts[:, :, followed] += by_unknowns[:, :, number] * values[number]
            by_unknowns[:, :, number] *= contexts[:, None, followed]
        return readings, by_contexts, by_unknowns

    def predict(self, contexts: FloatArray, values: FloatArray) -> FloatArray:
        """Readings of contexts, float[n, contexts], and unknowns, float[unknowns] or one a row."""
        return self._of_all.predict(self._table(contexts, values, range(len(self.parts))))

    def _table(
        self, contexts: FloatArray, values: FloatArray, chosen: Sequence[int]
    ) -> dict[str, FloatArray]:
        """Columns of contexts and of chosen unknowns, rates times what they follow."""
        columns = np.array(np.broadcast_to(values, (len(contexts), len(self.parts))))
        for number, followed in self._rates.items():
            columns[:, number] *= contexts[:, followed]
        names = [*self.model.context, *(self.parts[number].name for number in chosen)]
        table = dict(zip(names, np.hstack([contexts, columns[:, chosen]]).T, strict=True))
        return table if self.time is None else {**table, "time": np.full(len(contexts), self.time)}

    @cached_property
    def _rates(self) -> dict[int, int]:
        """Numbers of unknowns that are rates, and of the contexts that they follow."""
        names = list(self.model.context)
        followed = {number: part.follows for number, part in enumerate(self.parts)}
        return {number: names.index(name) for number, name in followed.items() if name is not None}

    @cached_property
    def _of_all(self) -> Simulator:
        return self._driven(self.parts)

    @cached_property
    def _of_driven(self) -> Simulator:
        return self._driven([part for part in self.parts if not part.linear])

    def _driven(self, parts: Sequence[StructuralParameter]) -> Simulator:
        """The simulator in which each of some unknowns is a context of its own."""
        content = model_content(self._bending)
        for part in parts:
            content["context"][part.name] = {"unit": "-", "range": list(part.bounds)}
            driven = {"context": part.name, **part.driven}
            content["effects"][part.name] = {**part.effect, part.key: driven}
        return Simulator(read_model(content, "the model with its unknowns"))


def _apart(parts: Sequence[StructuralParameter], taken: Iterable[str]) -> list[StructuralParameter]:
    """The parameters, one that has the name of another or of a context numbered."""
    seen, found = set(taken), []
    for part in parts:
        tried = (f"{part.name} ({number})" for number in count(2))
        name = next(one for one in chain([part.name], tried) if one not in seen)
        seen.add(name)
        found.append(replace(part, name=name))
    return found


def _stretches(model: Model) -> Iterator[StructuralParameter]:
    """Stiffness of the members of each group, side by side and stretch by stretch."""
    points = np.array(list(model.nodes.values()))
    along = int(np.argmax(np.ptp(points[:, :2], axis=0)))
    lowest, width = points.min(axis=0), np.ptp(points, axis=0)
    groups: dict[str, list[tuple[FloatArray, str]]] = {}
    for name, member in model.members.items():
        middle = np.mean([model.nodes[node] for node in member.nodes], axis=0)
        across = (middle[1 - along] - lowest[1 - along]) / (width[1 - along] or 1.0)
        side = "" if 0.25 < across < 0.75 else (" near side" if across < 0.5 else " far side")
        if width[1 - along] == 0:
            side = ""
        groups.setdefault((member.groups or ["members"])[0] + side, []).append((middle, name))
    first = dict.fromkeys(m.groups[0] for m in model.members.values() if m.groups)
    for group in first:
        yield _stiffness(f"stiffness of {group}", {"group": group}, GROUP)
    for group, members in groups.items():
        cuts = STRETCHES if len(members) >= MANY else 1
        cut: dict[int, list[str]] = {}
        for middle, name in members:
            share = (middle[along] - lowest[along]) / width[along]
            cut.setdefault(min(int(cuts * share), cuts - 1), []).append(name)
        for number, names in sorted(cut.items()):
            # A group in the middle that is not cut is the whole group.
            if cuts > 1 or group not in first:
                words = f", stretch {number + 1}" if cuts > 1 else ""
                yield _stiffness(f"stiffness of {group}{words}", {"member": names}, STRETCH)


def _stiffness(name: str, place: dict[str, Any], spread: float) -> StructuralParameter:
    # Contexts follow the logarithm of a stiffness in proportion, and so does their volume.
    effect, bounds = {"kind": "member_stiffness", **place}, (-0.4, 0.4)
    return StructuralParameter(
        name, effect, "factor", {"log10": True}, 0.0, spread / float(np.log(10.0)), bounds
    )


def _joints(model: Model) -> Iterator[StructuralParameter]:
    """Share of the bending of rigid joints that the joints of a group leave to its members."""
    for group in model.groups:
        if group.startswith("bending of "):
            effect = {"kind": "member_stiffness", "group": group}
            yield StructuralParameter(
                group, effect, "factor", {"log10": True}, FIXITY, FIXITY_SPREAD, (-2.0, 1.0)
            )


def _bearings(model: Model) -> Iterator[StructuralParameter]:
    """Upright stiffness of supports that the model takes as rigid."""
    for name, place in _upright(model, "support_flexibility"):
        bounds = (BEARING - 3.0, BEARING + 3.0)
        yield StructuralParameter(
            f"bearing {name}", place, "stiffness", {"log10": True}, BEARING, BEARING_SPREAD, bounds
        )


def _settlements(model: Model) -> Iterator[StructuralParameter]:
    """Upright settlement of supports."""
    for name, place in _upright(model, "support_settlement"):
        yield StructuralParameter(
            f"settlement of {name}", place, "displacement", {}, 0.0, SETTLEMENT, (-SUNK, SUNK),
            linear=True,
        )  # fmt: skip


def _upright(model: Model, kind: str) -> Iterator[tuple[str, dict[str, Any]]]:
    """Supports that hold uz and have no effect of a kind yet, each with that effect's place."""
    taken = {
        name
        for effect in model.effects.values()
        if effect.kind == kind
        for name in listed(getattr(effect, "support"))  # noqa: B009
    }
    for name, support in model.supports.items():
        if "uz" in support.fixed and name not in taken:
            yield name, {"kind": kind, "support": name, "dof": "uz"}


def _sides(model: Model) -> Iterator[StructuralParameter]:
    """Warmth of one side beyond the other, in proportion to what warms."""
    points = np.array(list(model.nodes.values()))
    if np.ptp(points[:, 1]) == 0:
        return
    warming = {
        context: None
        for effect in model.effects.values()
        if effect.kind in ("temperature", "thermal_gradient")
        for context in sorted(effect.drivers())
    }
    for context in warming:
        yield StructuralParameter(
            f"temperature of one side with {context}",
            {"kind": "thermal_gradient", "axis": "lateral"},
            "difference",
            {},
            0.0,
            SIDEWAYS,
            (-5.0, 5.0),
            follows=context,
        )
