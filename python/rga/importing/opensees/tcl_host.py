"""What takes the OpenSees commands of a Tcl script."""

from pathlib import Path
from typing import Any

from rga.importing.opensees.host import OpenSeesHost
from rga.importing.opensees.tcl import TclInterpreter
from rga.importing.opensees.tcl.interpreter import LeavingTcl, TclText
from rga.importing.reading import read_text


class TclHost(OpenSeesHost):
    """Evaluates the loads in braces behind a `pattern`."""

    interpreter: TclInterpreter

    def take(
        self, name: str, values: list[Any], where: str, named: dict[str, Any] | None = None
    ) -> tuple[bool, Any]:
        if name != "pattern" or not values or not isinstance(values[-1], TclText):
            return super().take(name, values, where, named)
        known = super().take(name, values[:-1], where)
        self.interpreter.run_body(values[-1], where)
        return known


def read_tcl(path: Path, host: TclHost) -> None:
    """Evaluate a Tcl script, and take what it defines.

    Raises:
        InputError: it cannot be read.
    """
    interpreter = TclInterpreter(host, path.parent, host.without)
    host.interpreter, interpreter.main = interpreter, path.name
    try:
        interpreter.run(read_text(path), 1, path.name)
    except LeavingTcl:
        return  # the script ends here: `return` or `exit`
