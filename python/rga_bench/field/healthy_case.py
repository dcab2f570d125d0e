"""A structure in its weather, before anything is hidden in it: what all cases of a seed share."""

from __future__ import annotations

from dataclasses import dataclass
from typing import Any, NamedTuple

import numpy as np

from rga_bench.field.as_built import as_built, facts
from rga_bench.field.channels import FieldSite, observe, respond
from rga_bench.field.effect_size import ReadingCovariance
from rga_bench.field.logger import logger
from rga_bench.field.solver import Array
from rga_bench.field.structure import FieldStructure
from rga_bench.field.weather import courses, measured
from rga_bench.field.world import Contexts, FieldWorld, amplitudes, influence
from rga_bench.synthetic.noise import stream

#: rows after the record, which the diagnosis does not get
LATER = 60
#: spreads from half to twice the usual
_SPREADS = (0.5, 2.0)
#: realities drawn to account for scatter
_REALITIES = 24
#: between rows [s], and rows that a tare is the mean of
_STEPS, _TARES = (600.0, 1800.0, 3600.0), (2, 5, 10, 20)


@dataclass(frozen=True)
class Options:
    """How a record was made.

    Attributes:
        tared: all channels were zeroed on the first rows, by the mapping beside the record.
        gaps: two outages of the logger.
        quantised: in steps of about the noise.
        broken: one channel has a fault of the library.
    """

    tared: bool = False
    gaps: bool = False
    quantised: bool = False
    broken: bool = False


#: a record without any of these
PLAIN = Options()


class HealthyCase(NamedTuple):
    """All of a case that does not depend on what is hidden; rows are those of an even grid."""

    world: FieldWorld
    site: FieldSite
    measured: Contexts
    clean: Array
    record: np.ndarray
    facts: dict[str, Any]


def healthy_case(
    seed: int, place: FieldStructure, welded: bool, rows: int, options: Options
) -> HealthyCase:
    """The case of a seed; every other context states its noise in the model."""
    rng = stream(seed, "sampling")
    spread = float(np.exp(rng.uniform(*np.log(_SPREADS))))
    step = float(rng.choice(_STEPS))
    grid = rows + (rows // 3 if options.gaps else 0)
    kept = np.ones(grid, dtype=bool)
    lost = grid - rows
    if lost:
        first = int(rng.uniform(0.1, 0.4) * grid)
        second = first + lost // 2 + int(rng.uniform(0.1, 0.4) * (grid - first - lost))
        kept[first : first + lost // 2] = False
        kept[second : second + lost - lost // 2] = False
    time = np.asarray(step * np.arange(grid + LATER), dtype=np.float64)
    contexts = courses(place, stream(seed, "contexts"), time)
    read, noises = measured(place, stream(seed, "context errors"), contexts, spread)
    for name, variable in place.model["context"].items():
        if rng.random() < 0.5:
            variable["noise"] = float(f"{noises[name]:.3g}")
    world = as_built(place, stream(seed, "as built"), welded, spread)
    healthy = respond(world, contexts)
    errors = logger(place, stream(seed, "logger"), healthy, spread, options.quantised)
    site = FieldSite(time, contexts, errors)
    return HealthyCase(
        world,
        site,
        read,
        observe(world, site),
        np.flatnonzero(kept),
        facts(world, welded, spread),
    )


def reading_covariance(
    seed: int, place: FieldStructure, welded: bool, healthy: HealthyCase
) -> ReadingCovariance:
    """What the scatter of realities of this sort does, and noise, over the rows of the record."""
    rng = stream(seed, "other realities")
    spread, rows = healthy.facts["spread"], healthy.record
    drawn = np.array([influence(as_built(place, rng, welded, spread)) for _ in range(_REALITIES)])
    # Gains of channels scatter as the logger's do: about 1 %.
    gains = 1.0 + 0.01 * spread * rng.standard_normal((_REALITIES, 1, drawn.shape[2]))
    scatter = gains * drawn - drawn.mean(axis=0)
    blur = (
        respond(healthy.world, healthy.measured)[rows]
        - respond(healthy.world, healthy.site.contexts)[rows]
    )
    variance = healthy.site.logger.long_run + (blur**2).mean(axis=0)
    amounts = amplitudes(healthy.world, healthy.site.contexts)[rows]
    return ReadingCovariance(variance, amounts, scatter)


def tare_rows(seed: int, healthy: HealthyCase) -> np.ndarray:
    """Rows that the channels were zeroed on."""
    return healthy.record[: int(stream(seed, "tare").choice(_TARES))]
