"""The code that a task depends on: the files of rga and its benchmarks that its module imports.

Imports are read from the syntax of the files, wherever they stand, so that those within functions
count too, and nothing has to be run for it. What only type checkers see does not count. A name
that a package opens on first use (`rga.lazy`) leads to the module that has it where it is imported
by name; `import rga` alone leads to the front of the package, as for the import contracts. A
package that walks through its own modules (`pkgutil`) opens them all.
"""

import ast
import hashlib
from collections import deque
from collections.abc import Iterator
from importlib.machinery import PathFinder
from importlib.util import resolve_name
from pathlib import Path

#: that are looked into; others count by their versions
PACKAGES = ("rga", "rga_bench")
#: of these packages
ROOT = Path(__file__).parents[1]
#: parts of a file in which statements stand
STATEMENTS = (ast.stmt, ast.excepthandler, ast.match_case)
#: what a package imports that opens all modules within it
WALK = "pkgutil.walk_packages"


def code_hash(module: str, root: Path = ROOT) -> str:
    """Hash of all files that a module depends on, its own and the compiled core among them."""
    content = hashlib.sha256()
    for path in sorted(imported_files(module, root)):
        content.update(path.relative_to(root).as_posix().encode() + path.read_bytes())
    return content.hexdigest()[:16]


def imported_files(module: str, root: Path = ROOT) -> set[Path]:
    """Files of `PACKAGES` that are, or may be, opened when a module is imported and its code runs.

    Args:
        module: its full name.
        root: folder of the packages.
    """
    found: dict[str, Path] = {}
    homes: dict[str, str] = {}
    waiting = deque([module])
    while waiting:
        name = waiting.popleft()
        if name in found or name.partition(".")[0] not in PACKAGES:
            continue
        path = _file(name, root)
        if path is None:
            # A name in a module that was met before; where that opens it on first use, of another.
            waiting.append(homes.get(name, ""))
            continue
        found[name] = path
        parent = name.rpartition(".")[0]
        # A package is opened before what is in it.
        waiting.append(parent)
        if path.suffix == ".py":
            tree, is_package = ast.parse(path.read_bytes()), path.stem == "__init__"
            imports = list(_imports(tree, name if is_package else parent))
            waiting += imports
            if is_package:
                if WALK in imports:
                    waiting += _within(name, path.parent)
                homes |= {f"{name}.{own}": home for own, home in _homes(tree)}
    return set(found.values())


def _file(name: str, root: Path) -> Path | None:
    """Of a module, a package or the compiled core; None where that is not what has the name."""
    folder = root.joinpath(*name.split(".")[:-1])
    found = PathFinder.find_spec(name, [str(folder)])
    return None if found is None or found.origin is None else Path(found.origin)


def _within(package: str, folder: Path) -> Iterator[str]:
    """Full names of all modules in the folder of a package and those below."""
    for path in folder.rglob("*.py"):
        if path.stem != "__init__":
            yield ".".join((package, *path.relative_to(folder).with_suffix("").parts))


def _imports(tree: ast.Module, package: str) -> Iterator[str]:
    """Full names of modules, each before those of what is taken from it."""
    waiting: list[ast.AST] = [tree]
    while waiting:
        node = waiting.pop()
        if isinstance(node, ast.Import):
            yield from (one.name for one in node.names)
        elif isinstance(node, ast.ImportFrom):
            module = resolve_name("." * node.level + (node.module or ""), package)
            yield module
            yield from (f"{module}.{one.name}" for one in node.names)
        elif isinstance(node, ast.If) and ast.unparse(node.test) == "TYPE_CHECKING":
            waiting += node.orelse
        else:
            waiting += (one for one in ast.iter_child_nodes(node) if isinstance(one, STATEMENTS))


def _homes(tree: ast.Module) -> Iterator[tuple[str, str]]:
    """Names that a package opens on first use, and modules that have them: a mapping of strings."""
    for node in ast.walk(tree):
        if isinstance(node, ast.Dict):
            for own, home in zip(node.keys, node.values, strict=True):
                if isinstance(own, ast.Constant) and isinstance(home, ast.Constant):
                    yield str(own.value), str(home.value)
