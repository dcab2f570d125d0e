"""Records: reading a logger's file into the channels and contexts of a model."""

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
