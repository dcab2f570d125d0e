"""How what was built differs from its drawing.

Sources: JCSS Probabilistic Model Code, part 3.02 (structural steel: E lognormal of CoV 0.03) and
part 3.10 (dimensions); EN 10210-2 and EN 10034 (masses of hollow sections within 6 %, of I
sections within 4 %); EN 1090-2, annex B (nodes of lattices). A code's spread is that of all mills:
a structure has some rollings, whose members are alike, so part of each variance is common to a
batch. All spreads are multiplied by a factor drawn from half to twice.
"""

from __future__ import annotations

from dataclasses import replace
from typing import Any

import numpy as np

from rga_bench.field.solver import Array
from rga_bench.field.structure import FieldStructure
from rga_bench.field.world import FieldWorld, Gauge

#: coefficients of variation: of E, of areas (JCSS; 6 % of EN 10210-2 as two of them is 0.03)
_MODULUS, _AREA = 0.03, 0.035
#: beyond which nothing is delivered: masses more than 6 % off are refused (EN 10210-2), and no
#: structural steel is known whose modulus is further from 210 GPa
_REFUSED = 0.06
#: of thermal expansion within a structure: steels differ by some percent, one steel hardly
_EXPANSION = 0.002
#: share of the variance that a rolling has in common, and rollings of a section
_COMMON, _BATCHES = (0.3, 0.8), (1, 4)
#: standard deviation of nodes [m]: EN 1090-2 allows lattices some 5 mm and more
_NODES = 0.003
#: length of gussets to either side of a node [m], and at most as a share of the member
_GUSSET, _GUSSET_SHARE = (0.12, 0.35), 0.06
#: distance of a gauge from the centroid, as a share of the section's half depth: a pair whose
#: halves differ, up to a lone gauge on the face
_OFF_CENTROID = (0.1, 1.0)
#: error of the place of a gauge that the model has at a fibre [m]
_PLACED = 0.004


def as_built(
    structure: FieldStructure, rng: np.random.Generator, welded: bool, spread: float
) -> FieldWorld:
    """A reality of the structure; ``welded``: no joint is a pin, and gauges stand on faces."""
    world = FieldWorld.of(structure)
    bars = world.bars
    area = _scatter(structure, rng, spread * _AREA)
    stiff = area * _scatter(structure, rng, spread * _MODULUS)
    expands = np.exp(spread * _EXPANSION * rng.standard_normal(len(area)))
    moved = spread * _NODES * rng.standard_normal(world.xyz.shape)
    if structure.model.get("plane") == "xz":
        moved[:, 1] = 0.0
    zone = rng.uniform(*_GUSSET, len(area)) * np.clip(spread, 0.7, 1.4)
    span = world.xyz[bars.ends[:, 1]] - world.xyz[bars.ends[:, 0]]
    zone = np.minimum(zone, _GUSSET_SHARE * np.linalg.norm(span, axis=1))
    bends = np.minimum(bars.ei_y, bars.ei_z) > 0.0
    world.bars = replace(
        bars,
        ea=bars.ea * stiff,
        ei_y=bars.ei_y * stiff,
        ei_z=bars.ei_z * stiff,
        gj=bars.gj * stiff,
        alpha=bars.alpha * expands,
        pinned=~bends if welded else bars.pinned,
        zone=np.where(bends, zone, 0.0) if welded else bars.zone,
    )
    world.xyz = world.xyz + moved
    members = structure.model["members"]
    for name, gauge in world.gauges.items():
        member = members[structure.model["sensors"][name]["member"]]
        draws = rng.uniform(size=4)
        if member["kind"] == "frame":
            off = spread * _PLACED * rng.standard_normal(2)
            world.gauges[name] = Gauge(gauge.at, gauge.y + off[0], gauge.z + off[1])
        elif welded:
            depth = structure.depths[member["section"]]
            far = depth * (_OFF_CENTROID[0] + np.ptp(_OFF_CENTROID) * draws[0])
            side = 0.5 * np.pi * int(4.0 * draws[1])
            world.gauges[name] = Gauge(
                0.35 + 0.3 * float(draws[2]), float(far * np.cos(side)), float(far * np.sin(side))
            )
    return world


def facts(world: FieldWorld, welded: bool, spread: float) -> dict[str, Any]:
    """What a truth file says of a reality; ``stiffness``: of every member over the model's [-]."""
    members = world.structure.model["members"]
    factors = world.bars.ea / FieldWorld.of(world.structure).bars.ea
    return {
        "stiffness": {name: float(x) for name, x in zip(members, factors, strict=True)},
        "reality": "frame" if welded else "truss",
        "spread": spread,
        "gauges": {name: list(one) for name, one in world.gauges.items()},
        "gussets": [float(x) for x in world.bars.zone],
    }


def _scatter(structure: FieldStructure, rng: np.random.Generator, sd: float) -> Array:
    """Lognormal factors of the members, alike within rollings, [m]."""
    members = structure.model["members"].values()
    common = rng.uniform(*_COMMON)
    batches = {name: int(rng.integers(*_BATCHES)) for name in structure.model["sections"]}
    rolled = {name: rng.standard_normal(many) for name, many in batches.items()}
    shared = np.array(
        [rolled[m["section"]][int(rng.integers(9)) % batches[m["section"]]] for m in members]
    )
    own = rng.standard_normal(len(shared))
    off = sd * (np.sqrt(common) * shared + np.sqrt(1.0 - common) * own)
    return np.asarray(np.exp(np.clip(off, -_REFUSED, _REFUSED)))
