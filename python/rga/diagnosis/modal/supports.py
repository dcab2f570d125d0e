"""Windows whose structures stand for those of all."""

from collections.abc import Sequence

import numpy as np

from rga.arrays import BoolArray, FloatArray, IntArray
from rga.diagnosis.modal.readings import ModalWindows
from rga.errors import InputError
from rga.model.effect import Values
from rga.model.schema import Model

#: windows that stand for all of which only one context tells the structure
SUPPORTS = 13
#: values of a context that are told apart one by one, and combinations of such, at most
FEW, COMBINATIONS = 4, 12


def supports(
    readings: ModalWindows, driving: Sequence[FloatArray], standing: Sequence[FloatArray]
) -> tuple[IntArray, FloatArray, int]:
    """Windows that stand for all, and the share of each in every window.

    What has few values, such as whether a truck stands there, is held apart: each combination has
    windows of its own. Among these the structure is looked at along the context that says most of
    the frequencies; others are as they are beside it.

    Args:
        readings: of the windows.
        driving: contexts that drive the structure, float[windows] each.
        standing: shares of what stands on it in some windows, float[windows] each.

    Returns:
        int[supports]; float[windows, supports]; and the number of the support in the middle of the
        combination that most windows have.
    """
    windows = len(readings.time)
    apart, along = [], []
    combinations = 1
    for column in [*standing, *driving]:
        count = len(np.unique(column))
        if 1 < count <= FEW and combinations * count <= COMBINATIONS:
            apart.append(column)
            combinations *= count
        elif count > 1:
            along.append(column)
    column = max(along, key=lambda one: _told(one, readings), default=np.zeros(windows))
    several = np.array([np.zeros(windows), *apart]).T
    _, of_window = np.unique(several, axis=0, return_inverse=True)
    of_window = np.asarray(of_window).ravel()
    found = [_along(column, of_window == number) for number in range(of_window.max() + 1)]
    most = int(np.bincount(of_window).argmax())
    middle = sum(len(own) for own in found[:most]) + len(found[most]) // 2
    chosen, weights = zip(*(one for own in found for one in own), strict=True)
    return np.array(chosen, dtype=np.int64), np.array(weights).T, middle


def window_contexts(model: Model, needed: set[str], readings: ModalWindows) -> Values:
    """Contexts of the windows, float[windows] each; what was not measured lies in its middle.

    Args:
        model: says which there are, and in which range.
        needed: those that drive the structure.
        readings: of the windows.

    Raises:
        InputError: one that drives the structure was not measured.
    """
    found: Values = {}
    for name, variable in model.context.items():
        column = readings.contexts.get(name)
        seen = np.zeros(0, dtype=bool) if column is None else np.isfinite(column)
        if column is not None and seen.any():
            found[name] = np.where(seen, column, column[seen].mean())
        elif name in needed:
            raise InputError(
                f"context {name!r}, which drives the structure, is not in the modal record",
                f"model {model.name!r}",
                f"give a column {name} beside the frequencies",
            )
        else:
            found[name] = np.full(len(readings.time), sum(variable.range) / 2)
    return found


def _along(column: FloatArray, own: BoolArray) -> list[tuple[int, FloatArray]]:
    """Windows among some of them, with the share of each in all, float[windows]."""
    numbers = np.flatnonzero(own)
    order = numbers[np.argsort(column[numbers], kind="stable")]
    if np.ptp(column[order]) == 0:
        return [(int(numbers[len(numbers) // 2]), own.astype(float))]
    places = np.linspace(0, len(order) - 1, min(SUPPORTS, len(order))).round().astype(int)
    chosen = order[np.unique(places)]
    chosen = chosen[np.unique(column[chosen], return_index=True)[1]]
    at = column[chosen]
    return [
        (int(window), np.where(own, np.interp(column, at, one), 0.0))
        for window, one in zip(chosen, np.eye(len(chosen)), strict=True)
    ]


def _told(column: FloatArray, readings: ModalWindows) -> float:
    """How much a context says of the frequencies: sum of squared correlations."""
    total = 0.0
    for log_f in readings.log_f.T:
        seen = np.isfinite(log_f)
        if seen.sum() > 2 and np.ptp(column[seen]) > 0 and np.ptp(log_f[seen]) > 0:
            total += float(np.corrcoef(column[seen], log_f[seen])[0, 1] ** 2)
    return total
