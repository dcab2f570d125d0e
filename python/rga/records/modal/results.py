"""What an identification found, as a modal record."""

from collections.abc import Mapping, Sequence
from dataclasses import replace
from pathlib import Path
from typing import Any

import polars as pl

from rga.errors import InputError, kind_of
from rga.model import Model
from rga.records.frames import table_of_frame
from rga.records.modal.columns import DURATION, IMAGINARY, TIME
from rga.records.modal.formats.pyoma2 import FREQUENCIES, POINTS, RESULT, table_of_arrays
from rga.records.modal.read import modal_record_of
from rga.records.modal.record import ModalRecord


def modal_record(
    results: Any,
    model: Model,
    points: Sequence[str],
    *,
    time: Sequence[str | float] | str | float = 0.0,
    duration: float | None = None,
) -> ModalRecord:
    """The modal record of results of pyOMA2, or of any arrays of that kind.

    Args:
        results: that of a window (`algorithm.result` after `mpe`, or a cluster's), or a list of
            them: objects or mappings with Fn [Hz], float[modes]; and where they have them Xi [-]
            and Fn_std [Hz], float[modes], and Phi, float or complex[channels, modes].
        model: whose points are where shapes are measured.
        points: names of the channels in their order; those that are points of the model are used.
        time: of the middle of the window, ISO 8601 or seconds, or that of each window.
        duration: of the windows [s].

    Raises:
        InputError: there is no Fn, dimensions do not fit, no mode was found, a frequency is not
            above zero, or times are not one a window.

    >>> from rga import ModelBuilder
    >>> build = ModelBuilder("mast").add_material("steel", "S355").add_section("tube", "HEB 200")
    >>> build = build.add_node("foot").add_node("head", z="6 m").support("foot", "fixed")
    >>> model = build.add_member("foot", "head", "tube", kind="frame").build()
    >>> found = {"Fn": [1.5, 1.9], "Xi": [0.01, 0.02], "Phi": [[1.0, 0.1], [0.1, -1.0]]}
    >>> modal_record(found, model, ["A1", "A2"], time="2026-03-01T12:00").frequency.tolist()
    [1.5, 1.9]
    """
    several = isinstance(results, Sequence) and not isinstance(results, str)
    windows = list(results) if several else [results]
    times = list(time) if isinstance(time, Sequence) and not isinstance(time, str) else [time]
    if len(times) != len(windows):
        raise InputError(
            f"there are {len(windows)} results and {len(times)} times",
            "time",
            "give the middle of each window",
        )
    if not windows:
        raise InputError("there is no result", "results", "give at least one")
    tables = []
    for number, (one, at) in enumerate(zip(windows, times, strict=True)):
        arrays = _arrays(one, f"result {number}")
        arrays |= {POINTS: list(points), TIME: [at], DURATION: duration}
        tables.append(table_of_arrays(arrays, Path(f"result {number}")))
    frame = pl.concat([one.frame for one in tables], how="diagonal_relaxed")
    # A window whose shapes are real has no imaginary parts beside one whose shapes are complex.
    frame = frame.with_columns(pl.col(f"^.*{IMAGINARY}$").fill_null(0.0))
    return modal_record_of(replace(table_of_frame(frame), path=Path("results")), model)


def _arrays(result: Any, where: str) -> dict[str, Any]:
    if isinstance(result, Mapping):
        found = {name: result[name] for name in RESULT if name in result}
    else:
        found = {name: getattr(result, name, None) for name in RESULT}
    if found.get(FREQUENCIES) is None:
        raise InputError(
            f"{kind_of(result)} has no {FREQUENCIES}",
            where,
            "give a result of pyOMA2 after mpe, or a mapping with Fn, Xi, Phi and Fn_std",
        )
    return found
