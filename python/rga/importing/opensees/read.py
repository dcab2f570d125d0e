"""Reads an OpenSees script, in Tcl or in Python, into a draft of a model."""

from collections.abc import Callable
from pathlib import Path

from rga.errors import InputError
from rga.importing.draft import ModelDraft
from rga.importing.opensees.build import ELASTIC, build
from rga.importing.opensees.host import OpenSeesHost
from rga.importing.opensees.script_model import ScriptModel
from rga.importing.opensees.tcl_host import TclHost, read_tcl
from rga.importing.options import Chosen
from rga.importing.units import SI, Units

UNITS_REMEDY = 'give them, as --units "kip, in" or --units "kN, m"'


def read_opensees(
    path: Path,
    chosen: Chosen,
) -> ModelDraft:
    """A draft of the first model of a script that has members.

    Args:
        path: the script.
        chosen: its units, which are asked for; the axis of a model in space that points up, which
            is z where nothing is said; files that it reads and that are not needed.

    Raises:
        InputError: it cannot be read.
    """
    host: OpenSeesHost
    assumed: list[tuple[str, str]] = []
    if path.suffix.lower() == ".tcl":
        tcl = host = TclHost(chosen.without)
        fault = _fault(lambda: read_tcl(path, tcl))
    else:
        from rga.importing.opensees.python_host import PythonHost, read_python

        python = host = PythonHost(chosen.without)
        fault = _fault(lambda: assumed.extend(read_python(path, python)))
    units = chosen.system
    script = next((one for one in host.models if one.elements or one.refusals), None)
    if fault is not None and (script is None or script is host.current):
        raise fault
    if script is None:
        raise InputError("the script defines no element", str(path), "give one that builds a model")
    plane = script.dimensions == 2
    draft = ModelDraft(
        path.stem, chosen.accept, "y" if plane else chosen.up or "z", "xz" if plane else None
    )
    _say_units(draft, units, path)
    build(script, units or SI, draft)
    _say_axes(draft, plane, chosen.up)
    for words, where in assumed:
        draft.notes.say("assumed", where, words)
    _say_others(draft, host, script, fault)
    return draft


def _fault(read: Callable[[], None]) -> InputError | None:
    """The error that ended the reading, if one did."""
    try:
        read()
    except InputError as error:
        return error
    return None


def _say_units(draft: ModelDraft, units: Units | None, path: Path) -> None:
    if units is None:
        draft.notes.say(
            "question", path.name, "an OpenSees script never states its units", UNITS_REMEDY
        )


def _say_axes(draft: ModelDraft, plane: bool, up: str | None) -> None:
    if plane:
        said = "the plane x, y of the script is the plane x, z of the model, whose z points up"
    elif up == "y":
        said = "(x, y, z) of the script is (x, -z, y) of the model, whose z points up"
    else:
        said = "the axes are the script's; where its y points up, say so (--up y)"
    draft.notes.say("assumed", "axes", said)


def _say_others(
    draft: ModelDraft, host: OpenSeesHost, chosen: ScriptModel, fault: InputError | None
) -> None:
    """What is said of the rest of the script."""
    for words, where in host.unread:
        draft.notes.refuse(
            where,
            f"this reader does not know the command {words!r}",
            "take it out where it does not shape the model",
            "partial",
        )
    for words, where in host.unfollowed:
        draft.notes.refuse(
            where, words, "write out what it does, or take it out where it changes nothing",
            "partial",
        )  # fmt: skip
    for words, where in host.not_done:
        draft.notes.say("dropped", where, f"not done, only read: {words}")
    names = ", ".join(host.passed)
    for where in sorted({where for places in host.passed.values() for where in places}, key=_line):
        draft.notes.say("dropped", where, f"analysis and output, which no model needs: {names}")
    elements = chosen.elements.values()
    used: set[str | None] = {tag for one in elements for tag, _ in one.materials}
    used_sections = {one.section for one in elements}
    for what, table, needed, kinds in (
        ("material", chosen.materials, used, ("Elastic",)),
        ("section", chosen.sections, used_sections, ELASTIC),
    ):
        for tag, defined in table.items():
            if tag not in needed and defined.kind not in kinds:
                draft.notes.say(
                    "dropped",
                    defined.where,
                    f"{what} {tag} ({defined.kind}), which no element uses",
                )
    for other in host.models:
        if other is not chosen:
            _say_other_model(draft, host, chosen, other)
    if fault is not None:
        draft.notes.say("dropped", fault.where, f"the rest of the script: {fault.what}")


def _line(where: str) -> int:
    number = where.rpartition(" ")[2]
    return int(number) if number.isdigit() else 0


def _say_other_model(
    draft: ModelDraft, host: OpenSeesHost, chosen: ScriptModel, other: ScriptModel
) -> None:
    order = "follows" if host.models.index(other) > host.models.index(chosen) else "comes before"
    draft.notes.say("dropped", other.where, f"another model {order}, which is not read")
    for table, kinds in ((other.materials, ("Elastic",)), (other.sections, ELASTIC)):
        for tag, defined in table.items():
            if defined.kind not in kinds:
                draft.notes.say(
                    "dropped",
                    defined.where,
                    f"of another model: {defined.kind} {tag} is not linear",
                )
    for tag, defined in other.series.items():
        if defined.kind not in ("Linear", "Constant"):
            draft.notes.say(
                "dropped", defined.where, f"of another model: series {defined.kind} {tag}"
            )
    for tag, defined in other.transformations.items():
        if defined.kind != "Linear":
            draft.notes.say(
                "dropped",
                defined.where,
                f"of another model: {defined.kind} {tag} is of second order",
            )
