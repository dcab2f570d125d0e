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


def required(function: ast.FunctionDef) -> list[str]:
    """Parameters of a function that have no default."""
    plain = [one.arg for one in (*function.args.posonlyargs, *function.args.args)]
    return plain[: len(plain) - len(function.args.defaults)] + [
        one.arg
        for one, default in zip(function.args.kwonlyargs, function.args.kw_defaults, strict=True)
        if default is None
    ]
