"""The time of a record: columns that hold it, how it is written, and zones."""

from rga.records.times.clock import Clock, read_clock

__all__ = ["Clock", "read_clock"]
