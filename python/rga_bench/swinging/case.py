"""Draw a case with measured modes: a structure as it stands, and what a campaign found."""

from __future__ import annotations

from collections.abc import Callable
from dataclasses import dataclass, field
from pathlib import Path
from typing import Any, NamedTuple

import numpy as np
from threadpoolctl import threadpool_limits

from rga_bench.field.as_built import as_built, facts
from rga_bench.field.channels import observe
from rga_bench.field.healthy_case import PLAIN, HealthyCase, healthy_case, reading_covariance
from rga_bench.field.hidden import FieldSetting
from rga_bench.field.solver import Array
from rga_bench.field.structure import FieldStructure
from rga_bench.field.structures import STRUCTURES
from rga_bench.field.world import FieldWorld
from rga_bench.swinging.campaign import Campaign, entries, expected, instruments
from rga_bench.swinging.hidden import OF_GAUGES, OF_MODES, SwingingSpan
from rga_bench.swinging.masses import as_weighed, weigh
from rga_bench.swinging.vibration import SwingingWorld, Vibrations, changed, vibrations
from rga_bench.synthetic.case import Case
from rga_bench.synthetic.noise import stream

#: modes of a structure in space, and of one in a plane
MODES = {True: 6, False: 8}
#: bounds of the d' that is aimed at, and of the spread of realities
AIMS, _SPREADS = (12.0, 60.0), (0.3, 1.0)
#: how often an effect begins late, and where, as a share of the record
_LATE, _ONSETS = 0.5, (0.3, 0.7)
#: rows of a record beside the modes, and time between windows without one [s]
_ROWS, _STEP = 160, 21_600.0
#: what a model that is right in all else misses of a frequency, as a share of it
_MISSED = 0.01
_PLACES, _HALVINGS = 8, 9


@dataclass(frozen=True)
class ModalCase(Case):
    """A case with modes; without ``channels`` there are modes alone.

    ``modal``: the long table; ``frequency`` [windows, modes]: of the modes of the model [Hz], NaN
    where one was not found.
    """

    modal: str = ""
    frequency: Array = field(default_factory=lambda: np.zeros((0, 0)))

    def write(self, folder: str | Path) -> None:
        """Write the files: `modes.csv` beside those of every case."""
        super().write(folder)
        (Path(folder) / "modes.csv").write_text(self.modal, encoding="utf-8")
        if not self.channels:
            (Path(folder) / "record.csv").unlink()


class _Hidden(NamedTuple):
    """An effect in a case; ``onset`` [s], None: always."""

    kind: str
    span: SwingingSpan
    value: float
    onset: float | None
    d_prime: float

    def in_(self, swinging: SwingingWorld) -> SwingingWorld:
        """A reality with the effect."""
        other = swinging.copy()
        self.span.act(other, self.value)
        return other


def draw_modal(
    seed: int,
    *,
    structure: str,
    kind: str,
    welded: bool,
    campaign: Campaign,
    beside: bool,
    aims: tuple[float, float] = AIMS,
    rows: int = _ROWS,
) -> ModalCase:
    """A case of a structure with measured modes; the same seed, the same bits.

    Cases that differ by their kind alone share reality, weather and noise.

    Args:
        seed: of all that is drawn.
        structure: one of `STRUCTURES`.
        kind: one of `OF_MODES`, beside a record of `OF_GAUGES` too, or "null".
        welded: reality has no pins.
        campaign: how modes were measured.
        beside: a record of the gauges stands beside the modes.
        aims: bounds of the d' of the effect.
        rows: of the record, where there is one.

    Raises:
        ValueError: the structure has nothing that the kind could act on.
    """
    with threadpool_limits(1):  # BLAS sums in another order where it has more threads
        place = STRUCTURES[structure](stream(seed, "structure"))
        stated = weigh(place, stream(seed, "masses"))
        healthy = None
        if beside:
            healthy = healthy_case(seed, place, welded, rows, PLAIN)
            world, spread = healthy.world, float(healthy.facts["spread"])
            last = float(healthy.site.time[rows - 1])
            time = _even(campaign.windows, last / (campaign.windows - 1))
        else:
            spread = float(stream(seed, "spread").uniform(*_SPREADS))
            world = as_built(place, stream(seed, "as built"), welded, spread)
            time = _even(campaign.windows, _STEP)
        masses = as_weighed(stated, stream(seed, "weighed"), min(spread, 1.0))
        swinging = SwingingWorld(world, masses)
        count = MODES[place.model.get("plane") == "xz"]
        before = vibrations(swinging, count)
        drawn = SwingingWorld(FieldWorld.of(place), stated)
        hidden = None
        if kind != "null":
            size = _sizes(seed, swinging, before, healthy, welded, time)
            hidden = _hide(seed, kind, swinging, healthy, time, size, aims)
        return _case(
            seed, structure, (drawn, swinging), hidden, campaign, healthy, time,
            facts(world, welded, spread) if healthy is None else healthy.facts,
        )  # fmt: skip


def fits(kind: str, structure: str) -> bool:
    """Whether a structure has what a kind acts on."""
    place = STRUCTURES[structure](np.random.default_rng(0))
    swinging = SwingingWorld(FieldWorld.of(place), weigh(place, np.random.default_rng(0)))
    drawn = (OF_MODES | OF_GAUGES)[kind](
        swinging, _setting(swinging, None), np.random.default_rng(0)
    )
    return drawn is not None


def _even(count: int, step: float) -> Array:
    """Times a step apart, [count]."""
    return np.asarray(step * np.arange(count), dtype=np.float64)


def _setting(swinging: SwingingWorld, healthy: HealthyCase | None) -> FieldSetting:
    if healthy is not None:
        return FieldSetting(healthy.world, healthy.site.time, healthy.clean)
    sensors = len(swinging.world.structure.model["sensors"])
    return FieldSetting(swinging.world, np.arange(10.0), np.zeros((10, sensors)))


def _sizes(
    seed: int,
    swinging: SwingingWorld,
    before: Vibrations,
    healthy: HealthyCase | None,
    welded: bool,
    time: Array,
) -> Callable[[SwingingWorld, float | None], float]:
    """What gives d' of a reality that differs from an onset on: of frequencies, and of gauges.

    A window's scatter is taken as 0.3 %; what is there from the beginning is told from a model
    that misses every frequency by 1 %.
    """
    account = None
    if healthy is not None:
        account = reading_covariance(seed, swinging.world.structure, welded, healthy)

    def size(other: SwingingWorld, onset: float | None) -> float:
        moved = np.log(changed(other, before).frequencies)
        late = float(np.mean(time >= (-np.inf if onset is None else onset)))
        if onset is None:
            variance = 0.003**2 / len(time) + _MISSED**2
        else:
            variance = 0.003**2 / len(time) / (late * (1.0 - late))
        square = float(((moved - np.log(before.frequencies)) ** 2).sum()) / variance
        if healthy is not None and account is not None:
            change = observe(other.world, healthy.site) - healthy.clean
            if onset is not None:
                change[healthy.site.time < onset] = 0.0
            square += account.d_prime(change[healthy.record]) ** 2
        return float(np.sqrt(square))

    return size


def _hide(
    seed: int,
    kind: str,
    swinging: SwingingWorld,
    healthy: HealthyCase | None,
    time: Array,
    size: Callable[[SwingingWorld, float | None], float],
    aims: tuple[float, float],
) -> _Hidden:
    """Draw a place that can be seen, then the value whose d' meets a drawn aim."""
    rng = stream(seed, f"hidden {kind}")
    onset = None
    if rng.random() < _LATE:
        onset = float(time[int(rng.uniform(*_ONSETS) * len(time))])
    aim = float(np.exp(rng.uniform(*np.log(aims))))
    draw = (OF_MODES | OF_GAUGES)[kind]
    setting = _setting(swinging, healthy)

    def at(span: SwingingSpan, value: float) -> _Hidden:
        one = _Hidden(kind, span, value, onset, 0.0)
        return one._replace(d_prime=size(one.in_(swinging), onset))

    best: _Hidden | None = None
    for _ in range(_PLACES):
        span = draw(swinging, setting, rng)
        if span is None:
            raise ValueError(f"the structure has nothing that {kind!r} could act on")
        most = at(span, span.severe)
        if best is None or most.d_prime > best.d_prime:
            best = most
        if most.d_prime >= aim:
            break
    assert best is not None
    if best.d_prime <= aim:
        return best
    below, above = 0.0, 1.0
    for _ in range(_HALVINGS):
        middle = 0.5 * (below + above)
        if at(best.span, best.span.at(middle)).d_prime < aim:
            below = middle
        else:
            above = middle
    return at(best.span, float(f"{best.span.at(above):.6g}"))


def _case(
    seed: int,
    name: str,
    worlds: tuple[SwingingWorld, SwingingWorld],
    hidden: _Hidden | None,
    campaign: Campaign,
    healthy: HealthyCase | None,
    time: Array,
    built: dict[str, Any],
) -> ModalCase:
    drawn, swinging = worlds
    place: FieldStructure = swinging.world.structure
    count = MODES[place.model.get("plane") == "xz"]
    healthy_modes = vibrations(swinging, count)
    other = swinging if hidden is None else hidden.in_(swinging)
    after = changed(other, healthy_modes)
    always = hidden is not None and hidden.onset is None
    states = [after if always else healthy_modes, after]
    onset = np.inf if hidden is None or hidden.onset is None else hidden.onset
    tools = instruments(place, count, stream(seed, "instruments"))
    found = entries(campaign, states, time >= onset, time, tools, stream(seed, "campaign"))
    first = Vibrations(campaign.clock * states[0].frequencies, states[0].shapes)
    model = {**place.model, "points": tools.points}
    model["modes"] = expected(first, tools, stream(seed, "expected"))
    frequencies = {
        f"f {mode}": {"kind": "frequency", "mode": mode, "unit": "Hz"} for mode in model["modes"]
    }
    channels, rows = {}, np.zeros(0)
    if healthy is None:
        model |= {"sensors": frequencies, "effects": {}, "context": {}}
        if campaign.weather:
            model["context"] = {"air": {"unit": "degC", "range": [-30.0, 45.0]}}
    else:
        model["sensors"] = place.model["sensors"] | frequencies
        rows = healthy.site.time[healthy.record]
        channels = _record(seed, place, healthy, other, onset if hidden else np.inf, always)
    as_drawn = changed(drawn, healthy_modes).frequencies
    common = float(np.mean(np.log(campaign.clock * healthy_modes.frequencies / as_drawn)))
    truth = {
        **(
            {"kind": "null", "onset": None, "place": {}, "parameter": None, "value": None,
             "d_prime": 0.0}
            if hidden is None
            else {"kind": hidden.kind, "onset": hidden.onset, "place": hidden.span.place,
                  "parameter": hidden.span.parameter, "value": hidden.value,
                  "d_prime": hidden.d_prime}
        ),
        "end": None,
        "bridge": name,
        **built,
        "common": common,
        "broken": None,
        "beside": [],
    }  # fmt: skip
    frequency = np.full((campaign.windows, count), np.nan)
    frequency[found.window, found.mode] = found.frequency
    text = found.text(time, list(tools.points))
    return ModalCase(model, rows, channels, truth, modal=text, frequency=frequency)


def _record(
    seed: int,
    place: FieldStructure,
    healthy: HealthyCase,
    other: SwingingWorld,
    onset: float,
    always: bool,
) -> dict[str, Array]:
    """What gauges and contexts read beside the modes."""
    site, record = healthy.site, healthy.record
    late = site.time >= (-np.inf if always else onset)
    clean = np.where(late[:, None], observe(other.world, site), healthy.clean)
    shown = site.logger.logged(clean)[record]
    shown[stream(seed, "missing").random(shown.shape) < 0.002] = np.nan
    channels = dict(zip(place.model["sensors"], shown.T, strict=True))
    return channels | {key: course[record] for key, course in healthy.measured.items()}
