"""The table of the measurements."""

from itertools import groupby

from rga_bench.measurement import HEADINGS
from rga_bench.page import MarkdownPage
from rga_bench.solver.result import SolverResult
from rga_bench.text_table import TextTable

NOTES = """\
Times as good: of rates, ours over theirs; of times, theirs over ours.

CHOLMOD and splu fill the matrices of a batch by one product with a constant sparse matrix;
CHOLMOD keeps its symbolic analysis, splu its order. From scratch, CHOLMOD is handed the matrix,
and rga the structure. PyNite's model is built once, and its properties change.

Least factorisation: the squares of the entries in the columns of the factor, summed, in the order
of CHOLMOD's that makes the fewest. A kflop is a thousand floating-point operations."""


def page(result: SolverResult, command: str) -> MarkdownPage:
    """The table, and how it was measured."""
    return MarkdownPage(
        "solver.md",
        "What a simulated sample costs",
        f"`{command}` on {result.day}, on one core\n"
        "unless it says otherwise, after all solvers agreed.",
        _about(result),
        [_table(result), NOTES],
        {"solver.png": "times as good as the peers"},
    )


def _table(result: SolverResult) -> TextTable:
    rows = []
    for case, figures in groupby(result.figures, lambda one: one.case):
        rows.append([case])
        rows += [figure.cells() for figure in figures]
    return TextTable("", HEADINGS, rows)


def _about(result: SolverResult) -> list[str]:
    """The machine, its roofs, and what was measured, in lines."""
    machine, roofs = result.machine, result.roofs
    versions = [f"{name} {number or 'not installed'}" for name, number in result.versions.items()]
    return [
        f"{machine['processor']} with {', '.join(machine['instructions'])}",
        f"{machine['cores']} cores, {machine['memory_GiB']} GiB, {machine['system']}",
        f"dgemm of one core {roofs.arithmetic / 1e9:.3g} GFLOP/s",
        f"copy {roofs.copied / 1e9:.3g} GB/s, read {roofs.read / 1e9:.3g} GB/s",
        ", ".join(versions),
        f"seed {result.seed}",
    ]
