"""What takes the OpenSees commands of a Python script."""

from collections.abc import Iterator
from pathlib import Path
from typing import Any

import numpy as np

from rga.importing.opensees.command_names import NOT_DONE, PASSED_OVER
from rga.importing.opensees.commands import DEFINING
from rga.importing.opensees.host import OpenSeesHost
from rga.importing.reading import read_text
from rga.importing.scripts.python import Host, Opened, PythonInterpreter
from rga.importing.scripts.python.opened import Anything
from rga.importing.scripts.values import Unknown

#: modules whose names are commands of OpenSees
MODULES = (
    "openseespy.opensees", "opensees.openseespy", "opensees", "openseespy", "xara", "opensees.tcl",
    "openseespy.opensees.opensees",
)  # fmt: skip
#: modules of OpenSeesPy that show a model
SHOWING = (
    "openseespy.postprocessing", "openseespy.postprocessing.Get_Rendering",
    "openseespy.postprocessing.ops_vis", "openseespy.postprocessing.internal_plotting_functions",
)  # fmt: skip
#: words by which an object of a model is made
MAKING = ("Model", "BasicBuilder")


class PythonHost(OpenSeesHost):
    """Takes commands as functions of a module, or of an object made by `Model`."""

    def shapes(self, name: str) -> bool:
        return super().shapes(name) or name in MAKING


class Commands(Opened):
    """A module, or a model as an object: its names are commands."""

    trust = "model"

    def __init__(self, host: PythonHost) -> None:
        self.host = host

    def attribute(self, name: str) -> Any:
        known = name in DEFINING or name in PASSED_OVER or name in ("wipe", "model", *MAKING)
        if name in ("opensees", "openseespy"):
            return self
        return One(self, name) if known else Other(self, name)


class One(Opened):
    """One command."""

    trust = "model"

    def __init__(self, owner: Commands, name: str) -> None:
        self.owner, self.name = owner, name

    def attribute(self, name: str) -> Any:
        return Anything(f"{self.name}.{name}", "model")

    def call(self, values: list[Any], named: dict[str, Any], where: str) -> Any:
        host = self.owner.host
        if host.skips(self.name) and self.name not in NOT_DONE:
            return host.pass_over(self.name, self.name, where)
        known, result = host.take(self.name, list(_flat(values)), where, named)
        if not known:
            return host.pass_over(self.name, self.name, where)
        return self.owner if self.name in MAKING else result


class Other(Anything):
    """A name of the module that may be anything: when it is called it is not passed over."""

    def __init__(self, owner: Commands, name: str) -> None:
        super().__init__(name, "model")
        self.owner = owner

    def call(self, values: list[Any], named: dict[str, Any], where: str) -> Any:
        return self.owner.host.pass_over(self.name, self.name, where)


def _flat(values: list[Any]) -> Iterator[Any]:
    """Arguments one by one, those in lists and tuples too."""
    for value in values:
        if isinstance(value, list | tuple):
            yield from _flat(list(value))
        elif isinstance(value, np.ndarray):
            yield from value.ravel().tolist()
        elif isinstance(value, np.generic):
            yield value.item()
        elif isinstance(value, Opened):
            yield Unknown("something of a library")
        elif isinstance(value, bool):
            yield int(value)
        else:
            yield value


def read_python(path: Path, host: PythonHost) -> list[tuple[str, str]]:
    """Evaluate a Python script, and take what it defines.

    Returns:
        What was taken for granted: words and place.

    Raises:
        InputError: it cannot be read.
    """
    commands = Commands(host)
    modules: dict[str, Opened] = dict.fromkeys(MODULES, commands)
    for name in SHOWING:
        modules[name] = Anything(name, "shows")
    known = Host(
        host.shapes, host.skips, lambda: any(one.elements for one in host.models),
        shared=True, without=host.without,
    )  # fmt: skip
    interpreter = PythonInterpreter(path.name, modules, known)
    try:
        interpreter.run(read_text(path))
    finally:
        host.unfollowed += interpreter.refusals
    return interpreter.assumed
