"""Modules and functions of Python that are not evaluated, and what they may do to a model."""

import builtins
import sys

from rga.importing.scripts.values import Trust

#: modules that show and store what they are given
SHOWING = frozenset((
    "IPython", "csv", "json", "logging", "matplotlib", "mpl_toolkits", "ops_vis", "opsvis",
    "pickle", "plotly", "pprint", "pylab", "pyvista", "reprlib", "rich", "seaborn", "tabulate",
    "vfo", "vtk", "warnings",
))  # fmt: skip
#: modules outside of Python's own that compute, and know no model
COMPUTING = frozenset((
    "PIL", "attr", "attrs", "cv2", "docx", "h5py", "joblib", "jupyter", "moviepy", "networkx",
    "numba", "numpy", "openpyxl", "pandas", "pint", "polars", "pytest", "requests", "scipy",
    "setuptools", "sklearn", "sympy", "torch", "tqdm", "typing_extensions", "xarray", "xlrd",
    "xlsxwriter", "xlwings", "yaml",
))  # fmt: skip
#: modules of Python's own that run other code
RUNNING = frozenset(("code", "codeop", "imp", "importlib", "runpy"))
#: built-in functions that run code, and those that change nothing of what they are given
RUNNING_CODE = frozenset(("__import__", "breakpoint", "compile", "eval", "exec"))
LOOKING = frozenset((
    "callable", "dir", "format", "hasattr", "hash", "help", "id", "input", "isinstance",
    "issubclass", "open", "print", "repr", "type",
))  # fmt: skip
#: calls that end a script
ENDING = frozenset(("exit", "quit", "sys.exit", "os._exit"))


def trust_of_module(name: str) -> Trust:
    """What the names of a module may do.

    >>> trust_of_module("matplotlib.pyplot"), trust_of_module("time"), trust_of_module("supports")
    ('shows', 'computes', 'foreign')
    """
    root = name.partition(".")[0]
    if root in SHOWING:
        return "shows"
    known = root in COMPUTING or (root in sys.stdlib_module_names and root not in RUNNING)
    return "computes" if known else "foreign"


def trust_of_built_in(name: str) -> Trust | None:
    """What a built-in function may do; None where there is none of this name."""
    if name in RUNNING_CODE:
        return "foreign"
    if name in LOOKING:
        return "shows"
    return "computes" if hasattr(builtins, name) or name in ENDING else None
