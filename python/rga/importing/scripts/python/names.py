"""What parts of a syntax tree name, call and set."""

import ast
from collections.abc import Iterator


def called(node: ast.AST) -> Iterator[tuple[str, ast.Call]]:
    """Names that a part of a script calls: of functions, and of attributes."""
    for one in ast.walk(node):
        if isinstance(one, ast.Call):
            if isinstance(one.func, ast.Name):
                yield one.func.id, one
            elif isinstance(one.func, ast.Attribute):
                yield one.func.attr, one


def assigned(node: ast.AST) -> Iterator[str]:
    """Names that a part of a script sets."""
    for one in ast.walk(node):
        if isinstance(one, ast.Name) and isinstance(one.ctx, ast.Store):
            yield one.id


def leaves(node: ast.AST, *, inner: bool = False) -> str:
    """What would leave a loop or function in a part of a script: its kind, or nothing.

    Args:
        inner: whether the part stands in a loop of its own, which `break` leaves.
    """
    if isinstance(node, ast.FunctionDef | ast.ClassDef | ast.Lambda):
        return ""
    if isinstance(node, ast.Return):
        return "return"
    if isinstance(node, ast.Break | ast.Continue) and not inner:
        return "break" if isinstance(node, ast.Break) else "continue"
    inner = inner or isinstance(node, ast.For | ast.While)
    kinds = {leaves(one, inner=inner) for one in ast.iter_child_nodes(node)}
    return next((kind for kind in ("return", "break", "continue") if kind in kinds), "")


def required(function: ast.FunctionDef) -> list[str]:
    """Parameters of a function that have no default."""
    plain = [one.arg for one in (*function.args.posonlyargs, *function.args.args)]
    return plain[: len(plain) - len(function.args.defaults)] + [
        one.arg
        for one, default in zip(function.args.kwonlyargs, function.args.kw_defaults, strict=True)
        if default is None
    ]
