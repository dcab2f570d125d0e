"""`rga modes`: natural frequencies and mode shapes."""

from math import isnan
from pathlib import Path
from typing import TYPE_CHECKING, Annotated

import typer

from rga.cli.options import GivenContexts, JsonTarget, ModelFile, settings, whole

if TYPE_CHECKING:
    from polars import DataFrame

    from rga.arrays import FloatArray
    from rga.records.modal.record import ModalRecord
    from rga.simulation import ModalSimulator
    from rga.simulation.modal.pairing import Pairing
    from rga.simulation.modal.windows import NamedModes

Count = Annotated[
    int,
    typer.Option("--count", metavar="N", parser=whole(), help="How many modes: 1 to 1000."),
]
Modal = Annotated[
    Path | None,
    typer.Argument(
        metavar="[MODAL]", help="Modes found in windows of time: which of those expected they are."
    ),
]
Shapes = Annotated[
    Path | None,
    typer.Option(
        "--output", "-o", metavar="FILE", help="Write the shapes of all nodes (CSV or Parquet)."
    ),
]


def pairing_words(
    simulator: "ModalSimulator", pairing: "Pairing", frequencies: "FloatArray"
) -> str:
    """Which computed mode each expected one is, a line each."""
    from rga.simulation.modal.looks import unclear_looks

    lines = ["expected   near [Hz]   computed     f [Hz]   off [%]    MAC"]
    for (name, one), at, alike in zip(
        simulator.expected.items(), pairing.computed, pairing.mac, strict=True
    ):
        if at < 0:
            lines.append(f"{name:<10} {one.near:9.4f}   none is left for it")
            continue
        off = 100 * (frequencies[at] / one.near - 1)
        mac = "by frequency only" if isnan(alike[at]) else f"{alike[at]:6.3f}"
        lines.append(
            f"{name:<10} {one.near:9.4f}   {at + 1:8} {frequencies[at]:10.4f}  {off:+8.2f} {mac}"
        )
    if pairing.others:
        doubtful = [
            name
            for number, name in enumerate(simulator.expected)
            if any(other[number] != pairing.computed[number] for other, _ in pairing.others)
        ]
        lines.append(f"Another pairing is nearly as probable for {', '.join(doubtful)}.")
    lines += [f"{words[0].upper()}{words[1:]}." for words in unclear_looks(simulator.expected)]
    return "\n".join(lines)


def measured_words(measured: "DataFrame", named: "NamedModes", record: "ModalRecord") -> str:
    """Which modes of a record are which, and how often each was found."""
    from rga.quantities import counted
    from rga.simulation.modal.windows import NONE

    lines = ["measured   near [Hz]   found [%]     f [Hz]   scatter [%]    MAC"]
    for line in measured.iter_rows(named=True):
        shown = f"{line['mode']:<10} {line['near']:9.4f}   {100 * line['found']:9.1f}"
        if line["f"] is not None:
            shown += f" {line['f']:10.4f}"
            shown += " " * 14 if line["scatter"] is None else f"   {line['scatter']:11.3f}"
            shown += "  by frequency only" if line["MAC"] is None else f" {line['MAC']:6.3f}"
        lines.append(shown)
    none = int((named.mode == NONE).sum())
    windows, found = counted(len(named.time), "window"), counted(len(record), "mode")
    doubtful = counted(len(named.doubtful), "window")
    lines.append(
        f"{windows}, {found} found in them, {none} of which are none of those expected; in "
        f"{doubtful} another pairing is nearly as probable."
    )
    if record.repeated:
        entry = "entry stands" if record.repeated == 1 else "entries stand"
        lines.append(f"{record.repeated} {entry} in it more than once: each counts once.")
    if record.left_out:
        lines.append(f"Columns that are not used: {', '.join(record.left_out)}.")
    return "\n".join(lines)


def modes(
    model: ModelFile,
    record: Modal = None,
    count: Count = 10,
    contexts: GivenContexts = None,
    output: Shapes = None,
    json: JsonTarget = None,
) -> None:
    """Print the lowest natural frequencies, and what moves in each mode.

    The structure is that of the contexts given; without time all effects act.
    """
    from rga.cli.output import write_json
    from rga.model import load_model
    from rga.model.mass_budget import mass_budget
    from rga.records.modal.read import load_modal_record
    from rga.simulation import ModalSimulator
    from rga.simulation import modes as modes_of
    from rga.simulation.modal.units import check_units
    from rga.simulation.modal.windows import named_modes, summary

    structure, given = load_model(model), settings(contexts, "--contexts")
    found = modes_of(structure, count, given)
    simulator = ModalSimulator(structure) if structure.modes or record is not None else None
    words, content = [], found.content()
    content["mass_by_part"] = [
        {"of": one.of, "members": one.members, "beside": one.beside}
        for one in mass_budget(structure)
    ]
    if simulator is not None:
        words.append(pairing_words(simulator, *simulator.pair(given)[:2]))
    if simulator is not None and record is not None:
        read = load_modal_record(record, structure)
        named = named_modes(read, structure, simulator.expected)
        check_units(named, read, simulator.expected, structure)
        measured = summary(named, read, simulator.expected)
        words.append(measured_words(measured, named, read))
        content |= {"record": {"sha256": read.sha256}, "measured": measured.to_dicts()}
    if json is not None:
        write_json(content, json)
    if output is not None:
        found.write(output)
    if json == "-":
        return
    typer.echo("mode     f [Hz]   mass along x, y, z [%]   moves most")
    for line in found.to_frame().iter_rows(named=True):
        shares = " ".join(f"{100 * line[f'mass {axis}']:7.2f}" for axis in "xyz")
        most = f"{line['most at']} along {line['most along']}" if line["most at"] else "no node"
        typer.echo(f"{line['mode']:4} {line['f']:10.4f}   {shares}   {most}")
    tons = ", ".join(f"{mass / 1000:.4g}" for mass in found.mass)
    for one in words:
        typer.echo(one)
    typer.echo(f"Mass that moves along x, y, z: {tons} t, that of held nodes included.")
    typer.echo(f"{'mass of':32} {'members [t]':>12} {'beside [t]':>12}")
    for part in mass_budget(structure):
        typer.echo(f"{part.of:32} {part.members / 1000:12.4g} {part.beside / 1000:12.4g}")
