"""Statements of Python, one by one, within bounds."""

import ast
import warnings
from collections.abc import Callable, Sequence
from typing import Any

import numpy as np

from rga.errors import InputError
from rga.importing.scripts.python.caution import Caution, Host
from rga.importing.scripts.python.evaluation import DEEPEST, Function, LeavingPython
from rga.importing.scripts.python.library import MODULES, not_known, spoil
from rga.importing.scripts.python.modules import trust_of_module
from rga.importing.scripts.python.names import called, required
from rga.importing.scripts.python.opened import Anything, Opened, OpenedNames
from rga.importing.scripts.python.operators import two
from rga.importing.scripts.values import Unknown

#: characters of the longest script
LONGEST_SCRIPT = 4 * 2**20


class PythonInterpreter(Caution):
    """An interpreter of one script.

    Args:
        file: its name.
        modules: what the modules that it imports stand for, by name, beside `math` and `numpy`.
        host: the program whose model it makes.

    Attributes:
        assumed: what it took for granted: words and place.
    """

    def __init__(self, file: str, modules: dict[str, Opened], host: Host) -> None:
        super().__init__(file, host)
        self.modules = {**MODULES, **modules}
        self.shared: set[str] = set()
        self.begun: set[str] = set()
        self.assumed: list[tuple[str, str]] = []
        self.depth = 0
        self.everywhere["__name__"] = "__main__"

    def run(self, text: str) -> None:
        """Evaluate a script; where it only defines the function that builds, that too.

        Raises:
            InputError: it cannot be read, takes too many steps, or a statement is wrong.
        """
        if len(text) > LONGEST_SCRIPT:
            raise InputError(
                f"the script is longer than {LONGEST_SCRIPT // 2**20} MiB",
                self.file,
                "give the part that builds the structure",
            )
        try:
            with warnings.catch_warnings():
                warnings.simplefilter("ignore")
                tree = ast.parse(text)
        except SyntaxError as error:
            raise InputError(
                f"this is no Python: {error.msg}", f"line {error.lineno or 1}", "mend the syntax"
            ) from None
        except (ValueError, RecursionError, MemoryError) as error:
            raise InputError(f"this is no Python: {error}", self.file, "mend it") from None
        try:
            self._each(tree.body)
            self._not_called()
        except LeavingPython as leaving:
            if leaving.kind != "end":
                raise InputError(
                    f"this is no Python: {leaving.kind!r} stands alone", self.file, "mend it"
                ) from None

    def _not_called(self) -> None:
        """Evaluate the one function that shapes a model and that nothing called."""
        calls = {name: {one for one, _ in called(node)} for name, node in self.functions.items()}
        shaping = [name for name in self.functions if self.shaping(self.functions[name])]
        roots = [
            name
            for name in shaping
            if not any(name in calls[other] for other in self.functions if other != name)
        ]
        if self.begun & set(shaping) or not roots:
            return
        first = self.functions[roots[0]]
        if self.host.built():
            for name in roots:
                self.assumed.append(
                    (f"function {name}, which nothing calls, is left out",
                     self.where(self.functions[name]))
                )  # fmt: skip
            return
        if len(roots) > 1 or required(first):
            names = ", ".join(f"{name} (line {self.functions[name].lineno})" for name in roots)
            raise InputError(
                f"nothing calls what builds the model: {names}",
                self.where(first),
                "add the call to the script",
            )
        self.assumed.append(
            (f"function {roots[0]}, which nothing calls, was taken as called", self.where(first))
        )
        self.call_function(self.everywhere[roots[0]], [], {})

    def _each(self, statements: Sequence[ast.stmt]) -> None:
        for place, statement in enumerate(statements):
            if self.leaving is not None:
                return self.pass_over(statements[place:], self.leaving[1])
            self.steps.take(self.where(statement))
            do = DOING.get(type(statement))
            if do is None:
                self.pass_over([statement], not_known(type(statement).__name__))
            else:
                do(self, statement)
        return None

    def call_function(self, function: Function, values: list[Any], named: dict[str, Any]) -> Any:
        node = function.node
        name = getattr(node, "name", "lambda")
        if self.depth >= DEEPEST:
            raise InputError(f"{name} calls itself too often", self.where(node), "write its result")
        self.begun.add(name)
        names = [one.arg for one in (*node.args.posonlyargs, *node.args.args)]
        frame: dict[str, Any] = {**function.defaults, **dict(zip(names, values, strict=False))}
        frame |= named
        if node.args.vararg:
            frame[node.args.vararg.arg] = tuple(values[len(names) :])
        if any(isinstance(one, ast.Yield | ast.YieldFrom) for one in ast.walk(node)):
            if self.shaping(node):
                self.refuse(node, f"function {name} changes the model item by item (yield)")
            return not_known(name)
        for missing in [one for one in names if one not in frame]:
            frame[missing] = Unknown(f"{missing} of {name}, which is not given")
        here, self.names, self.depth = self.names, frame, self.depth + 1
        shared, self.shared = self.shared, set()
        try:
            if isinstance(node, ast.Lambda):
                return self.value(node.body)
            self._each(node.body)
            if self.leaving is not None:
                return self.leaving[1]
        except LeavingPython as leaving:
            if leaving.kind == "end":
                raise
            return leaving.value
        finally:
            self.leaving = None
            for one in self.shared & frame.keys():
                self.everywhere[one] = frame[one]
            self.names, self.depth, self.shared = here, self.depth - 1, shared
        return None

    def imports(self, node: ast.Import) -> None:
        for one in node.names:
            found = self._module(one.name, node)
            if one.asname is None and "." in one.name:
                root, _, rest = one.name.partition(".")
                found = OpenedNames(root, {rest: found})
            self.names[one.asname or one.name.partition(".")[0]] = found

    def imports_from(self, node: ast.ImportFrom) -> None:
        name = node.module or ""
        module = self._module(name, node)
        for one in node.names:
            if one.name == "*":
                self.libraries.append(module)
                if isinstance(module, OpenedNames):
                    self.names |= module.names
            else:
                found = module.attribute(one.name)
                if isinstance(found, Anything):
                    found = self.modules.get(f"{name}.{one.name}", found)
                self.names[one.asname or one.name] = found

    def _module(self, name: str, node: ast.AST) -> Opened:
        known = self.modules.get(name)
        if known is not None:
            return known
        if name.partition(".")[0] in self.host.without or name in self.host.without:
            return Anything(name)
        trust = trust_of_module(name)
        if trust == "foreign" and self.host.shared:
            self.refuse(
                node, f"the module {name!r} is not read, and may change the model when imported"
            )
        return Anything(name, trust)

    def assign(self, node: ast.Assign) -> None:
        value = self.value(node.value)
        for target in node.targets:
            self.bind(target, value)

    def assign_typed(self, node: ast.AnnAssign) -> None:
        if node.value is not None:
            self.bind(node.target, self.value(node.value))

    def add_to(self, node: ast.AugAssign) -> None:
        loaded: Any = ast.copy_location(ast.parse(ast.unparse(node.target), mode="eval").body, node)
        left, right = self.value(ast.fix_missing_locations(loaded)), self.value(node.value)
        for one in (left, right):
            if isinstance(one, Unknown):
                return self.bind(node.target, one)
        if isinstance(left, list) and isinstance(node.op, ast.Add):
            left.extend(self._items(node, right))
            return None
        if isinstance(left, np.ndarray):
            found = self.tried(node, two, type(node.op), left, right)
            if isinstance(found, Unknown):
                return self.bind(node.target, found)
            # An array is changed where it is, also under its other names.
            self.tried(node, np.copyto, left, found, casting="same_kind")
            return None
        return self.bind(node.target, self.tried(node, two, type(node.op), left, right))

    def choose(self, node: ast.If) -> None:
        condition = self.value(node.test)
        if isinstance(condition, Unknown):
            self.pass_over([*node.body, *node.orelse], condition)
        else:
            self._each(node.body if self.tried(node.test, bool, condition) else node.orelse)

    def go_through(self, node: ast.For) -> None:
        items = self.items(node.iter)
        if isinstance(items, Unknown):
            self.bind(node.target, items)
            return self.pass_over([*node.body, *node.orelse], items)
        for item in items:
            self.steps.take(self.where(node))
            self.bind(node.target, item)
            if not self._turn(node.body):
                return None
        return self._each(node.orelse) if self.leaving is None else None

    def repeat(self, node: ast.While) -> None:
        while True:
            condition = self.value(node.test)
            if isinstance(condition, Unknown):
                return self.pass_over([*node.body, *node.orelse], condition)
            if not condition or not self._turn(node.body):
                return None

    def _turn(self, body: Sequence[ast.stmt]) -> bool:
        """One turn of a loop; whether there may be another."""
        try:
            self._each(body)
            if self.leaving is not None:
                kind, why = self.leaving
                if kind == "continue":
                    self.leaving = None
                    return True
                # Whether there are more turns is not known: they may change nothing.
                self.pass_over(body, why)
                self.leaving = self.leaving if kind == "return" else None
                return False
        except LeavingPython as leaving:
            if leaving.kind in ("return", "end"):
                raise
            return leaving.kind == "continue"
        return True

    def define(self, node: ast.FunctionDef) -> None:
        plain = node.args.args
        values = [self.value(one) for one in node.args.defaults]
        names = [one.arg for one in plain[len(plain) - len(values) :]]
        defaults = dict(zip(names, values, strict=True))
        for one, default in zip(node.args.kwonlyargs, node.args.kw_defaults, strict=True):
            if default is not None:
                defaults[one.arg] = self.value(default)
        self.functions[node.name] = node
        self.names[node.name] = Function(node, defaults)
        for decorator in node.decorator_list:
            made = self.value(decorator)
            known = isinstance(made, Anything | Unknown) and made.trust in ("shows", "computes")
            if not known and self.shaping(node):
                self.refuse(decorator, f"what {ast.unparse(decorator)[:40]!r} makes of a function")

    def delete(self, node: ast.Delete) -> None:
        for target in node.targets:
            if isinstance(target, ast.Name):
                self.names.pop(target.id, None)
            elif isinstance(target, ast.Attribute | ast.Subscript):
                owner = self.value(target.value)
                if self.reaches(owner) and isinstance(owner, Opened | Unknown):
                    self.refuse(target, f"{ast.unparse(target)[:60]!r} of the model is deleted")
                elif isinstance(target, ast.Subscript) and isinstance(owner, list | dict):
                    place = self.value(target.slice)
                    if isinstance(place, Unknown):
                        spoil(owner, place)
                    else:
                        self.tried(target, owner.__delitem__, place)

    def attempt(self, node: ast.Try) -> None:
        self._each([*node.body, *node.orelse, *node.finalbody])

    def fail(self, node: ast.Raise) -> None:
        raise InputError("the script ends with an error of its own", self.where(node), "mend it")

    def leave(self, node: ast.Return) -> None:
        raise LeavingPython("return", None if node.value is None else self.value(node.value))


def _leave(kind: str) -> Callable[[PythonInterpreter, Any], None]:
    def leave(interpreter: PythonInterpreter, node: Any) -> None:
        raise LeavingPython(kind)

    return leave


def _class(interpreter: PythonInterpreter, node: ast.ClassDef) -> None:
    """A class is not evaluated; where it may change the model its name is taken as a part of it."""
    changes = interpreter.shaping(node)
    changes |= any(interpreter.reaches(interpreter.value(base)) for base in node.bases)
    for statement in node.body:
        if not isinstance(statement, ast.FunctionDef) and interpreter.shaping(statement):
            interpreter.refuse(statement, f"class {node.name} changes the model where it stands")
    interpreter.names[node.name] = Anything(node.name, "model" if changes else "computes")


def _global(interpreter: PythonInterpreter, node: ast.Global) -> None:
    """Names of the whole script in a function: they are set outside when it ends."""
    for name in node.names:
        if interpreter.names is not interpreter.everywhere:
            interpreter.shared.add(name)
            if name in interpreter.everywhere:
                interpreter.names.setdefault(name, interpreter.everywhere[name])


def _nonlocal(interpreter: PythonInterpreter, node: ast.Nonlocal) -> None:
    raise InputError(
        f"{', '.join(node.names)} of a function around it is set", interpreter.where(node),
        "give it as an argument, and return it",
    )  # fmt: skip


def _assert(interpreter: PythonInterpreter, node: ast.Assert) -> None:
    if interpreter.shaping(node):
        interpreter.value(node.test)


def _nothing(interpreter: PythonInterpreter, node: Any) -> None:
    pass


DOING: dict[type[ast.stmt], Callable[[PythonInterpreter, Any], None]] = {
    ast.Import: PythonInterpreter.imports,
    ast.ImportFrom: PythonInterpreter.imports_from,
    ast.Expr: lambda interpreter, node: interpreter.value(node.value),
    ast.Assign: PythonInterpreter.assign,
    ast.AnnAssign: PythonInterpreter.assign_typed,
    ast.AugAssign: PythonInterpreter.add_to,
    ast.If: PythonInterpreter.choose,
    ast.For: PythonInterpreter.go_through,
    ast.While: PythonInterpreter.repeat,
    ast.FunctionDef: PythonInterpreter.define,
    ast.Try: PythonInterpreter.attempt,
    ast.Raise: PythonInterpreter.fail,
    ast.Return: PythonInterpreter.leave,
    ast.Break: _leave("break"),
    ast.Continue: _leave("continue"),
    ast.ClassDef: _class,
    ast.Global: _global,
    ast.Assert: _assert,
    ast.Pass: _nothing,
    ast.Delete: PythonInterpreter.delete,
    ast.Nonlocal: _nonlocal,
}
