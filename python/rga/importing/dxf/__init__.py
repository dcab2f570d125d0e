"""Drawings (.dxf): their lines as members."""

from rga.importing.dxf.read import read_dxf

__all__ = ["read_dxf"]
