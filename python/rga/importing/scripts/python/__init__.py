"""The part of Python that builds models, evaluated from its syntax tree; nothing is imported."""

from rga.importing.scripts.python.caution import Host
from rga.importing.scripts.python.interpreter import PythonInterpreter
from rga.importing.scripts.python.opened import Opened

__all__ = ["Host", "Opened", "PythonInterpreter"]
