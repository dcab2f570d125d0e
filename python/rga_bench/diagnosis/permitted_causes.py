"""What is true of a case though it is not hidden: named or not, it is no mistake."""

from collections.abc import Mapping, Sequence
from dataclasses import dataclass, field
from typing import Any

import numpy as np

from rga.findings import Findings
from rga_bench.diagnosis.hidden import stiff_joints
from rga_bench.synthetic import Case

#: the true state of a frame that is modelled as a truss
STIFF_JOINTS = ("joint_rigidity", "rigid_end_zone")
#: and that of its gauges, where they stand off the centroid
WELDED = (*STIFF_JOINTS, "gauge_position")
#: a rolling, or a member, whose stiffness is off by this much is so in earnest [-]
OFF = 0.02
#: of the true deviation, by which one that is named may differ from it
NEAR = 0.5


@dataclass(frozen=True)
class PermittedCauses:
    """What is true of a case beside what is hidden.

    Attributes:
        kinds: of the true state of a frame that is modelled as a truss.
        broken: the channel that is broken, if there is one.
        stiffness: of every member over the model's, where rollings differ [-].
        gussets: rigid length at each end of every member [m].
        model: of the case, as a dict.
        gauges: where each stands: a share of the length of its member, y and z [m].
    """

    kinds: tuple[str, ...] = ()
    broken: str | None = None
    stiffness: Mapping[str, float] = field(default_factory=dict)
    gussets: Mapping[str, float] = field(default_factory=dict)
    model: Mapping[str, Any] = field(default_factory=dict)
    gauges: Mapping[str, Sequence[float]] = field(default_factory=dict)

    @classmethod
    def of(cls, case: Case) -> "PermittedCauses":
        """That of a case of either generator."""
        if "gussets" not in case.truth:
            return cls(STIFF_JOINTS if stiff_joints(case) is not None else ())
        broken = case.truth["broken"]
        return cls(
            kinds=WELDED if case.truth["reality"] == "frame" else (),
            broken=broken["sensor"] if broken else None,
            stiffness=case.truth["stiffness"],
            gussets=dict(zip(case.model["members"], case.truth["gussets"], strict=True)),
            model=case.model,
            gauges=case.truth["gauges"],
        )

    def has(self, effect: Mapping[str, Any]) -> bool:
        """Whether an effect is one of these."""
        return (
            effect["kind"] in self.kinds
            or self._on_broken(effect)
            or self._of_batch(effect)
            or self._of_gauge(effect)
        )

    def broken_reported(self, findings: Findings) -> bool | None:
        """Whether the broken channel is a cause or a rival; None: there is none."""
        if self.broken is None:
            return None
        return any(
            self._on_broken(one)
            for cause in findings.causes
            for one in (cause.effect, *cause.rivals)
        )

    def _on_broken(self, effect: Mapping[str, Any]) -> bool:
        sensors = effect.get("sensor") or effect.get("sensors") or ()
        return self.broken is not None and self.broken in _listed(sensors)

    def _of_batch(self, effect: Mapping[str, Any]) -> bool:
        """A stiffness that rolling mills and gussets put there, near its true value."""
        members = self.model.get("members", {})
        if effect["kind"] == "elastic_modulus":
            materials = _listed(effect["material"])
            several = [name for name, one in members.items() if one["material"] in materials]
        elif effect["kind"] == "member_stiffness":
            groups = set(_listed(effect.get("group") or ()))
            named = _listed(effect.get("member") or ())
            several = [
                name
                for name, one in members.items()
                if name in named or groups & set(one["groups"])
            ]
        else:
            return False
        if not several or effect.get("onset") is not None:
            return False
        off = _estimated(effect["factor"]) - 1.0
        rolled = np.array([self.stiffness[name] for name in several])
        # Between its nodes, which is what moves them, a member is stiffer by its rigid ends.
        between = rolled / np.array([1.0 - self._rigid_share(name) for name in several])
        return any(
            abs(true) > OFF and abs(off - true) < NEAR * abs(true)
            for true in (float(np.exp(np.log(one).mean()) - 1.0) for one in (rolled, between))
        )

    def _rigid_share(self, member: str) -> float:
        """Share of the length of a member that its gussets are."""
        first, last = (self.model["nodes"][node] for node in self.model["members"][member]["nodes"])
        return 2.0 * self.gussets[member] / float(np.linalg.norm(np.subtract(last, first)))

    def _of_gauge(self, effect: Mapping[str, Any]) -> bool:
        """A gauge that stands beside its place in the model, about as far as it is said to."""
        sensor = str(effect.get("sensor"))
        if effect["kind"] != "gauge_position" or sensor not in self.gauges:
            return False
        stated = self.model["sensors"][sensor]
        _, y, z = self.gauges[sensor]
        true = np.array([y - stated.get("y", 0.0), z - stated.get("z", 0.0)])
        told = np.array([_estimated(effect.get(axis, 0.0)) for axis in "yz"])
        farthest = int(np.abs(true).argmax())
        return bool(abs(told - true)[farthest] < NEAR * abs(true[farthest]))


def _listed(place: Any) -> tuple[str, ...]:
    return (place,) if isinstance(place, str) else tuple(place)


def _estimated(value: Any) -> float:
    return float(value["value"] if isinstance(value, Mapping) else value)
