"""What the causes mean for the members: a table of force ratios, and a drawing."""

from collections.abc import Collection
from dataclasses import dataclass

import numpy as np
from markupsafe import Markup
from matplotlib.axes import Axes
from matplotlib.colors import Normalize
from matplotlib.figure import Figure

from rga.arrays import FloatArray
from rga.diagnosis.member_forces import IDLE, Forces
from rga.drawing.figure_style import STEEL, inline, style
from rga.drawing.label import label
from rga.drawing.projection import Projection, views
from rga.findings.phrases import kind_words
from rga.model.effect import Effect
from rga.model.schema import Model
from rga.quantities import DASH, fixed, number
from rga.report.drawing.bridge_drawing import KEY, TITLE, WIDTH, Shades, draw_supports, paint_scale
from rga.report.drawing.places import Named
from rga.report.figures.bridge import EITHER_WAY

#: change of a force below which a member is left out of the table, and how many are shown
WORTH_A_LINE, MOST_LINES = 0.005, 24
#: members named in a view, those whose force changes most
NAMED = 8
BELOW, ABOVE = 0.3, 0.3  # inches


@dataclass(frozen=True)
class ForceTable:
    """The table of forces.

    Attributes:
        columns: headings of the ratios.
        lines: member, its group, force as given and with the causes in the heaviest row [kN] and
            their ratio, then the ratios of amplitudes.
        left_out: number of members whose force hardly changes, or that are not shown.
    """

    columns: list[str]
    lines: list[list[str]]
    left_out: int


def force_table(forces: Forces, model: Model, named: Collection[str] = ()) -> ForceTable:
    """Members by the change of their force, the largest first; those with gauges are all there.

    Args:
        forces: with and without the causes.
        model: as it was given.
        named: members that causes name: they stand first, whatever their force does.
    """
    change = _change(forces)
    gauged = np.isfinite(forces.measured)
    order = np.argsort(-change, kind="stable")
    first = [k for k in order if forces.members[k] in named][:MOST_LINES]
    worth = [k for k in order if change[k] > WORTH_A_LINE * forces.amplitude.max()][:MOST_LINES]
    rest = [k for k in order if k not in first and (k in set(worth) or gauged[k])]
    shown = [*first, *rest]
    ratios = {"all causes": forces.ratio}
    if forces.credited is not None:
        ratios["without bearings' restraint"] = forces.credited
    ratios |= {f"without {label(name)}": values for name, values in forces.without.items()}
    if gauged.any():
        ratios["measured"] = forces.measured
    heaviest = float(np.abs(forces.given).max(initial=0.0))
    lines = []
    for k in shown:
        name = forces.members[k]
        given, extended = float(forces.given[k]), float(forces.extended[k])
        idle = abs(given) <= IDLE * heaviest
        row = [
            *(
                number(one / 1e3 if abs(one) > 1e-6 * heaviest else 0.0)
                for one in (given, extended)
            ),
            DASH if idle else _ratio(extended / given),
        ]
        groups = ", ".join(model.members[name].groups[:1])
        lines.append([name, groups, *row, *(_ratio(values[k]) for values in ratios.values())])
    return ForceTable(list(ratios), lines, len(forces.members) - len(shown))


def restraint_words(forces: Forces, kinds: list[str]) -> str:
    """What the restraint of bearings means for what may be credited; empty where there is none."""
    if forces.credited is None:
        return ""
    restraints = {kind for kind in kinds if Effect.vocabulary.get(kind, Effect).may_let_go}
    held = " and ".join(sorted(map(kind_words, restraints)))
    return (
        f"The restraint of a bearing ({held}) may let go at any time and is normally not credited: "
        "where it relieves a member, count the figure without it; where it adds force, count the "
        "figure with it."
    )


def draw_forces(forces: Forces, model: Model) -> Markup | None:
    """Every view of the bridge, members coloured by their force over what was calculated."""
    known = np.isfinite(forces.ratio)
    if not known.any():
        return None
    change = _change(forces)
    off = np.where(known, forces.ratio - 1, np.nan)
    weighty = known & (forces.amplitude > 0.05 * forces.amplitude.max())
    most = float(np.abs(off[weighty]).max(initial=0.0))
    top = next((step for step in (0.05, 0.1, 0.2, 0.5, 0.75) if most <= step), 1.0)
    shades = Shades(
        norm=Normalize(1 - top, 1 + top),
        colours=EITHER_WAY,
        text=_ratio,
        longest="0.88",
        words="force with the causes over force as calculated  (grey: no change)",
    )
    drawn = views(model, {forces.members[k] for k in np.argsort(-change)[:NAMED]})
    room = WIDTH - 0.5
    units = [_unit(model, view, room - 0.9) for view in drawn]
    heights = [
        TITLE + BELOW + ABOVE + _box(model, view)[3] / unit
        for view, unit in zip(drawn, units, strict=True)
    ]
    high = sum(heights) + KEY
    with style():
        figure = Figure(figsize=(WIDTH, high))
        reached = high
        for view, unit, height in zip(drawn, units, heights, strict=True):
            x, y, _, _ = _box(model, view)
            axes = figure.add_axes(
                (0.25 / WIDTH, (reached - height) / high, room / WIDTH, (height - TITLE) / high)
            )
            axes.set_axis_off()
            axes.set_xlim(x - 0.45 * unit, x + (room - 0.45) * unit)
            axes.set_ylim(y - BELOW * unit, y + (height - TITLE - BELOW) * unit)
            _members(axes, view, model, forces, change, shades, unit)
            figure.text(
                0.25 / WIDTH, (reached - 0.12) / high, view.title, fontsize=9, va="top",
                weight="bold",
            )  # fmt: skip
            reached -= height
        paint_scale(figure.add_axes((0.045, 0.55 * KEY / high, 0.34, 0.16 * KEY / high)), shades)
        names = [label(forces.members[k]) for k in np.argsort(-change)[:3]]
        words = f"Forces with the causes over those calculated; most change: {', '.join(names)}."
        return inline(figure, "forces", words)


def _members(
    axes: Axes, view: Projection, model: Model, forces: Forces, change: FloatArray, shades: Shades,
    unit: float,
) -> None:  # fmt: skip
    ratio = dict(zip(forces.members, forces.ratio, strict=True))
    size = dict(zip(forces.members, change, strict=True))
    chosen = sorted(view.members, key=lambda name: -size[name])[:NAMED]
    worth = WORTH_A_LINE * forces.amplitude.max()
    for name in view.members:
        ends = [model.nodes[node] for node in model.members[name].nodes]
        x, y = ([end[axis] for end in ends] for axis in view.axes)
        idle = np.isnan(ratio[name])
        look = (STEEL, 0.8, 1) if idle else (shades.colour(ratio[name]), 3.0, 2)
        axes.plot(x, y, color=look[0], linewidth=look[1], zorder=look[2])
        if name in chosen and size[name] > worth:
            axes.text(
                sum(x) / 2, sum(y) / 2, _ratio(ratio[name]), fontsize=6.6, ha="center",
                va="center", zorder=6,
                bbox={"facecolor": "white", "alpha": 0.85, "edgecolor": "none", "pad": 0.6},
            )  # fmt: skip
    draw_supports(axes, view, model, Named(frozenset(), frozenset()), unit)


def _change(forces: Forces) -> FloatArray:
    """Change of every member's amplitude [N]."""
    return np.abs(forces.changed - forces.amplitude)


def _ratio(value: float) -> str:
    """A ratio as text; "new" where the model as given calculates no force."""
    return fixed(float(value), 2) if np.isfinite(value) else "new" if value > 0 else DASH


def _box(model: Model, view: Projection) -> tuple[float, float, float, float]:
    """Left, bottom, width and height of a view [m]."""
    points = np.array([model.nodes[node] for node in sorted(view.nodes)])[:, list(view.axes)]
    low, size = points.min(axis=0), np.ptp(points, axis=0)
    return float(low[0]), float(low[1]), float(size[0]), float(size[1])


def _unit(model: Model, view: Projection, room: float) -> float:
    """Metres in an inch."""
    _, _, wide, high = _box(model, view)
    return max(wide, high / 0.6, 1e-9) / room
