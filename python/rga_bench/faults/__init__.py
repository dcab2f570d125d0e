"""Channels as loggers break them: a library of faults, and what a diagnosis makes of each."""

from rga_bench.faults.library import FAULTS, ChannelFault, Scale

__all__ = ["FAULTS", "ChannelFault", "Scale"]
