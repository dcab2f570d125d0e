"""Draw a case of the field: a structure as it stands, and what its logger wrote."""

from __future__ import annotations

from collections.abc import Sequence
from typing import Any

import numpy as np
from threadpoolctl import threadpool_limits

from rga_bench.faults.library import FAULTS, Scale
from rga_bench.field.healthy_case import (
    PLAIN,
    HealthyCase,
    Options,
    healthy_case,
    reading_covariance,
    tare_rows,
)
from rga_bench.field.hidden import KINDS, FieldSetting
from rga_bench.field.inject import ONSETS, FieldEffect, hide, readings
from rga_bench.field.solver import Array
from rga_bench.field.structure import FieldStructure
from rga_bench.field.structures import STRUCTURES
from rga_bench.field.world import FieldWorld
from rga_bench.synthetic.case import Beyond, Case
from rga_bench.synthetic.noise import stream

#: bounds of the d' that is aimed at
AIMS = (10.0, 60.0)


def draw_field(
    seed: int,
    *,
    structure: str | None = None,
    kind: str | Sequence[str] = "null",
    welded: bool = False,
    rows: int = 240,
    options: Options = PLAIN,
    aims: tuple[float, float] = AIMS,
) -> Case:
    """A case of ``rows`` samples of a structure, what is not given drawn by ``seed``.

    Same seed, same bits. Cases that differ by their kind alone share reality, contexts and noise.

    Args:
        seed: of all that is drawn.
        structure: one of `STRUCTURES`.
        kind: one of `KINDS`, several of them, or "null".
        welded: reality has no pins, gussets, and gauges off the centroid.
        rows: of the record.
        options: how it was made.
        aims: bounds of the d' of each effect by itself.

    Raises:
        ValueError: an unknown name, or a kind that the structure cannot have.
    """
    kinds = [one for one in ([kind] if isinstance(kind, str) else kind) if one != "null"]
    if unknown := [one for one in kinds if one not in KINDS]:
        raise ValueError(f"no hidden kind {unknown[0]!r}; there are {', '.join(KINDS)}")
    if structure is not None and structure not in STRUCTURES:
        raise ValueError(f"no structure {structure!r}; there are {', '.join(STRUCTURES)}")
    with threadpool_limits(1):  # BLAS sums in another order where it has more threads
        names = list(STRUCTURES)
        name = structure or names[int(stream(seed, "which").integers(len(names)))]
        place = STRUCTURES[name](stream(seed, "structure"))
        healthy = healthy_case(seed, place, welded, rows, options)
        account = reading_covariance(seed, place, welded, healthy)
        hidden = [hide(seed, one, healthy, account, options, aims) for one in kinds]
        return _case(seed, name, healthy, hidden, options)


def fits(kind: str, structure: str) -> bool:
    """Whether a structure has what a kind acts on."""
    place = STRUCTURES[structure](np.random.default_rng(0))
    time = np.arange(10.0)
    setting = FieldSetting(FieldWorld.of(place), time, np.zeros((10, len(place.model["sensors"]))))
    return KINDS[kind].draw(setting, np.random.default_rng(0)) is not None


def _case(
    seed: int, name: str, healthy: HealthyCase, hidden: Sequence[FieldEffect], options: Options
) -> Case:
    site, record = healthy.site, healthy.record
    place = healthy.world.structure
    clean = readings(healthy, hidden)
    shown = site.logger.logged(clean)[record]
    shown[stream(seed, "missing").random(shown.shape) < 0.002] = np.nan
    sensors = list(place.model["sensors"])
    mapping, tare = None, None
    if options.tared:
        shown = shown + site.logger.offset
        tare = tare_rows(seed, healthy)
        step = site.time[1]
        mapping = f"zero = [0.0, {site.time[tare[-1]] + 0.5 * step - site.time[record[0]]}]\n"
    broken = _break(seed, place, shown, hidden) if options.broken else None
    first = site.time[record[0]]
    rows = np.concatenate([record, np.arange(record[-1] + 1, len(site.time))])
    signatures = [
        readings(healthy, hidden) - readings(healthy, [o for o in hidden if o is not one])
        for one in hidden
    ]

    def as_read(channels: Array) -> Array:
        """As the record would have them: after the tare, in its rows and those after it."""
        zero = 0.0 if tare is None else channels[tare].mean(axis=0)
        return np.asarray((channels - zero)[rows])

    head, *beside = [one.facts for one in hidden] or [
        {"kind": "null", "onset": None, "end": None, "place": {}, "parameter": None,
         "value": None, "d_prime": 0.0}
    ]  # fmt: skip
    unseen = np.zeros((len(rows), len(sensors)), dtype=bool)
    unseen[len(record) :] = True
    beyond = Beyond(
        sensors=place.model["sensors"],
        time=site.time[rows] - first,
        contexts={key: course[rows] for key, course in site.contexts.items()},
        clean=as_read(clean),
        unseen=unseen,
        signatures=[as_read(one) for one in signatures],
        together=as_read(clean - healthy.clean),
    )
    channels = dict(zip(sensors, shown.T, strict=True))
    channels |= {key: course[record] for key, course in healthy.measured.items()}
    truth = {
        **head,
        "bridge": name,
        "joint_stiffness": None,
        **healthy.facts,
        "tared": options.tared,
        "broken": broken,
        "beside": beside,
    }
    return Case(place.model, site.time[record] - first, channels, truth, beyond, mapping)


def _break(
    seed: int, place: FieldStructure, shown: Array, hidden: Sequence[FieldEffect]
) -> dict[str, Any]:
    """Break a channel [n, c] in place; not one that something is hidden in."""
    rng = stream(seed, "broken")
    sensors = place.model["sensors"]
    spared = {
        name
        for one in hidden
        for name in (one.span.place.get("sensor"), *one.span.place.get("sensors", []))
    }
    order = [int(k) for k in rng.permutation(len(sensors))]
    column, other = [k for k in order if list(sensors)[k] not in spared][:2]
    sensor, fault = list(sensors)[column], list(FAULTS)[int(rng.integers(len(FAULTS)))]
    row = int(rng.uniform(*ONSETS) * len(shown)) if rng.random() < 0.5 else 0
    scale = Scale.of(sensors[sensor], shown[:, column])
    shown[:, column] = FAULTS[fault].spoil(shown[:, column], rng, scale, shown[:, other], row)
    return {"sensor": sensor, "fault": fault, "row": row}
