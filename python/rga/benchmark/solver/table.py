"""The table of the measurements, for a terminal and in Markdown."""

from itertools import groupby

from rich.table import Table
from rich.text import Text

from rga.benchmark.figure import Figure
from rga.benchmark.solver.run import Result

HEADINGS = ("what", "measured", "beside", "there", "times as good", "at least")
NOTES = """\
Times as good: of rates, ours over theirs; of times, theirs over ours.

CHOLMOD and splu fill the matrices of a batch by one product with a constant sparse matrix;
CHOLMOD keeps its symbolic analysis, splu its order. From scratch, CHOLMOD is handed the matrix,
and rga the structure. PyNite's model is built once, and its properties change.

Least factorisation: the squares of the entries in the columns of the factor, summed, in the order
of CHOLMOD's that makes the fewest. A kflop is a thousand floating-point operations."""


def terminal(result: Result) -> Table:
    """For rich."""
    table = Table(*HEADINGS)
    for case, figures in groupby(result.figures, lambda one: one.case):
        table.add_section()
        table.add_row(Text(case, style="bold"))
        for figure in figures:
            table.add_row(*(Text(cell) for cell in _cells(figure)))
    return table


def markdown(result: Result, command: str) -> str:
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
        lines += [_row(_cells(figure)) for figure in figures]
    return "\n".join([*lines, "", NOTES, "", "![times as good as the peers](solver.png)", ""])


def about(result: Result) -> list[str]:
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


def _cells(figure: Figure) -> list[str]:
    cells = [figure.name, _value(figure.value, figure.unit), figure.peer or ""]
    if figure.peer is None:
        cells.append("")
    elif figure.peer_value is None:
        cells.append("not installed")
    else:
        cells.append(_value(figure.peer_value, figure.unit))
    cells.append("" if figure.ratio is None else digits(figure.ratio))
    if figure.least is None:
        return [*cells, ""]
    mark = "" if figure.ratio is None else " ✓" if figure.ratio >= figure.least else " ✗"
    return [*cells, f"{figure.least:.2g}{mark}"]


def _value(value: float, unit: str) -> str:
    """Three digits, and a unit that suits them."""
    if unit == "/s":
        big, name = (1e6, " million") if value >= 1e6 else (1.0, "")
        return f"{digits(value / big)}{name}/s"
    if unit == "s":
        scale, name = next(
            (scale, name)
            for scale, name in ((1.0, "s"), (1e3, "ms"), (1e6, "us"))
            if value * scale >= 1.0 or name == "us"
        )
        return f"{digits(value * scale)} {name}"
    return f"{digits(value)} {unit}".rstrip()


def digits(value: float) -> str:
    """Three of them."""
    if value >= 1e3:
        rounded = float(f"{value:.3g}")
        return f"{rounded:,.0f}".replace(",", " ")
    return f"{value:.3g}"
