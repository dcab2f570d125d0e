"""Functions of Python, `math` and `numpy` that a script may use: they compute, and do no more."""

import math
from collections.abc import Callable
from typing import Any

import numpy as np

from rga.importing.scripts.python.opened import Opened, OpenedNames
from rga.importing.scripts.values import LONGEST, Unknown


def _range(*bounds: int) -> range:
    found = range(*bounds)
    if len(found) > LONGEST:
        raise ValueError("the range is too long")
    return found


def _arange(*bounds: float) -> Any:
    low, high, step = (0.0, *bounds, 1.0) if len(bounds) == 1 else (*bounds, 1.0)[:3]
    if (high - low) / step > LONGEST:
        raise ValueError("the range is too long")
    return np.arange(*bounds)


def _linspace(low: float, high: float, count: int = 50) -> Any:
    if count > LONGEST:
        raise ValueError("the range is too long")
    return np.linspace(low, high, int(count))


def _filled(value: float) -> Callable[[Any], Any]:
    def fill(shape: Any, dtype: Any = None) -> Any:
        if math.prod(np.atleast_1d(shape).tolist()) > LONGEST:
            raise ValueError("the array is too large")
        return np.full(shape, value)

    return fill


def _array(values: Any, dtype: Any = None) -> Any:
    found = np.array(values)
    if found.dtype.kind not in "biuf":
        raise ValueError("an array of other things than numbers")
    return found


def _listed(function: Callable[..., Any]) -> Callable[..., list[Any]]:
    return lambda *values, **named: list(function(*values, **named))


#: functions of Python itself
BUILT_IN: dict[str, Any] = {
    "abs": abs, "all": all, "any": any, "bool": bool, "dict": dict, "divmod": divmod,
    "enumerate": _listed(enumerate), "float": float, "int": int, "len": len, "list": list,
    "max": max, "min": min, "range": _range, "reversed": _listed(reversed), "round": round,
    "set": set, "sorted": sorted, "str": str, "sum": sum, "tuple": tuple, "zip": _listed(zip),
}  # fmt: skip
MATH: dict[str, Any] = {
    name: getattr(math, name)
    for name in (
        "acos", "asin", "atan", "atan2", "ceil", "copysign", "cos", "cosh", "degrees", "e", "exp",
        "fabs", "floor", "fmod", "hypot", "inf", "isclose", "log", "log10", "pi", "radians",
        "sin", "sinh", "sqrt", "tan", "tanh", "tau", "trunc", "dist",
    )
} | {"pow": lambda base, power: float(base) ** float(power)}  # fmt: skip
NUMPY: dict[str, Any] = {
    **{
        name: getattr(np, name)
        for name in (
            "arccos", "arcsin", "arctan", "arctan2", "ceil", "cos", "cosh", "cross", "deg2rad",
            "degrees", "exp", "floor", "hypot", "log", "log10", "max", "mean", "min", "pi",
            "rad2deg", "radians", "round", "sign", "sin", "sinh", "sqrt", "square", "sum", "tan",
            "tanh", "abs", "absolute", "power", "e",
        )
    },
    "arange": _arange, "linspace": _linspace, "array": _array, "asarray": _array,
    "zeros": _filled(0.0), "ones": _filled(1.0),
    "linalg": OpenedNames("numpy.linalg", {"norm": np.linalg.norm}),
    "float64": float, "int64": int,
}  # fmt: skip
#: methods of plain values
METHODS: dict[type, frozenset[str]] = {
    list: frozenset(("append", "extend", "insert", "index", "count", "copy", "pop", "reverse",
                     "sort", "remove", "clear")),
    tuple: frozenset(("index", "count")),
    dict: frozenset(("items", "keys", "values", "get", "update", "setdefault", "pop", "copy")),
    set: frozenset(("add", "update", "union", "discard", "copy")),
    str: frozenset(("upper", "lower", "strip", "startswith", "endswith", "split", "title")),
    np.ndarray: frozenset(("tolist", "copy", "sum", "min", "max", "mean", "flatten", "ravel")),
}  # fmt: skip
#: methods that change the list, table or set that they are of
CHANGING = frozenset((
    "add", "append", "discard", "extend", "insert", "pop", "remove", "setdefault", "update",
))  # fmt: skip
#: methods that show what is in a table
VIEWS = frozenset(("copy", "get", "items", "keys", "values"))
MODULES: dict[str, Opened] = {
    "math": OpenedNames("math", MATH),
    "numpy": OpenedNames("numpy", NUMPY),
}


def weight(value: Any) -> int:
    """How many items a value holds."""
    if isinstance(value, np.ndarray):
        return int(value.size)
    return len(value) if isinstance(value, str | list | tuple | dict | set | range) else 0


def spoil(owner: Any, why: Unknown) -> None:
    """Make a list, table or set one of which nothing is known."""
    owner.clear()
    if isinstance(owner, list):
        owner.append(why)
    elif isinstance(owner, dict):
        owner[why] = why
    else:
        owner.add(why)


def not_known(name: str) -> Unknown:
    """The result of something that is not evaluated."""
    return Unknown(f"the result of {name}")
