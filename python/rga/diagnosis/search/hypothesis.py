"""Hypotheses: kinds of effects at places, with priors of their parameters."""

from collections.abc import Collection, Iterator, Mapping, Sequence
from dataclasses import dataclass, replace
from functools import cached_property
from typing import Any, Literal

import numpy as np

from rga.arrays import FloatArray
from rga.model.effect import Effect
from rga.model.parameter import Prior
from rga.model.schema import Model

#: onsets that are distinguished when the prior is spread over time
ONSETS = 20
#: log prior of an onset and a profile, against acting always: both count alike together
LATE = -float(np.log(2 * ONSETS))
Profile = Literal["step", "ramp"]


@dataclass(frozen=True)
class Hypothesis:
    """An effect of a kind at a place, its parameters unknown.

    Attributes:
        kind: class of the effect.
        place: as in the model file.
        priors: of the parameters, by name.
        onset: time at which the effect begins [s], or None for always.
        profile: how it comes: at once, or growing.
        end: time at which it is fully grown [s]; None: the last row.
        places: number of places at which the kind could act, and of forms that it has there.
        kinds: number of kinds that could act.
    """

    kind: type[Effect]
    place: Mapping[str, Any]
    priors: Mapping[str, Prior]
    places: int
    kinds: int
    onset: float | None = None
    profile: Profile = "step"
    end: float | None = None

    def effect(self, z: Sequence[float] | FloatArray) -> Effect:
        """The effect with parameters at standard normal coordinates z, one a parameter."""
        return self._usual.with_values(self._values(z))

    @cached_property
    def _usual(self) -> Effect:
        """The effect in the middle of its priors: others differ in values alone."""
        late = {"onset": self.onset, "profile": self.profile, "end": self.end}
        given = {**self.place, **self._values([0.0] * len(self.priors)), **late}
        return self.kind(kind=self.name, **given)

    def _values(self, z: Sequence[float] | FloatArray) -> dict[str, float]:
        """Parameters at coordinates."""
        return {
            name: float(prior.value(float(one)))
            for (name, prior), one in zip(self.priors.items(), z, strict=True)
        }

    @property
    def name(self) -> str:
        """The kind as in the model file."""
        return str(self.kind.model_fields["kind"].default)

    @cached_property
    def points(self) -> list[str]:
        """The points at which it acts on what is measured of mode shapes, and on nothing else."""
        return self._usual.points_named()

    @property
    def at_points(self) -> bool:
        """Whether it acts at points."""
        return bool(self.points)

    @property
    def log_prior(self) -> float:
        """Log prior: kinds, places of a kind, moments of an onset and profiles count alike."""
        late = 0.0 if self.onset is None else LATE
        return float(late - np.log(2) - np.log(self.places) - np.log(self.kinds))

    def beginning(
        self, onset: float | None, profile: Profile = "step", end: float | None = None
    ) -> "Hypothesis":
        """The same with another onset."""
        if (self.onset, self.profile, self.end) == (onset, profile, end):
            return self
        return replace(self, onset=onset, profile=profile, end=end)

    def beginning_with(self, other: "Hypothesis") -> "Hypothesis":
        """The same with the onset of another."""
        return self.beginning(other.onset, other.profile, other.end)

    def same_place(self, other: "Hypothesis") -> bool:
        """True for the same kind at the same place, where one has all parameters of the other."""
        if self.kind is not other.kind or self.place != other.place:
            return False
        own, others = self.priors.keys(), other.priors.keys()
        return own <= others or others <= own

    def contains(self, other: "Hypothesis") -> bool:
        """True where this is the same kind at several places, one of which is the other's."""
        if self.kind is not other.kind or self.place == other.place:
            return False
        if self.onset != other.onset or self.place.keys() != other.place.keys():
            return False
        return all(
            set(_listed(other.place[field])) <= set(_listed(named))
            for field, named in self.place.items()
            if isinstance(named, str | list)
        )


def hypotheses(model: Model, sensors: Sequence[str], measured: Collection[str]) -> list[Hypothesis]:
    """All hypotheses that the vocabulary allows on a model, of what static readings show.

    Args:
        model: as it was given.
        sensors: channels that work; a hypothesis on another sensor is left out.
        measured: contexts that were measured; one on another context is left out.
    """
    kinds = [kind for kind in Effect.vocabulary.values() if not kind.on_modes]
    return hypotheses_of(kinds, model, sensors, measured)


def hypotheses_of(
    kinds: Sequence[type[Effect]],
    model: Model,
    sensors: Sequence[str],
    measured: Collection[str],
    points: Collection[str] = (),
) -> list[Hypothesis]:
    """The same of some kinds, and at points at which shapes were measured."""
    present = {"sensor": sensors, "context": measured, "point": points}
    by_kind = {
        kind: [place for place in kind.places(model) if _seen(kind, place, present)]
        for kind in kinds
    }
    acting = sum(bool(places) for places in by_kind.values())
    found = []
    for kind, places in by_kind.items():
        forms = [(place, priors) for place in places for priors in kind.forms(model, place)]
        found += [Hypothesis(kind, place, priors, len(forms), acting) for place, priors in forms]
    return found


def _seen(
    kind: type[Effect], place: Mapping[str, Any], present: Mapping[str, Collection[str]]
) -> bool:
    return all(
        one in present[mark.of]
        for field, mark in kind.place_fields().items()
        if mark.of in present and place.get(field) is not None
        for one in _listed(place[field])
    )


def _listed(names: Any) -> Iterator[str]:
    yield from ([names] if isinstance(names, str) else names)
