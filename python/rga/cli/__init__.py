"""The command line: `rga`."""

from rga.cli.app import main

__all__ = ["main"]
