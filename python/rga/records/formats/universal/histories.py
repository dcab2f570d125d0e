"""Time histories of a universal file, dataset 58: what sensors read, as a table."""

from collections import Counter
from pathlib import Path
from typing import Any

import numpy as np
import polars as pl

from rga.errors import InputError
from rga.records.formats.blocks import chosen_block
from rga.records.formats.universal.datasets import DIRECTIONS, datasets, point_of
from rga.records.mapping import FileMapping
from rga.records.table import StatedTime, Table
from rga.records.units import states_none

#: function type of a time response, and types of real numbers at even steps
_RESPONSE, _REAL, _EVEN = 1, (2, 4), 1


def read_histories(path: Path, mapping: FileMapping) -> Table:
    """A column for each sensor, named after its node and direction: n12_x.

    One that measures against an axis is turned, so that n12_x always counts along x.

    Raises:
        InputError: the file is damaged, or has no time response of real numbers at even steps.
        MissingPackageError: pyuff is not installed.
    """
    found = datasets(path, 58, "functions at nodes")
    blocks: dict[tuple[float, ...], list[dict[str, Any]]] = {}
    for one in found:
        if one["func_type"] == _RESPONSE:
            _check(one, path)
            timing = (len(one["data"]), one["abscissa_min"], one["abscissa_inc"])
            blocks.setdefault(timing, []).append(one)
    if not blocks:
        raise InputError(
            "no function in the file is a time response", str(path), "export time histories"
        )
    said = [f"{len(one)} channels of {timing[0]} rows" for timing, one in blocks.items()]
    chosen, notes = chosen_block(list(blocks.values()), said, mapping.block, path)
    names = [point_of(one["rsp_node"], one["rsp_dir"]) for one in chosen]
    double = next((name for name, times in Counter(names).items() if times > 1), None)
    if double is not None:
        raise InputError(
            f"{double!r} was measured twice",
            str(path),
            "export one run alone",
        )
    turned = [name for name, one in zip(names, chosen, strict=True) if one["rsp_dir"] < 0]
    if turned:
        notes.append(f"turned, as they measure against their axis: {', '.join(turned)}")
    columns = {
        name: np.asarray(one["data"], dtype=float) * (-1.0 if one["rsp_dir"] < 0 else 1.0)
        for name, one in zip(names, chosen, strict=True)
    }
    labels = [one.get("ordinate_axis_units_lab") or "" for one in chosen]
    units = {
        name: unit.strip()
        for name, unit in zip(names, labels, strict=True)
        if not states_none(unit.strip()) and unit.strip().upper() != "NONE"
    }
    return Table(
        path=path,
        frame=pl.DataFrame(columns),
        row_name="sample",
        first=1,
        format="universal file",
        units=units,
        time=StatedTime(step=float(chosen[0]["abscissa_inc"])),
        notes=tuple(notes),
    )


def _check(one: dict[str, Any], path: Path) -> None:
    where = f"{path}, node {one['rsp_node']}"
    if one["ord_data_type"] not in _REAL or one["abscissa_spacing"] != _EVEN:
        raise InputError(
            "a time response is complex, or its steps in time are not even",
            where,
            "export real numbers at even steps",
        )
    if len(one["data"]) != one["num_pts"] or not one["abscissa_inc"] > 0:
        raise InputError(
            f"a time response has {len(one['data'])} of {one['num_pts']} samples, at steps of "
            f"{one['abscissa_inc']:g} s",
            where,
            "export the file again",
        )
    if abs(one["rsp_dir"]) >= len(DIRECTIONS):
        raise InputError(f"{one['rsp_dir']} is no direction", where, "give one from -6 to 6")
