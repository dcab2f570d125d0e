"""The part of Tcl that builds models, evaluated without ever touching a file or a program."""

from rga.importing.opensees.tcl.interpreter import TclInterpreter

__all__ = ["TclInterpreter"]
