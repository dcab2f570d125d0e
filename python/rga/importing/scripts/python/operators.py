"""Operators of Python on plain values, within bounds."""

import ast
import operator
from collections.abc import Callable
from typing import Any

import numpy as np

from rga.importing.scripts.values import LONGEST, Unknown

UNARY: dict[type[ast.unaryop], Callable[[Any], Any]] = {
    ast.UAdd: operator.pos,
    ast.USub: operator.neg,
    ast.Not: operator.not_,
    ast.Invert: operator.invert,
}
BINARY: dict[type[ast.operator], Callable[[Any, Any], Any]] = {
    ast.Add: operator.add,
    ast.Sub: operator.sub,
    ast.Mult: operator.mul,
    ast.Div: operator.truediv,
    ast.FloorDiv: operator.floordiv,
    ast.Mod: operator.mod,
    ast.Pow: operator.pow,
}
COMPARING: dict[type[ast.cmpop], Callable[[Any, Any], Any]] = {
    ast.Eq: operator.eq,
    ast.NotEq: operator.ne,
    ast.Lt: operator.lt,
    ast.LtE: operator.le,
    ast.Gt: operator.gt,
    ast.GtE: operator.ge,
    ast.Is: operator.is_,
    ast.IsNot: operator.is_not,
    ast.In: lambda one, many: one in many,
    ast.NotIn: lambda one, many: one not in many,
}


def two(kind: type[ast.operator], left: Any, right: Any) -> Any:
    """The value of an operator of two values.

    Raises:
        ValueError, TypeError, ArithmeticError: it has none, or one beyond bounds.
    """
    if kind not in BINARY or (isinstance(left, str) and kind is ast.Mod):
        return Unknown(f"the result of {kind.__name__}")
    _check(kind, left, right)
    with np.errstate(all="ignore"):
        found = BINARY[kind](left, right)
    if isinstance(found, complex):
        raise ValueError("the value is no real number")
    return found


def _check(kind: type[ast.operator], left: Any, right: Any) -> None:
    """Refuse what would grow beyond bounds."""
    if kind is ast.Pow and isinstance(left, int) and isinstance(right, int):
        if abs(left) > 1 and abs(right) > 63:
            raise ValueError("the number is too large")
    elif kind is ast.Mult:
        for many, times in ((left, right), (right, left)):
            repeated = isinstance(many, str | list | tuple) and isinstance(times, int)
            if repeated and len(many) * times > LONGEST:
                raise ValueError("the list is too long")
    if isinstance(left, np.ndarray) or isinstance(right, np.ndarray):
        shape = np.broadcast_shapes(np.shape(left), np.shape(right))
        if np.prod(shape, dtype=float) > LONGEST:
            raise ValueError("the array is too large")
