"""OpenSees scripts, in Tcl and in Python, read without running them."""

from rga.importing.opensees.read import read_opensees

__all__ = ["read_opensees"]
