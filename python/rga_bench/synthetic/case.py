"""Draw a blind case and write it: model.json, record.csv, truth.json."""

from __future__ import annotations

import json
from collections.abc import Sequence
from dataclasses import dataclass
from pathlib import Path
from typing import Any

import numpy as np

from rga_bench.synthetic.bridges.catalogue import BRIDGES
from rga_bench.synthetic.bridges.model_draft import ModelDict
from rga_bench.synthetic.conditions import Conditions
from rga_bench.synthetic.gauges import measure, silenced
from rga_bench.synthetic.hidden.catalogue import DRAWN, KINDS, fits
from rga_bench.synthetic.hidden.inject import draw_placed, inhabited, readings, signature
from rga_bench.synthetic.noise import missing, stream
from rga_bench.synthetic.physics.frame import Array
from rga_bench.synthetic.physics.response import Contexts
from rga_bench.synthetic.reality import Reality, realise

_NULLS = 0.2
_USUAL = Conditions()


@dataclass(frozen=True)
class Beyond:
    """What only a judge gets to see of a case.

    Over the rows of the record and those after it, [n]: ``time``, ``contexts`` as sensors
    without noise would show them, and the channels ``clean`` [n, c] of noise, of all ``sensors``
    as a model has them. ``unseen`` [n, c] is True where the record has nothing: after its end,
    and of sensors that the case leaves out.
    ``signatures`` [n, c]: what each effect changes beside the others, and all of them together.
    """

    sensors: ModelDict
    time: Array
    contexts: Contexts
    clean: Array
    unseen: np.ndarray
    signatures: list[Array]
    together: Array


@dataclass(frozen=True)
class Case:
    """One blind case.

    ``model``: a model file; ``time`` [n] [s]; ``channels``: sensors in their units, then
    measured contexts, each [n], NaN where missing; ``truth``: what was hidden; ``beyond``: what
    the record does not show, where the conditions have it; ``mapping``: how the record is to be
    read, where that is not plain.
    """

    model: ModelDict
    time: Array
    channels: dict[str, Array]
    truth: dict[str, Any]
    beyond: Beyond | None = None
    mapping: str | None = None

    def write(self, folder: str | Path) -> None:
        """Write the files; each appears whole or not at all."""
        folder = Path(folder)
        folder.mkdir(parents=True, exist_ok=True)
        table = np.column_stack([self.time, *self.channels.values()])
        rows = [",".join("" if np.isnan(x) else f"{x:.9g}" for x in row) for row in table]
        record = "\n".join([",".join(["time", *self.channels]), *rows])
        _replace(folder / "record.csv", record + "\n")
        _replace(folder / "model.json", json.dumps(self.model, indent=1) + "\n")
        if self.mapping is not None:
            _replace(folder / "import.toml", self.mapping)
        _replace(folder / "truth.json", json.dumps(self.truth, indent=1) + "\n")


def _replace(path: Path, text: str) -> None:
    draft = path.with_name(path.name + ".part")
    draft.write_text(text, encoding="utf-8")
    draft.replace(path)


def draw_case(
    seed: int,
    *,
    bridge: str | None = None,
    kind: str | Sequence[str] | None = None,
    reality: str | None = None,
    rows: int = 300,
    conditions: Conditions = _USUAL,
    aims: tuple[float, float] | None = None,
) -> Case:
    """A case of ``rows`` samples; what is not given is drawn by ``seed``.

    Same seed, same bits. With the same bridge, reality and conditions, cases of different kinds
    share scatter, contexts and noise, so that they differ by the hidden effects alone. Several
    kinds are hidden together; ``aims`` bounds the d' of each by itself. In ``truth`` the first
    effect stands in front, and ``beside`` it the others.

    Raises:
        ValueError: an unknown name, or a kind that the bridge or the reality cannot have.
    """
    first, *others = [kind] if kind is None or isinstance(kind, str) else kind
    name, first, reality = _choose(seed, bridge, first, reality)
    kinds = [one for one in (first, *others) if one != "null"]
    place = BRIDGES[name](stream(seed, "bridge"))
    stiff = reality == "frame" and "joint_rigidity" not in kinds
    base = realise(seed, place, stiff, rows, conditions)
    placed = draw_placed(seed, kinds, base, conditions.ramps, aims)
    truth = {
        "kind": "null",
        "bridge": name,
        "onset": None,
        "end": None,
        "place": {},
        "parameter": None,
        "value": None,
        "reality": reality,
        "d_prime": 0.0,
        **base.facts,
        **(placed[0].facts if placed else {}),
        "beside": [one.facts for one in placed[1:]],
    }
    if first == "joint_rigidity":
        truth.update(joint_stiffness=placed[0].value, reality_d_prime=placed[0].d_prime)
    world = inhabited(base, placed)
    clean = readings(base, placed)
    time, shown = base.time[:rows], clean[:rows] + base.noise
    for column, (mode, row) in silenced(world, time).items():
        shown[row:, column] = 0.0 if mode == "dead" else shown[row, column]
    shown[missing(stream(seed, "missing"), *shown.shape)] = np.nan
    every = place.model["sensors"]
    sensors = {name: one for (name, one), has in zip(every.items(), base.given, strict=True) if has}
    columns = dict(zip(every, shown.T, strict=True))
    channels = {name: columns[name] for name in sensors}
    measured = measure(world, base.measured)
    channels.update({n: course[:rows] for n, course in measured.items() if n not in base.latent})
    beyond = _beyond(base, placed, clean) if conditions.later or conditions.unseen else None
    return Case({**place.model, "sensors": sensors}, time, channels, truth, beyond)


def _choose(
    seed: int, bridge: str | None, kind: str | None, reality: str | None
) -> tuple[str, str, str]:
    rng = stream(seed, "choice")
    drawn = list(BRIDGES)[int(rng.integers(len(BRIDGES)))]
    stiff = "frame" if rng.random() < 0.5 else "truss"
    null, order = rng.random() < _NULLS, rng.permutation(len(DRAWN))
    name = bridge or drawn
    if name not in BRIDGES:
        raise ValueError(f"no bridge {name!r}; there are {', '.join(BRIDGES)}")
    if kind is not None and kind not in KINDS:
        raise ValueError(f"no hidden kind {kind!r}; there are {', '.join(KINDS)}")
    if reality not in (None, "truss", "frame"):
        raise ValueError(f"reality is 'truss' or 'frame', not {reality!r}")
    model = BRIDGES[name](stream(seed, "bridge"))
    if kind is not None and not fits(kind, model):
        raise ValueError(f"the bridge {name!r} has nothing that {kind!r} could act on")
    if kind is None:
        hidden = [list(DRAWN)[int(k)] for k in order]
        usable = [k for k in hidden if fits(k, model)]
        if reality == "truss":
            usable.remove("joint_rigidity")
        kind = "null" if null else usable[0]
    if kind == "joint_rigidity":
        if reality == "truss":
            raise ValueError("joint_rigidity is a frame reality")
        return name, kind, "frame"
    return name, kind, reality or stiff


def _beyond(base: Reality, placed: Sequence[Any], clean: Array) -> Beyond:
    exact = {
        name: np.concatenate([base.measured[name][: base.rows], course[base.rows :]])
        for name, course in base.contexts.items()
    }
    exact.update({name: base.contexts[name] for name in base.latent})
    unseen = np.broadcast_to(~base.given, clean.shape).copy()
    unseen[base.rows :] = True
    together = signature(base, placed)
    return Beyond(
        sensors=base.bridge.model["sensors"],
        time=base.time,
        contexts=measure(inhabited(base, placed), exact),
        clean=clean,
        unseen=unseen,
        signatures=[
            together - signature(base, [other for other in placed if other is not one])
            for one in placed
        ],
        together=together,
    )
