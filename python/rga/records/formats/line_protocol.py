"""InfluxDB line protocol: `measurement,tag=value field=1.5,other=2 1623403945000000000`.

Source: InfluxData, InfluxDB documentation, "Line protocol".
"""

import re
from collections.abc import Sequence

import polars as pl

from rga.errors import InputError
from rga.records.formats.encoding import Text
from rga.records.formats.points import table_of_points
from rga.records.table import Table

_LINE = re.compile(
    r"(?:[^\s,=\\]|\\.)+(?:,(?:[^\s,=\\]|\\.)+=(?:[^\s,\\]|\\.)+)*"
    r" (?:[^\s,=\\]|\\.)+=\S.*"
)
_FIELD = r"-?[\d.][\d.eE+-]*[iu]?|t|T|true|True|TRUE|f|F|false|False|FALSE|\"|-?inf"
#: signs that a backslash takes their meaning, and what stands for them meanwhile
_ESCAPED = {"\\ ": "\ue000", "\\,": "\ue001", "\\=": "\ue002", '\\"': "\ue003", "\\\\": "\ue004"}
#: smallest time stamp of a precision that lies after 1973: microseconds in one
_PRECISIONS = ((1e17, 1e-3, "ns"), (1e14, 1.0, "us"), (1e11, 1e3, "ms"), (0.0, 1e6, "s"))


def is_line_protocol(lines: Sequence[str]) -> bool:
    """Whether lines are of the protocol.

    >>> is_line_protocol(["# a comment", "air,id=1 t=71.2,co=0.4 1623403945000000000"])
    True
    >>> is_line_protocol(["time,D1", "0 1,2"])
    False
    """
    held = [line.strip() for line in lines if line.strip() and line[0] != "#"][:20]
    fields = re.compile(rf" (?:[^\s,=\\]|\\.)+=(?:{_FIELD})")
    return bool(held) and all(_LINE.fullmatch(line) and fields.search(line) for line in held)


def read_line_protocol(text: Text) -> Table:
    """Read line protocol: a channel for each field of each series.

    A channel is called by the values of its tags and its field, and by the measurement as well
    where there are several.

    Raises:
        InputError: a line is not of the protocol, or has no time.
    """
    content = text.data.decode()
    for escaped, meanwhile in _ESCAPED.items():
        content = content.replace(escaped, meanwhile)
    # Texts between quotes are no readings; they may hold blanks and commas.
    content = re.sub(r'="[^"]*"', "=", content) if '"' in content else content
    lines = pl.DataFrame({"line": content.split("\n")}).with_row_index("number", 1)
    lines = lines.with_columns(pl.col("line").str.strip_chars())
    lines = lines.filter((pl.col("line") != "") & ~pl.col("line").str.starts_with("#"))
    parts = pl.col("line").str.extract_groups(
        r"^(?<series>\S+) +(?<fields>\S+)(?: +(?<stamp>-?\d+))?$"
    )
    lines = lines.with_columns(parts.alias("parts")).unnest("parts")
    for column, what, remedy in (
        (
            "series",
            "the line is not of the line protocol",
            "write 'measurement,tag=a field=1 time'",
        ),
        ("stamp", "the line has no time", "write its time stamp behind the fields"),
    ):
        if lines[column].has_nulls():
            number = lines.filter(pl.col(column).is_null())["number"][0]
            raise InputError(what, f"{text.path}, line {number}", remedy)
    stamps = lines["stamp"].cast(pl.Int64, strict=False)
    largest = float(stamps.abs().max() or 0)  # type: ignore[arg-type]
    factor, precision = next((f, name) for least, f, name in _PRECISIONS if largest >= least)
    moments = (stamps // int(1 / factor)) if factor < 1 else stamps * int(factor)
    several = lines["series"].str.split(",").list.first().n_unique() > 1
    series = {one: _called(one, several) for one in lines["series"].unique().to_list()}
    fields = lines.select(
        moments.cast(pl.Datetime("us")).dt.replace_time_zone("UTC").alias("time"),
        pl.col("series").replace_strict(series),
        pl.col("fields").str.split(","),
        "number",
    ).explode("fields")
    pairs = pl.col("fields").str.split_exact("=", 1).struct.rename_fields(["field", "value"])
    fields = fields.with_columns(pairs.alias("pair")).unnest("pair")
    if fields["value"].has_nulls():
        number = fields.filter(pl.col("value").is_null())["number"][0]
        raise InputError("a field has no value", f"{text.path}, line {number}", "write field=value")
    points = fields.select(
        "time",
        _plain(pl.col("field")).alias("field"),
        (pl.col("series") + pl.lit(" ") + _plain(pl.col("field")))
        .str.strip_chars()
        .alias("channel"),
        pl.col("value").str.replace(r"^(-?\d+)[iu]$", "$1").cast(pl.Float64, strict=False),
    )
    own = points.select("channel", "field").unique(maintain_order=True)
    names = dict(own.filter(own["field"].is_unique()).iter_rows())
    points = points.drop("field")
    notes = [*text.notes, f"times are taken as {precision} since 1970 (UTC)", "no units are stated"]
    return table_of_points(text.path, points, "InfluxDB line protocol", {}, names, notes)


def _called(series: str, several: bool) -> str:
    """What a series is called: the values of its tags."""
    measurement, *tags = series.split(",")
    parts = [measurement] if several or not tags else []
    called = " ".join([*parts, *(tag.partition("=")[2] for tag in tags)])
    return _restored(called)


def _restored(text: str) -> str:
    for escaped, meanwhile in _ESCAPED.items():
        text = text.replace(meanwhile, escaped[1])
    return text


def _plain(column: pl.Expr) -> pl.Expr:
    for escaped, meanwhile in _ESCAPED.items():
        column = column.str.replace_all(meanwhile, escaped[1], literal=True)
    return column
