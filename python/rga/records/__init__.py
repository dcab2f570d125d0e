"""Records: reading a logger's file into the channels and contexts of a model."""

from typing import TYPE_CHECKING

from rga.lazy import listing, opening

if TYPE_CHECKING:
    from rga.records.contexts import ContextTable, load_contexts
    from rga.records.frames import RecordSource
    from rga.records.load import load_record
    from rga.records.mapping import RecordMapping, read_mapping
    from rga.records.record import Record
    from rga.records.schema import record_schema

__all__ = [
    "ContextTable",
    "Record",
    "RecordMapping",
    "RecordSource",
    "load_contexts",
    "load_record",
    "read_mapping",
    "record_schema",
]

# They are opened on first use, so that a record is known without all readers of files.
_HOMES = {
    "ContextTable": "rga.records.contexts",
    "Record": "rga.records.record",
    "RecordMapping": "rga.records.mapping",
    "RecordSource": "rga.records.frames",
    "load_contexts": "rga.records.contexts",
    "load_record": "rga.records.load",
    "read_mapping": "rga.records.mapping",
    "record_schema": "rga.records.schema",
}
__getattr__ = opening(__name__, _HOMES)
__dir__ = listing(__name__, __all__)
