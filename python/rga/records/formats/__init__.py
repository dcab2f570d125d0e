"""Formats in which loggers write, one a file; each gives the common raw table."""

from collections.abc import Collection
from pathlib import Path

from rga.records.formats.catman_binary import is_catman, read_catman_binary
from rga.records.formats.catman_text import catman_names, read_catman_text
from rga.records.formats.encoding import Text, decoded
from rga.records.formats.labview import MARK as LABVIEW
from rga.records.formats.labview import read_labview
from rga.records.formats.line_protocol import is_line_protocol, read_line_protocol
from rga.records.formats.matlab import is_matlab, read_matlab
from rga.records.formats.mts import MARK as MTS
from rga.records.formats.mts import read_mts
from rga.records.formats.observations import is_json, read_observations
from rga.records.formats.parquet import is_parquet, read_parquet
from rga.records.formats.plain import read_plain
from rga.records.formats.tdms import MARK as TDMS
from rga.records.formats.tdms import read_tdms
from rga.records.formats.toa5 import is_toa5, read_toa5
from rga.records.formats.universal.datasets import is_universal
from rga.records.formats.universal.histories import read_histories
from rga.records.mapping import FileMapping
from rga.records.table import Table

__all__ = ["read_format"]
#: bytes at the head of a text by which its format is known
_HEAD = 1 << 16


def read_format(
    data: bytes, path: Path, mapping: FileMapping, known: Collection[str] = ()
) -> Table:
    """The table of a file, whose format is known by its first bytes or lines.

    Args:
        data: what is in the file.
        path: the file.
        mapping: what is stated of it.
        known: names that columns may have.

    Raises:
        InputError: it is damaged, or of no format that is known.
    """
    if is_parquet(data, path):
        return read_parquet(data, path)
    if data.startswith(TDMS):
        return read_tdms(data, path, mapping)
    if is_matlab(data, path):
        return read_matlab(data, path, mapping)
    if is_catman(data):
        return read_catman_binary(data, path, mapping)
    if is_universal(data, path):
        return read_histories(path, mapping)
    return _read_text(decoded(data, path, mapping.encoding), mapping, known)


def _read_text(text: Text, mapping: FileMapping, known: Collection[str]) -> Table:
    lines = text.lines(_HEAD) or [""]
    # Where names and rows are stated to stand, that is how the file is read.
    if mapping.header_line is None and mapping.data_line is None:
        if is_toa5(lines[0]):
            return read_toa5(text, mapping)
        if lines[0].startswith(LABVIEW):
            return read_labview(text, mapping)
        if lines[0].startswith(MTS):
            return read_mts(text, mapping)
        if (names := catman_names(lines)) is not None:
            return read_catman_text(text, names, mapping)
        if is_json(text):
            return read_observations(text)
        if is_line_protocol(lines):
            return read_line_protocol(text)
    return read_plain(text, mapping, known)
