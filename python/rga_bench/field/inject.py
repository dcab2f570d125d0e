"""Effects put into a reality: where, how large, and what the channels show of them."""

from __future__ import annotations

from collections.abc import Sequence
from typing import Any, NamedTuple

import numpy as np

from rga_bench.field.channels import observe
from rga_bench.field.effect_size import ReadingCovariance
from rga_bench.field.healthy_case import HealthyCase, Options, tare_rows
from rga_bench.field.hidden import KINDS, FieldSetting, FieldSpan
from rga_bench.field.solver import Array
from rga_bench.synthetic.noise import stream

#: rows where an effect begins late, as a share of the record
ONSETS = (0.25, 0.7)
_PLACES, _HALVINGS = 8, 9


class FieldEffect(NamedTuple):
    """An effect in a case; ``onset`` [s], None: always."""

    kind: str
    span: FieldSpan
    value: float
    onset: float | None
    d_prime: float = 0.0

    @property
    def facts(self) -> dict[str, Any]:
        """What a truth file says of it."""
        known = bool(self.span.parameter)
        return {
            "kind": self.kind,
            "onset": self.onset,
            "end": None,
            "place": self.span.place,
            "parameter": self.span.parameter or None,
            "value": self.value if known else None,
            "amount": self.value,
            "d_prime": self.d_prime,
        }


def hide(
    seed: int,
    kind: str,
    healthy: HealthyCase,
    account: ReadingCovariance,
    options: Options,
    aims: tuple[float, float],
) -> FieldEffect:
    """Draw a place that can be seen, then the value whose d' meets a drawn aim."""
    rng = stream(seed, f"hidden {kind}")
    how = KINDS[kind]
    time = healthy.site.time
    late = rng.random() < how.late or (options.tared and how.needs_onset)
    row = healthy.record[int(rng.uniform(*ONSETS) * len(healthy.record))]
    onset = float(time[row]) if late else None
    aim = float(np.exp(rng.uniform(*np.log(aims))))
    setting = FieldSetting(healthy.world, time, healthy.clean)

    def size(span: FieldSpan, value: float) -> float:
        one = FieldEffect(kind, span, value, onset)
        change = readings(healthy, [one]) - healthy.clean
        if options.tared:
            change = change - change[tare_rows(seed, healthy)].mean(axis=0)
        return account.d_prime(change[healthy.record])

    best: tuple[float, FieldSpan] | None = None
    for _ in range(_PLACES):
        span = how.draw(setting, rng)
        if span is None:
            raise ValueError(f"the structure has nothing that {kind!r} could act on")
        most = size(span, span.severe)
        if best is None or most > best[0]:
            best = most, span
        if most >= aim:
            break
    assert best is not None
    most, span = best
    if span.mild == span.severe or most <= aim:
        return FieldEffect(kind, span, span.severe, onset, most)
    below, above = 0.0, 1.0
    for _ in range(_HALVINGS):
        middle = 0.5 * (below + above)
        if size(span, span.at(middle)) < aim:
            below = middle
        else:
            above = middle
    value = float(f"{span.at(above):.6g}")
    return FieldEffect(kind, span, value, onset, size(span, value))


def readings(healthy: HealthyCase, hidden: Sequence[FieldEffect]) -> Array:
    """The channels without noise with effects, [n, c]."""
    time = healthy.site.time
    begun = np.array([-np.inf if one.onset is None else one.onset for one in hidden])
    on = time[:, None] >= begun
    out = healthy.clean.copy()
    for state in np.unique(on, axis=0):
        world = healthy.world.copy()
        for one, there in zip(hidden, state, strict=True):
            if there:
                one.span.act(world, one.value, one.onset)
        if state.any():
            rows = (on == state).all(axis=1)
            out[rows] = observe(world, healthy.site)[rows]
    return out
