"""Models of PyNite: objects, and scripts that make one."""

from rga.importing.pynite.read import is_pynite, read_pynite
from rga.importing.pynite.script import read_pynite_script, says_pynite

__all__ = ["is_pynite", "read_pynite", "read_pynite_script", "says_pynite"]
