"""`expr`: arithmetic as Tcl has it, `man n expr`."""

import math
import re
from collections.abc import Callable
from typing import Any

from rga.errors import InputError
from rga.importing.opensees.tcl.numbers import Number, is_number, number
from rga.importing.scripts.values import Unknown, checked_size

TOKEN = re.compile(
    r"\s*(?:(?P<number>(?:0[xX][0-9a-fA-F]+)|(?:\d+\.?\d*|\.\d+)(?:[eE][-+]?\d+)?)"
    r"|(?P<name>[A-Za-z_]\w*)|(?P<operator>\*\*|<<|>>|<=|>=|==|!=|&&|\|\||[-+*/%<>!?:()&|^~,])"
    r"|(?P<string>\"[^\"]*\"|\{[^{}]*\})|(?P<mark>\x00\d+\x00))"
)
#: how tightly an operator of two values binds
BINDS = {
    "||": 2, "&&": 3, "|": 4, "^": 5, "&": 6, "==": 7, "!=": 7, "eq": 7, "ne": 7, "in": 7, "ni": 7,
    "<": 8, ">": 8, "<=": 8, ">=": 8, "<<": 9, ">>": 9, "+": 10, "-": 10, "*": 11, "/": 11, "%": 11,
    "**": 12,
}  # fmt: skip
#: parentheses within parentheses
DEEPEST = 60


def _whole(value: Number) -> int:
    return int(value)


FUNCTIONS: dict[str, Callable[..., Any]] = {
    **{
        name: getattr(math, name)
        for name in (
            "sin", "cos", "tan", "asin", "acos", "atan", "atan2", "sinh", "cosh", "tanh", "exp",
            "log", "log10", "sqrt", "hypot", "fmod",
        )
    },
    "ceil": lambda value: float(math.ceil(value)),
    "floor": lambda value: float(math.floor(value)),
    "pow": lambda base, power: float(base) ** float(power),
    "abs": abs, "double": float, "int": _whole, "wide": _whole, "entier": _whole,
    "round": lambda value: int(math.floor(abs(value) + 0.5) * (1 if value >= 0 else -1)),
    "min": min, "max": max, "bool": bool, "isqrt": lambda value: math.isqrt(int(value)),
}  # fmt: skip


class Expression:
    """An expression and its value.

    Args:
        text: the expression, with a mark (NUL, number, NUL) for each value put in its place.
        values: of the marks, texts or what is not known.
        where: it stands, for an error.
    """

    def __init__(self, text: str, values: list[Any], where: str) -> None:
        self.text, self.values, self.where = text, values, where
        self.tokens: list[tuple[str, str]] = []
        place = 0
        while text[place:].strip():
            found = TOKEN.match(text, place)
            if found is None:
                raise self.error()
            self.tokens.append((found.lastgroup or "", found[found.lastgroup or 0]))
            place = found.end()
        self.place = 0

    def error(self) -> InputError:
        """An error about the whole of it."""
        shown = re.sub("\x00\\d+\x00", "...", self.text).strip()[:60]
        return InputError(
            f"the expression {shown!r} cannot be read", self.where, "write it as Tcl's expr has it"
        )

    def value(self) -> Any:
        """Its value: a number, a text, or what is not known.

        Raises:
            InputError: it cannot be read, or has no value.
        """
        found = self._of(0, 0)
        if self.place < len(self.tokens):
            raise self.error()
        return checked_size(found, self.where)

    def _next(self) -> tuple[str, str]:
        return self.tokens[self.place] if self.place < len(self.tokens) else ("end", "")

    def _of(self, binds: int, depth: int) -> Any:
        if depth > DEEPEST:
            raise self.error()
        left = self._single(depth)
        while True:
            _, operator = self._next()
            if operator == "?" and binds <= 1:
                left = self._choice(left, depth)
                continue
            own = BINDS.get(operator, 0)
            if own == 0 or own <= binds:
                return left
            self.place += 1
            # Powers associate to the right.
            right = self._of(own - 1 if operator == "**" else own, depth + 1)
            left = self._two(operator, left, right)

    def _choice(self, condition: Any, depth: int) -> Any:
        self.place += 1
        first = self._of(0, depth + 1)
        if self._next()[1] != ":":
            raise self.error()
        self.place += 1
        second = self._of(1, depth + 1)
        if isinstance(condition, Unknown):
            return condition
        return first if truth(condition, self.where) else second

    def _single(self, depth: int) -> Any:
        kind, text = self._next()
        self.place += 1
        if kind == "number":
            return number(text, self.where)
        if kind == "mark":
            return self._marked(self.values[int(text.strip("\0"))])
        if kind == "string":
            return text[1:-1]
        if kind == "name":
            return self._named(text, depth)
        if text == "(":
            inner = self._of(0, depth + 1)
            if self._next()[1] != ")":
                raise self.error()
            self.place += 1
            return inner
        if text in ("-", "+", "!", "~"):
            # These bind more tightly than any operator of two values, powers included.
            return self._one(text, self._of(12, depth + 1))
        raise self.error()

    def _marked(self, value: Any) -> Any:
        return number(value, self.where) if isinstance(value, str) and is_number(value) else value

    def _named(self, name: str, depth: int) -> Any:
        if self._next()[1] != "(":
            if name.lower() in ("true", "yes", "on"):
                return 1
            if name.lower() in ("false", "no", "off"):
                return 0
            raise self.error()
        self.place += 1
        arguments: list[Any] = []
        while self._next()[1] != ")":
            if arguments:
                if self._next()[1] != ",":
                    raise self.error()
                self.place += 1
            arguments.append(self._of(0, depth + 1))
        self.place += 1
        unknown = [value for value in arguments if isinstance(value, Unknown)]
        if unknown:
            return unknown[0]
        if name in ("rand", "srand"):
            return Unknown("a random number")
        if name not in FUNCTIONS:
            raise InputError(f"{name} is no function of expr", self.where, "write its value")
        return self._computed(FUNCTIONS[name], *arguments)

    def _one(self, operator: str, value: Any) -> Any:
        if isinstance(value, Unknown):
            return value
        if operator == "!":
            return int(not truth(value, self.where))
        if operator == "~":
            return self._computed(lambda one: ~one, value)
        return self._computed(lambda one: -one if operator == "-" else +one, value)

    def _two(self, operator: str, left: Any, right: Any) -> Any:
        for value in (left, right):
            if isinstance(value, Unknown):
                return value
        if operator in ("&&", "||"):
            both = truth(left, self.where), truth(right, self.where)
            return int(all(both) if operator == "&&" else any(both))
        if operator in ("in", "ni"):
            return int((str(left) in str(right).split()) == (operator == "in"))
        if operator in ("eq", "ne"):
            return int((str(left) == str(right)) == (operator == "eq"))
        if operator in ("==", "!=") and (isinstance(left, str) or isinstance(right, str)):
            return int((str(left) == str(right)) == (operator == "=="))
        return self._computed(ARITHMETIC[operator], left, right)

    def _computed(self, function: Callable[..., Any], *values: Any) -> Any:
        try:
            if any(isinstance(value, str) for value in values):
                raise ValueError("a text is no number")
            found = function(*values)
            if isinstance(found, complex) or (
                isinstance(found, float) and not math.isfinite(found)
            ):
                raise ValueError("the value is no finite number")
        except (ValueError, ZeroDivisionError, OverflowError, TypeError) as error:
            raise InputError(
                f"the expression has no value: {error}", self.where, "correct it"
            ) from None
        return int(found) if isinstance(found, bool) else checked_size(found, self.where)


def truth(value: Any, where: str) -> bool:
    """Whether a value stands for true.

    Raises:
        InputError: it is no number and no word for true or false.
    """
    if isinstance(value, int | float):
        return bool(value)
    word = str(value).strip().lower()
    if word in ("true", "yes", "on"):
        return True
    if word in ("false", "no", "off"):
        return False
    return bool(number(str(value), where))


def _divided(left: Number, right: Number) -> Number:
    """Whole numbers are divided downward, as in Tcl."""
    if isinstance(left, int) and isinstance(right, int):
        return left // right
    return left / right


def _power(base: Number, power: Number) -> Number:
    if isinstance(base, int) and isinstance(power, int):
        if power < 0:
            return 0 if abs(base) > 1 else int(base ** (-power))
        if abs(base) > 1 and power > 63:
            raise OverflowError("the number is too large")
        return int(base**power)
    return float(base) ** power


def _shifted(value: Number, by: Number, left: bool) -> int:
    if not 0 <= by < 64:
        raise ValueError("a shift by so many places")
    return int(value) << int(by) if left else int(value) >> int(by)


def _whole_only(function: Callable[[int, int], int]) -> Callable[[Number, Number], int]:
    def checked(left: Number, right: Number) -> int:
        if not (isinstance(left, int) and isinstance(right, int)):
            raise ValueError("a floating-point number where a whole one is needed")
        return function(left, right)

    return checked


ARITHMETIC: dict[str, Callable[[Any, Any], Any]] = {
    "+": lambda a, b: a + b,
    "-": lambda a, b: a - b,
    "*": lambda a, b: a * b,
    "/": _divided,
    "%": _whole_only(lambda a, b: a % b),
    "**": _power,
    "<": lambda a, b: a < b,
    ">": lambda a, b: a > b,
    "<=": lambda a, b: a <= b,
    ">=": lambda a, b: a >= b,
    "==": lambda a, b: a == b,
    "!=": lambda a, b: a != b,
    "&": _whole_only(lambda a, b: a & b),
    "|": _whole_only(lambda a, b: a | b),
    "^": _whole_only(lambda a, b: a ^ b),
    "<<": lambda a, b: _shifted(a, b, True),
    ">>": lambda a, b: _shifted(a, b, False),
}
