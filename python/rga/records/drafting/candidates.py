"""Lines for the columns of a file of which none is like a channel."""

from collections.abc import Sequence

import numpy as np

from rga.model import Model
from rga.records.drafting.doubts import readable
from rga.records.drafting.matching import fits
from rga.records.drafting.toml import key, text
from rga.records.table import Table

#: channels that a line names beside the first
MOST_NAMED = 4


def candidate_lines(
    table: Table, columns: Sequence[str], lacking: Sequence[str], model: Model
) -> list[str]:
    """A remark for each column that would make it a channel, with its unit and its range.

    The channels that lack a column and may be measured in its unit stand in their order.

    Args:
        columns: of the table, that may be channels.
        lacking: channels without a column.
    """
    given: list[str] = []
    lines = []
    for column in columns:
        values = readable(table, column)
        if values is None or np.isnan(values).all():
            continue
        unit = table.units.get(column)
        likely = [name for name in lacking if fits(unit, name, model)]
        first = next((name for name in likely if name not in given), None)
        span = f"from {np.nanmin(values):g} to {np.nanmax(values):g} {unit or '(no unit)'}"
        if first is None:
            lines.append(f"# NAME = {{ column = {text(column)} }}  # {span}")
            continue
        given.append(first)
        others = [name for name in likely if name != first]
        more = " ..." if len(others) > MOST_NAMED else ""
        said = f"; or {', '.join(others[:MOST_NAMED])}{more}" if others else ""
        parts = f"column = {text(column)}"
        if unit is None:
            sensor = model.sensors.get(first)
            parts += f", unit = {text(sensor.unit if sensor else model.context[first].unit)}"
        lines.append(f"# {key(first)} = {{ {parts} }}  # {span}{said}")
    if not lines:
        return []
    return ["# no name is like that of a channel: take the # away where a line is right", *lines]
