"""Values of Python expressions, by their syntax tree."""

import ast
from abc import ABC, abstractmethod
from collections.abc import Callable, Iterator
from typing import Any

import numpy as np

from rga.bounded_files import fault_of
from rga.errors import InputError
from rga.importing.scripts.python.library import BUILT_IN, METHODS, not_known, spoil, weight
from rga.importing.scripts.python.modules import trust_of_built_in
from rga.importing.scripts.python.opened import Anything, Opened
from rga.importing.scripts.python.operators import COMPARING, UNARY, two
from rga.importing.scripts.values import Steps, Unknown, checked_size

#: calls within calls
DEEPEST = 40
#: characters of the longest format of a number in a text
LONGEST_FORMAT = 8


class LeavingPython(Exception):
    """`break`, `continue`, `return` or the end of the script on its way out."""

    def __init__(self, kind: str, value: Any = None) -> None:
        self.kind, self.value = kind, value


class Function:
    """A function of the script."""

    def __init__(self, node: ast.FunctionDef | ast.Lambda, defaults: dict[str, Any]) -> None:
        self.node, self.defaults = node, defaults


class Evaluation(ABC):
    """Evaluates expressions; a subclass knows statements, and calls functions.

    Attributes:
        names: variables of the script, and those of the function at work.
        libraries: modules whose names all stand open.
        refusals: what is not followed and may change the model: words and place.
    """

    def __init__(self, file: str) -> None:
        self.file = file
        self.refusals: list[tuple[str, str]] = []
        #: whether the script goes on here is not known: what would leave, and why
        self.leaving: tuple[str, Unknown] | None = None
        self.steps = Steps()
        self.everywhere: dict[str, Any] = {}
        self.names = self.everywhere
        self.libraries: list[Opened] = []

    def where(self, node: ast.AST) -> str:
        """A place in words."""
        return f"line {getattr(node, 'lineno', 1)}"

    @abstractmethod
    def call_function(self, function: Function, values: list[Any], named: dict[str, Any]) -> Any:
        """Call a function of the script."""

    @abstractmethod
    def reaches(self, value: Any) -> bool:
        """Whether a value is the model or a part of it, has one in it, or changes it."""

    @abstractmethod
    def unread(self, node: ast.Call, function: Anything | Unknown, given: list[Any]) -> Any:
        """The result of calling what is not evaluated; refused where it may change the model."""

    @abstractmethod
    def evaluated(
        self,
        node: ast.Call,
        function: Callable[..., Any],
        values: list[Any],
        named: dict[str, Any],
    ) -> Any:
        """What a function of a library gives, or a method of a plain value."""

    @abstractmethod
    def plain(self, name: str) -> bool:
        """Whether a name of a part of the model is a result or a number, and no part itself."""

    def refuse(self, node: ast.AST, words: str) -> None:
        """ImportNote what is not followed and may change the model."""
        self.refusals.append((words, self.where(node)))

    def value(self, node: ast.AST) -> Any:
        """The value of an expression.

        Raises:
            InputError: it has none, or one beyond bounds.
        """
        self.steps.take(self.where(node))
        read = READERS.get(type(node))
        if read is None:
            return not_known(type(node).__name__)
        found = read(self, node)
        size = weight(found)
        if size > 100:
            self.steps.take(self.where(node), size)
        return checked_size(found, self.where(node))

    def tried(self, node: ast.AST, function: Callable[..., Any], *values: Any, **named: Any) -> Any:
        """What a function gives; InputError at the place where it fails."""
        try:
            return function(*values, **named)
        except InputError:
            raise
        except Exception as error:
            what = f"{ast.unparse(node)[:60]!r} has no value: {fault_of(error)}"
            raise InputError(what, self.where(node), "correct it") from None

    def name(self, node: ast.Name) -> Any:
        for table in (self.names, self.everywhere, BUILT_IN):
            if node.id in table:
                return table[node.id]
        for library in self.libraries:
            found = library.attribute(node.id)
            if not isinstance(found, Anything):
                return found
        trust = trust_of_built_in(node.id)
        if trust is not None:
            return Anything(node.id, trust)
        return Unknown(f"{node.id}, which is not set", "foreign")

    def attribute(self, node: ast.Attribute) -> Any:
        owner = self.value(node.value)
        if isinstance(owner, Opened):
            found = owner.attribute(node.attr)
            part = type(found) is Anything and found.trust == "model"
            if part and self.plain(node.attr):
                return not_known(ast.unparse(node)[:40])
            return found
        if isinstance(owner, Unknown):
            if owner.trust == "model" and self.plain(node.attr):
                return not_known(ast.unparse(node)[:40])
            return owner
        if node.attr in METHODS.get(type(owner), ()):
            return getattr(owner, node.attr)
        if isinstance(owner, np.ndarray) and node.attr in ("T", "size", "shape"):
            return getattr(owner, node.attr)
        return Unknown(f"{ast.unparse(node)[:40]}, which is not evaluated")

    def call(self, node: ast.Call) -> Any:
        function = self.value(node.func)
        values: list[Any] = []
        for one in node.args:
            if isinstance(one, ast.Starred):
                spread = self.value(one.value)
                values += [spread] if isinstance(spread, Unknown) else self._items(one, spread)
            else:
                values.append(self.value(one))
        named: dict[str, Any] = {}
        for keyword in node.keywords:
            found = self.value(keyword.value)
            if keyword.arg is not None:
                named[keyword.arg] = found
            elif isinstance(found, dict):
                named |= found
        where, every = self.where(node), [*values, *named.values()]
        if type(function) is Anything or isinstance(function, Unknown):
            return self.unread(node, function, every)
        if isinstance(function, Opened):
            return self.tried(node, function.call, values, named, where)
        if isinstance(function, Function):
            return self.call_function(function, values, named)
        if not callable(function):
            return self.tried(node, lambda: function())
        return self.evaluated(node, function, values, named)

    def _items(self, node: ast.AST, value: Any) -> list[Any]:
        return list(self.tried(node, list, value))

    def items(self, node: ast.AST) -> list[Any] | Unknown:
        """The items of an expression that is gone through."""
        found = self.value(node)
        if isinstance(found, Opened):
            return Unknown(f"the result of {ast.unparse(node)[:40]}", found.trust)
        return found if isinstance(found, Unknown) else self._items(node, found)

    def binary(self, node: ast.BinOp) -> Any:
        left, right = self.value(node.left), self.value(node.right)
        for one in (left, right):
            if isinstance(one, Unknown | Opened):
                return one if isinstance(one, Unknown) else not_known(ast.unparse(node)[:40])
        return self.tried(node, two, type(node.op), left, right)

    def unary(self, node: ast.UnaryOp) -> Any:
        value = self.value(node.operand)
        if isinstance(value, Unknown):
            return value
        return self.tried(node, UNARY[type(node.op)], value)

    def either(self, node: ast.BoolOp) -> Any:
        found: Any = None
        for one in node.values:
            found = self.value(one)
            if isinstance(found, Unknown):
                return found
            if bool(found) == isinstance(node.op, ast.Or):
                return found
        return found

    def compare(self, node: ast.Compare) -> Any:
        left = self.value(node.left)
        for kind, one in zip(node.ops, node.comparators, strict=True):
            right = self.value(one)
            for given in (left, right):
                if isinstance(given, Unknown):
                    return given
            if not self.tried(node, COMPARING[type(kind)], left, right):
                return False
            left = right
        return True

    def subscript(self, node: ast.Subscript) -> Any:
        owner, place = self.value(node.value), self.value(node.slice)
        for one in (owner, place):
            if isinstance(one, Unknown):
                return one
        if isinstance(owner, Opened):
            return Unknown(f"the result of {ast.unparse(node)[:40]}", owner.trust)
        return self.tried(node, lambda: owner[place])

    def part(self, node: ast.Slice) -> Any:
        bounds = [
            None if one is None else self.value(one) for one in (node.lower, node.upper, node.step)
        ]
        unknown = [one for one in bounds if isinstance(one, Unknown)]
        return unknown[0] if unknown else slice(*bounds)

    def table(self, node: ast.Dict) -> Any:
        found: dict[Any, Any] = {}
        for key, value in zip(node.keys, node.values, strict=True):
            inner = self.value(value)
            if key is None:
                found |= inner if isinstance(inner, dict) else {}
                continue
            known = self.value(key)
            if isinstance(known, Unknown):
                return known
            self.tried(node, found.__setitem__, known, inner)
        return found

    def sequence(self, node: ast.List | ast.Tuple | ast.Set) -> Any:
        found: list[Any] = []
        for one in node.elts:
            if isinstance(one, ast.Starred):
                spread = self.items(one.value)
                found += [spread] if isinstance(spread, Unknown) else spread
            else:
                found.append(self.value(one))
        kind = {ast.List: list, ast.Tuple: tuple, ast.Set: set}[type(node)]
        return self.tried(node, kind, found)

    def joined(self, node: ast.JoinedStr) -> Any:
        parts: list[str] = []
        for one in node.values:
            inner = one.value if isinstance(one, ast.FormattedValue) else one
            value = self.value(inner)
            if isinstance(value, Unknown | Opened):
                return value if isinstance(value, Unknown) else not_known("a text")
            form = ""
            if isinstance(one, ast.FormattedValue) and one.format_spec is not None:
                spec = self.value(one.format_spec)
                if isinstance(spec, Unknown) or len(spec) > LONGEST_FORMAT or "0000" in spec:
                    return not_known("a text")
                form = spec
            parts.append(self.tried(node, format, value, form))
        return "".join(parts)

    def choice(self, node: ast.IfExp) -> Any:
        condition = self.value(node.test)
        if isinstance(condition, Unknown):
            return condition
        return self.value(node.body if condition else node.orelse)

    def comprehension(self, node: Any) -> Any:
        """A list, set or table of a comprehension."""
        kept = dict(self.names)
        found: list[Any] = []
        try:
            for turn in self._turns(node.generators):
                if isinstance(turn, Unknown):
                    return turn
                if isinstance(node, ast.DictComp):
                    found.append((self.value(node.key), self.value(node.value)))
                else:
                    found.append(self.value(node.elt))
        finally:
            self.names.clear()
            self.names.update(kept)
        kind = {ast.DictComp: dict, ast.SetComp: set}.get(type(node), list)
        return self.tried(node, kind, found)

    def _turns(self, generators: list[ast.comprehension]) -> Iterator[Any]:
        if not generators:
            yield None
            return
        first, *rest = generators
        items = self.items(first.iter)
        if isinstance(items, Unknown):
            yield items
            return
        for item in items:
            self.bind(first.target, item)
            conditions = [self.value(test) for test in first.ifs]
            unknown = [one for one in conditions if isinstance(one, Unknown)]
            if unknown:
                yield unknown[0]
            elif all(conditions):
                yield from self._turns(rest)

    def bind(self, target: ast.AST, value: Any) -> None:
        """Give a name, or several, or an item of a list, a value.

        Raises:
            InputError: they do not fit.
        """
        if isinstance(target, ast.Name):
            self.names[target.id] = value
        elif isinstance(target, ast.Tuple | ast.List):
            if isinstance(value, Unknown):
                values: list[Any] = [value] * len(target.elts)
            else:
                values = self._items(target, value)
            if len(values) != len(target.elts):
                raise InputError(
                    f"{len(values)} values for {len(target.elts)} names",
                    self.where(target),
                    "mend it",
                )
            for one, item in zip(target.elts, values, strict=True):
                self.bind(one, item)
        elif isinstance(target, ast.Attribute):
            if self.reaches(self.value(target.value)):
                self.refuse(target, f"{ast.unparse(target)[:60]!r} of the model is set")
        elif isinstance(target, ast.Subscript):
            owner, place = self.value(target.value), self.value(target.slice)
            if isinstance(owner, Opened | Unknown) and self.reaches(owner):
                self.refuse(target, f"{ast.unparse(target)[:60]!r} of the model is set")
            elif isinstance(place, Unknown) and isinstance(owner, list | dict):
                spoil(owner, place)
            elif isinstance(owner, list | dict | np.ndarray) and not isinstance(place, Unknown):
                self.tried(target, owner.__setitem__, place, value)


def _named(evaluation: Evaluation, node: ast.NamedExpr) -> Any:
    value = evaluation.value(node.value)
    evaluation.bind(node.target, value)
    return value


def _lambda(evaluation: Evaluation, node: ast.Lambda) -> Any:
    plain = node.args.args
    values = [evaluation.value(one) for one in node.args.defaults]
    names = [one.arg for one in plain[len(plain) - len(values) :]]
    return Function(node, dict(zip(names, values, strict=True)))


READERS: dict[type[ast.AST], Callable[[Evaluation, Any], Any]] = {
    ast.Constant: lambda evaluation, node: node.value,
    ast.Name: Evaluation.name,
    ast.Attribute: Evaluation.attribute,
    ast.Call: Evaluation.call,
    ast.BinOp: Evaluation.binary,
    ast.UnaryOp: Evaluation.unary,
    ast.BoolOp: Evaluation.either,
    ast.Compare: Evaluation.compare,
    ast.Subscript: Evaluation.subscript,
    ast.Slice: Evaluation.part,
    ast.Dict: Evaluation.table,
    ast.List: Evaluation.sequence,
    ast.Tuple: Evaluation.sequence,
    ast.Set: Evaluation.sequence,
    ast.JoinedStr: Evaluation.joined,
    ast.IfExp: Evaluation.choice,
    ast.ListComp: Evaluation.comprehension,
    ast.SetComp: Evaluation.comprehension,
    ast.DictComp: Evaluation.comprehension,
    ast.GeneratorExp: Evaluation.comprehension,
    ast.NamedExpr: _named,
    ast.Lambda: _lambda,
}
