"""Sound records, in which channels are then broken."""

import json
import tempfile
from collections.abc import Callable
from dataclasses import dataclass
from pathlib import Path
from typing import Any

from rga.errors import InputError
from rga.model import Model, load_model
from rga.records import Record, load_record
from rga_bench.field import STRUCTURES, Options, draw_field, fits
from rga_bench.synthetic import BRIDGES, Case, Conditions, draw_case

#: what is hidden in every other drawn record, in turn: plain, and each of another family
HIDDEN = (
    "member_stiffness",
    "support_spring",
    "load_scale",
    "support_settlement",
    "thermal_gradient",
)
#: bounds of the d' of what is hidden: plain without any one channel
AIMS = (25.0, 45.0)
MODEL, RECORD, TRUTH = "model.json", "record.csv", "truth.json"
#: folder of practice cases, and folder and file of a measured crossing, among foreign data
PRACTICE, CROSSING = "practice", Path("rdso45m") / "record_40kmh.txt"


@dataclass(frozen=True)
class Base:
    """A sound record.

    Attributes:
        name: where it comes from, and its number there.
        rows: of a record that is drawn.
        data: folder of foreign data, for a record of these.
        model: of a measured crossing.
    """

    name: str
    rows: int
    data: Path | None = None
    model: Path | None = None


@dataclass(frozen=True)
class Sound:
    """A sound record as it is diagnosed.

    Attributes:
        hidden: kind and place of what is known to be hidden in it.
    """

    model: Model
    record: Record
    hidden: list[dict[str, Any]]


def foreign(data: Path, model: Path | None, rows: int) -> list[Base]:
    """The sound records of a folder of foreign data.

    Args:
        data: may hold `practice/NN` and `rdso45m/record_40kmh.txt`.
        model: of the crossing; None: it is left out.
        rows: is passed on.

    Raises:
        InputError: it holds neither.
    """
    cases = sorted(path.parent.name for path in (data / PRACTICE).glob(f"*/{MODEL}"))
    several = [Base(f"{PRACTICE}/{name}", rows, data) for name in cases]
    if model is not None and (data / CROSSING).is_file():
        # What was measured takes turns with what was made.
        crossing = Base(CROSSING.parent.name, rows, data, model)
        several = [one for case in several for one in (crossing, case)] or [crossing]
    if not several:
        remedy = f"give a folder with {PRACTICE}/NN/{MODEL} or {CROSSING}"
        raise InputError("there are no records here", str(data), remedy)
    return several


def load(base: Base, seed: int) -> Sound:
    """The record itself; `seed` is that of what is drawn."""
    if base.data is None:
        source, number = base.name.split("-")
        return GENERATORS[source](seed, int(number), base.rows)
    if base.model is not None:
        model = load_model(base.model)
        return Sound(model, load_record(base.data / CROSSING, model), [])
    return _read(base.data / base.name)


def _drawn(seed: int, number: int, rows: int) -> Sound:
    """A record of the first generator; every other one has nothing hidden."""
    bridges = list(BRIDGES)
    kind = "null" if number % 2 == 0 else HIDDEN[number // 2 % len(HIDDEN)]
    bridge = bridges[number % len(bridges)]
    if kind == "thermal_gradient" and bridge == "footbridge":
        bridge = "pratt"  # two chords apart, whose displacements show a gradient
    case = draw_case(
        1000 * seed + number,
        bridge=bridge,
        kind=kind,
        reality="truss",
        rows=rows,
        conditions=Conditions(scatter=0.015),
        aims=AIMS,
    )
    return _written(case)


def _of_the_field(seed: int, number: int, rows: int) -> Sound:
    """A record of the second generator: pinned and welded, untared and tared in turn."""
    structure = list(STRUCTURES)[number % len(STRUCTURES)]
    usable = [kind for kind in HIDDEN if fits(kind, structure)]
    kind = "null" if number % 2 == 0 else usable[number // 2 % len(usable)]
    case = draw_field(
        1000 * seed + number,
        structure=structure,
        kind=kind,
        welded=number % 4 >= 2,
        rows=rows,
        options=Options(tared=number % 3 == 2, gaps=number % 7 == 3),
        aims=AIMS,
    )
    return _written(case)


def _written(case: Case) -> Sound:
    with tempfile.TemporaryDirectory() as folder:
        case.write(folder)
        return _read(Path(folder))


#: generators of records, by the beginning of their names
GENERATORS: dict[str, Callable[[int, int, int], Sound]] = {
    "drawn": _drawn,
    "field": _of_the_field,
}


def _read(folder: Path) -> Sound:
    model = load_model(folder / MODEL)
    record = load_record(folder / RECORD, model)
    truth = json.loads((folder / TRUTH).read_text(encoding="utf-8"))
    facts = [truth, *truth.get("beside", [])]
    hidden = [{"kind": one["kind"], "place": one["place"]} for one in facts if one.get("place")]
    return Sound(model, record, hidden)
