"""The table of the measurements, for a terminal and in Markdown."""

from itertools import groupby

from rich.table import Table
from rich.text import Text

from rga_bench.measurement import HEADINGS
from rga_bench.solver.run import SolverResult

NOTES = """\
Times as good: of rates, ours over theirs; of times, theirs over ours.

CHOLMOD and splu fill the matrices of a batch by one product with a constant sparse matrix;
CHOLMOD keeps its symbolic analysis, splu its order. From scratch, CHOLMOD is handed the matrix,
and rga the structure. PyNite's model is built once, and its properties change.

Least factorisation: the squares of the entries in the columns of the factor, summed, in the order
of CHOLMOD's that makes the fewest. A kflop is a thousand floating-point operations."""


def terminal(result: SolverResult) -> Table:
    """For rich."""
    table = Table(*HEADINGS)
    for case, figures in groupby(result.figures, lambda one: one.case):
        table.add_section()
        table.add_row(Text(case, style="bold"))
        for figure in figures:
            table.add_row(*(Text(cell) for cell in figure.cells()))
    return table


def markdown(result: SolverResult, command: str) -> str:
    """A page: where and how it was measured, and the table."""
    lines = ["# What a simulated sample costs", ""]
    lines += [f"`{command}` on {result.day}, on one core"]
    lines += [
        "unless it says otherwise, after all solvers agreed.",
        "",
        *(f"- {line}" for line in about(result)),
        "",
    ]
    lines += [_row(HEADINGS), _row(["---"] * len(HEADINGS))]
    for case, figures in groupby(result.figures, lambda one: one.case):
        lines.append(_row([f"**{case}**", *[""] * (len(HEADINGS) - 1)]))
        lines += [_row(figure.cells()) for figure in figures]
    return "\n".join([*lines, "", NOTES, "", "![times as good as the peers](solver.png)", ""])


def about(result: SolverResult) -> list[str]:
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


def _row(cells: list[str] | tuple[str, ...]) -> str:
    return f"| {' | '.join(cells)} |"
