"""Modes in a universal file, dataset 55: normal and complex modes at nodes."""

from pathlib import Path
from typing import Any

import numpy as np

from rga.errors import InputError
from rga.records.formats.universal.datasets import datasets, point_of
from rga.records.modal.columns import DAMPING, FREQUENCY, HINT, TIME
from rga.records.modal.formats.entries import table_of_entries
from rga.records.table import Table

#: analysis types: real modes, and complex ones of first and second order
_NORMAL, _COMPLEX = 2, (3, 7)
#: data characteristics that are motion, with three and six values a node
_MOTION = {2: 3, 3: 6}
#: specific data that are motion: unknown, general, displacement, velocity, acceleration
_MOVING = (0, 1, 8, 11, 12)


def read_universal_modes(path: Path) -> Table:
    """The modal record of the modes of one test, at time 0.

    Shapes are in columns n12_x and so on, by number of the node and axis. What is zero in every
    mode was not measured, as the format writes zeros for what it lacks.

    Raises:
        InputError: the file is damaged, or has no mode, or other data at nodes than motion.
        MissingPackageError: pyuff is not installed.
    """
    found = datasets(path, 55, "data at nodes")
    modes = [one for one in found if one["analysis_type"] in (_NORMAL, *_COMPLEX)]
    if not modes:
        raise InputError(
            "no dataset 55 in the file holds a mode", str(path), "export modes and not responses"
        )
    motions = [_motion(one, path) for one in modes]
    places = sorted({place for motion in motions for place in motion})
    shapes = np.array([[motion.get(place, 0.0) for place in places] for motion in motions])
    moved = [at for at in range(len(places)) if shapes[:, at].any()]
    frequency, damping = zip(*(_frequency(one, path) for one in modes), strict=True)
    entries: dict[str, Any] = {
        TIME: np.zeros(len(modes)),
        FREQUENCY: np.array(frequency),
        DAMPING: np.array(damping),
        HINT: [str(one["mode_n"]) for one in modes],
    }
    channels = [point_of(*places[at]) for at in moved]
    return table_of_entries(path, "universal file", entries, shapes[:, moved], channels)


def _motion(one: dict[str, Any], path: Path) -> dict[tuple[int, int], complex]:
    """Motion by node and direction."""
    where = f"{path}, mode {one['mode_n']}"
    values = _MOTION.get(one["data_ch"])
    if values is None or one["spec_data_type"] not in _MOVING:
        raise InputError(
            "the data at nodes are no motion", where, "export translations, and not strains"
        )
    if one["n_data_per_node"] != values:
        raise InputError(
            f"a node has {one['n_data_per_node']} values, not {values}", where, "export it again"
        )
    columns = [np.asarray(one[f"r{k}"]) for k in range(1, values + 1)]
    nodes = [int(node) for node in one["node_nums"]]
    if {len(column) for column in columns} != {len(nodes)} or len(set(nodes)) < len(nodes):
        raise InputError("nodes and values do not fit together", where, "export the file again")
    return {
        (node, k): column[at].item()
        for k, column in enumerate(columns, 1)
        for at, node in enumerate(nodes)
    }


def _frequency(one: dict[str, Any], path: Path) -> tuple[float, float]:
    """Natural frequency [Hz] and share of critical damping, NaN where it is not said."""
    if one["analysis_type"] == _NORMAL:
        frequency, damping = float(one["freq"]), float(one["modal_damp_vis"])
    else:
        rate = complex(one["eig"])
        frequency = abs(rate) / (2 * np.pi)
        damping = -rate.real / abs(rate) if rate else np.nan
    if not frequency > 0:
        raise InputError(
            f"{frequency:g} Hz is no frequency of a mode that swings",
            f"{path}, mode {one['mode_n']}",
            "leave the mode out",
        )
    return frequency, damping if damping > 0 else np.nan
