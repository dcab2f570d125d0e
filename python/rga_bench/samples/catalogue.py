"""Which cases the samples are, and how they are told."""

from collections.abc import Callable
from dataclasses import dataclass
from datetime import datetime, timedelta
from typing import Any

from rga_bench.field.case import draw_field
from rga_bench.swinging import Campaign, ModalCase, draw_modal
from rga_bench.synthetic.case import Case, draw_case

ROWS = 240


@dataclass(frozen=True)
class SampleDesign:
    """A sample.

    Attributes:
        seed: of the case and of its file.
        draw: the case of a seed.
        title, what: its name, and a sentence on what it is.
        client, site, station: as they stand in the model and in the logger's preamble.
        start: the time of the first row.
    """

    seed: int
    draw: Callable[[int], Case]
    title: str
    what: str
    client: str
    site: str
    station: str
    start: datetime


def _field(structure: str, kind: str) -> Callable[[int], Case]:
    def draw(seed: int) -> Case:
        return draw_field(seed, structure=structure, kind=kind, rows=ROWS, aims=(25.0, 60.0))

    return draw


def _footbridge(seed: int) -> Case:
    return draw_case(
        seed,
        bridge="footbridge",
        kind="member_stiffness",
        reality="truss",
        rows=ROWS,
        aims=(20.0, 24.0),
    )


def _crane(seed: int) -> ModalCase:
    return draw_modal(
        seed,
        structure="jib",
        kind="member_stiffness",
        welded=False,
        campaign=Campaign(windows=48, weather=True),
        beside=False,
    )


#: how a structure differs from its model beside what is hidden: of readings, and of modes
BESIDE = """\
Beside it the structure differs from its model as every real one does: the stiffness of
its members scatters by some per cent, gauges have gains and noise with a memory, and
the sensors of temperature and loads have errors of their own. The readings were made by
a frame solver that has nothing in common with the one that diagnoses them.
"""
BESIDE_MODES = """\
Beside it the structure differs from its model as every real one does: stiffness and mass
of its members scatter by some per cent, frequencies fall in warm air and rise by more when
it freezes, and one mode in ten was not found in a window. The modes are those of a solver
that has nothing in common with the one that diagnoses them.
"""

SAMPLES = {
    "footbridge": SampleDesign(
        1,
        _footbridge,
        "Park footbridge",
        "A pony truss of 23.4 m over a stream: dial gauges, a joint, two tilts and strain gauges,\n"
        "with the air's temperature, the crowd and the snow on the deck measured beside them.",
        "Parks department",
        "Fußgängersteg Mühlbach",
        "Brückenmitte, Schaltschrank Süd",
        datetime(2024, 3, 4),
    ),
    "roof": SampleDesign(
        1,
        _field("roof", "member_stiffness"),
        "Roof of a sports hall",
        "A double-layer space truss of four by four cells on columns: deflections, two movements\n"
        "of edges and strain gauges, with the air's temperature and two fields of snow measured.",
        "City sports office",
        "Sporthalle Höhenweg, Dachtragwerk",
        "Dachraum, Achse 3",
        datetime(2024, 1, 8),
    ),
    "portal": SampleDesign(
        4,
        _field("portal", "support_flexibility"),
        "Portal frame of a warehouse",
        "A steel portal with fixed bases: deflections, tilts and strain gauges on both faces of\n"
        "columns and rafters, with the air's temperature, snow and wind measured.",
        "Harbour logistics",
        "Lagerhalle 7, Rahmen Achse 12",
        "Traufe West",
        datetime(2024, 1, 15),
    ),
    "mast": SampleDesign(
        1,
        _field("mast", "member_stiffness"),
        "Antenna mast",
        "A square lattice mast: movements and tilts along its height, strain gauges on legs and\n"
        "diagonals, with the air's temperature and the wind from two sides measured.",
        "Broadcasting network",
        "Sendemast Großer Stein",
        "Container am Mastfuß",
        datetime(2024, 2, 5),
    ),
    "crane": SampleDesign(
        3,
        _crane,
        "Jib crane of a boatyard",
        "A pillar with a boom of three chords that hangs from its head by two ties: natural\n"
        "frequencies and mode shapes of twelve days, with the air's temperature beside them.",
        "Boatyard",
        "Werftkran Nord",
        "Kranfuß",
        datetime(2024, 1, 22),
    ),
}


def answer(case: Case, start: datetime) -> str:
    """What was hidden in a case, in words."""
    truth = case.truth
    told = _told(truth["kind"], truth["place"], truth["value"])
    since = "all the time"
    if truth["onset"] is not None:
        moment = start + timedelta(seconds=float(truth["onset"]))
        since = f"from {moment:%d.%m.%Y %H:%M} on"
    return (
        f"What was hidden: {told}, {since}.\n\n"
        "As an effect of the model format:\n"
        f"  kind = {truth['kind']!r}, "
        + ", ".join(f"{key} = {value!r}" for key, value in truth["place"].items())
        + f", {truth['parameter']} = {truth['value']:.3g}\n\n"
        + (BESIDE_MODES if isinstance(case, ModalCase) else BESIDE)
    )


def _told(kind: str, place: dict[str, Any], value: float) -> str:
    if kind == "member_stiffness":
        where = f"group {place['group']!r}" if "group" in place else f"member {place['member']!r}"
        return f"{where} has {100 * value:.0f} % of the stiffness that the model gives it"
    if kind == "support_flexibility":
        return (
            f"support {place['support']!r} yields in {place['dof']}, by a spring of "
            f"{value / 1e6:.3g} MN/m where the model holds it"
        )
    raise ValueError(f"there are no words for {kind!r}")
