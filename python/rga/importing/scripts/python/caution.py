"""What may change a model without being followed: it is refused, never passed over."""

import ast
from collections.abc import Callable, Collection, Sequence
from dataclasses import dataclass
from typing import Any

from rga.errors import InputError
from rga.importing.scripts.python.evaluation import Evaluation, Function, LeavingPython
from rga.importing.scripts.python.library import CHANGING, VIEWS, not_known, spoil
from rga.importing.scripts.python.modules import ENDING, RUNNING_CODE
from rga.importing.scripts.python.names import assigned, leaves
from rga.importing.scripts.python.opened import Anything, Opened
from rga.importing.scripts.values import Unknown


def _never(name: str) -> bool:
    return False


@dataclass(frozen=True)
class Host:
    """What an interpreter must know of the program whose model a script makes.

    Attributes:
        shapes: whether calling a name changes the model.
        quiet: whether calling a name of the model only analyses or shows it.
        built: whether the model has members by now.
        plain: whether a name of a part of the model is a result, and no part itself.
        shared: whether all code reaches the model, without being given it.
        without: modules that are taken not to change it.
    """

    shapes: Callable[[str], bool]
    quiet: Callable[[str], bool]
    built: Callable[[], bool]
    plain: Callable[[str], bool] = _never
    shared: bool = False
    without: Collection[str] = ()


class Caution(Evaluation):
    """Tells what reaches the model from what does not.

    Args:
        file: name of the script.
        host: whose model it makes.

    Attributes:
        functions: those that the script defines.
    """

    def __init__(self, file: str, host: Host) -> None:
        super().__init__(file)
        self.host = host
        self.functions: dict[str, ast.FunctionDef] = {}

    def plain(self, name: str) -> bool:
        return self.host.plain(name)

    def reaches(self, value: Any) -> bool:
        if isinstance(value, Opened | Unknown):
            return value.trust == "model"
        if isinstance(value, Function):
            return self.shaping(value.node)
        if isinstance(value, dict):
            return any(map(self.reaches, value.values()))
        return isinstance(value, list | tuple | set) and any(map(self.reaches, value))

    def unread(self, node: ast.Call, function: Anything | Unknown, given: list[Any]) -> Any:
        called = getattr(function, "name", "")
        if called in ENDING:
            raise LeavingPython("end")
        if called == "getattr" and len(given) > 1 and isinstance(given[1], str):
            if isinstance(given[0], Opened):
                return given[0].attribute(given[1])
            if isinstance(given[0], Unknown):
                return given[0]
        name = ast.unparse(node.func)[:60]
        method = node.func.attr if isinstance(node.func, ast.Attribute) else ""
        result = Unknown(f"the result of {name}", function.trust)
        if function.trust == "model":
            if method not in VIEWS:
                self.refuse(node, f"{name!r} is a call of a part of the model")
        elif called in RUNNING_CODE:
            self.refuse(node, f"{name!r} runs code that is not read")
        elif function.trust != "shows" and any(map(self.reaches, given)):
            self.refuse(node, f"{name!r} is given the model, or what changes it, and is not read")
        elif function.trust == "foreign" and self.host.shared:
            self.refuse(node, f"{name!r} is code that is not read, and may change the model")
        elif isinstance(function, Unknown) and self.host.shapes(method):
            self.refuse(node, f"{name!r} may change the model, and what it is of is not known")
        return result

    def evaluated(
        self,
        node: ast.Call,
        function: Callable[..., Any],
        values: list[Any],
        named: dict[str, Any],
    ) -> Any:
        owner, name = getattr(function, "__self__", None), getattr(function, "__name__", "")
        changes = name in CHANGING and isinstance(owner, list | dict | set)
        for given in () if changes else (*values, *named.values()):
            if isinstance(given, Function) and self.reaches(given):
                self.refuse(node, f"{ast.unparse(node)[:60]!r} is given what changes the model")
            if isinstance(given, Function | Opened):
                return not_known(ast.unparse(node.func)[:40])
            if isinstance(given, Unknown):
                return given
        unknown = [one for one in values if isinstance(one, Unknown)]
        if unknown and name not in ("append", "add"):
            spoil(owner, unknown[0])
            return unknown[0]
        return self.tried(node, function, *values, **named)

    def shaping(self, part: ast.AST, seen: set[str] | None = None) -> bool:
        """Whether a function, or one that it calls, changes the model."""
        return self.changing(part, set() if seen is None else seen) is not None

    def changing(self, part: ast.AST, seen: set[str]) -> tuple[str, ast.AST] | None:
        """What changes the model in a part of a script that is not evaluated: its name and it."""
        for one in ast.walk(part):
            if isinstance(one, ast.Call) and self._call_changes(one, seen):
                return _last(one.func), one
            stored = isinstance(one, ast.Attribute | ast.Subscript) and isinstance(
                one.ctx, ast.Store | ast.Del
            )
            if stored and self._rooted(one) == "model":
                return ast.unparse(one)[:60], one
        return None

    def _call_changes(self, call: ast.Call, seen: set[str]) -> bool:
        name, root = _last(call.func), self._rooted(call.func)
        if name in RUNNING_CODE:
            return True
        inner = self.functions.get(name) if isinstance(call.func, ast.Name) else None
        if inner is not None and name not in seen:
            seen.add(name)
            if self.shaping(inner, seen):
                return True
        if root == "foreign" and self.host.shared:
            return True
        if self.host.shapes(name) and root in ("", "model"):
            return True
        if root == "model" and isinstance(call.func, ast.Attribute):
            return not (self.host.quiet(name) or self.host.plain(name) or name in VIEWS)
        given = [*call.args, *(keyword.value for keyword in call.keywords)]
        if not any(self._rooted(one) == "model" and not self._plain(one) for one in given):
            return False
        if inner is not None:
            return any(isinstance(one, ast.Attribute) and isinstance(one.ctx, ast.Store)
                       for one in ast.walk(inner))  # fmt: skip
        return root in ("computes", "foreign")

    def _plain(self, part: ast.AST) -> bool:
        """Whether an expression has a result of the model, and no part of it."""
        return any(
            isinstance(one, ast.Attribute) and (self.host.plain(one.attr) or
                                                self.host.quiet(one.attr))
            for one in ast.walk(part)
        )  # fmt: skip

    def _rooted(self, part: ast.AST) -> str:
        """The trust of what an expression begins with; nothing where it is none or is not set."""
        while isinstance(part, ast.Attribute | ast.Subscript | ast.Call | ast.Starred):
            part = part.func if isinstance(part, ast.Call) else part.value
        if not isinstance(part, ast.Name):
            return ""
        found = self.name(part)
        if isinstance(found, Unknown) and found.trust == "foreign":
            return ""
        if isinstance(found, Opened | Unknown):
            return found.trust
        return "model" if not isinstance(found, Function) and self.reaches(found) else ""

    def pass_over(self, statements: Sequence[ast.AST], why: Unknown) -> None:
        """Pass over what may or may not be done; what it sets is then not known.

        Raises:
            InputError: it would change the model.
        """
        for statement in statements:
            found = self.changing(statement, set())
            if found is not None:
                raise InputError(
                    f"whether {found[0]!r} is done cannot be known: it hangs on {why.reason}",
                    self.where(found[1]),
                    "write out which is meant",
                )
            for name in assigned(statement):
                self.names[name] = why
            if self.leaving is None and (kind := leaves(statement)):
                self.leaving = kind, why


def _last(function: ast.AST) -> str:
    """The last name of what is called."""
    if isinstance(function, ast.Attribute):
        return function.attr
    return function.id if isinstance(function, ast.Name) else ast.unparse(function)[:40]
