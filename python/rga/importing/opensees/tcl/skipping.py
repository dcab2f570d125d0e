"""Parts of a script that cannot be decided: passed over where they shape nothing."""

from collections.abc import Iterator
from typing import Any

from rga.errors import InputError
from rga.importing.opensees.tcl.interpreter import TclInterpreter, TclText
from rga.importing.opensees.tcl.words import TclCommand, commands
from rga.importing.scripts.values import Unknown

#: commands that set the variable which their first word names
SETTING = frozenset(("set", "incr", "append", "lappend", "gets", "catch", "scan", "regexp"))


def skip(tcl: TclInterpreter, bodies: list[Any], why: Unknown, where: str) -> Any:
    """Pass over scripts that may or may not be evaluated; what they set is then not known.

    Raises:
        InputError: one of them would change the model.
    """
    for body in bodies:
        for name, command in _within(tcl, body, set()):
            if tcl.host.shapes(name):
                raise InputError(
                    f"whether {name!r} is done cannot be known: it hangs on {why.reason}",
                    tcl.where(command.line, getattr(body, "file", tcl.main)),
                    "write out which is meant",
                )
            if name in SETTING and len(command.words) > 1 and len(command.words[1].parts) == 1:
                tcl.variables.set(command.words[1].parts[0].text, why)
    return Unknown(why.reason)


def _within(tcl: TclInterpreter, body: Any, seen: set[str]) -> Iterator[tuple[str, TclCommand]]:
    """Commands in a script by name, with those in its own scripts and procedures."""
    try:
        line, file = (body.line, body.file) if isinstance(body, TclText) else (1, tcl.main)
        found = commands(str(body), line, file)
    except InputError:
        return  # no script, but a list or an expression
    for command in found:
        first = command.words[0].parts
        name = first[0].text if len(first) == 1 and first[0].kind == "text" else ""
        yield name, command
        for word in command.words:
            for part in word.parts:
                if word.braced or part.kind == "script":
                    inner = TclText(part.text)
                    inner.line, inner.file = part.line, file
                    yield from _within(tcl, inner, seen)
        if name in tcl.procedures and name not in seen:
            seen.add(name)
            yield from _within(tcl, tcl.procedures[name].body, seen)
