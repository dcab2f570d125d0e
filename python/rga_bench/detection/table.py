"""The tables of the measurements."""

from collections.abc import Sequence
from itertools import groupby

from rga_bench.detection.optimum import OPTIMUM
from rga_bench.detection.rates import Arl0, Delay, Share
from rga_bench.detection.result import Bounds, DetectionResult, JudgedFigure, Seen
from rga_bench.detection.setting import BASELINE
from rga_bench.measurement import HEADINGS, digits
from rga_bench.page import MarkdownPage
from rga_bench.text_table import TextTable

NOTES = """\
Rows between alarms: watched rows over alarms, without a change. Quiet: share of streams without an
alarm in as many rows as there should be between alarms; 0.37 is right.

Delay: rows from the onset to the alarm, the row of the onset counted: mean, and how far its
90 % interval reaches above it. Runs with an alarm before the
onset are left out. "≥": some runs ended without an alarm.

Baseline estimated: the window rule and MEWMA keep their limits for known noise, and have the false
alarms that the first table shows.

Optimum: knows the change, its size and the number of sensors, but not which sensors nor when."""


def page(result: DetectionResult, command: str) -> MarkdownPage:
    """All tables, and where and how it was measured."""
    return MarkdownPage(
        "detector.md",
        "How soon a change is seen, at which rate of false alarms",
        f"`{command}` on {result.day}.",
        _about(result),
        [*_tables(result), NOTES],
        {"delays.png": "delays", "limits.png": "limits"},
    )


def _about(result: DetectionResult) -> list[str]:
    """The machine, and what was measured, in lines."""
    machine, setting = result.machine, result.setting
    versions = [f"{name} {number}" for name, number in result.versions.items() if number]
    return [
        f"{machine['processor']}, {machine['cores']} cores, {machine['system']}",
        ", ".join(versions),
        f"seed {setting.seed}; {setting.sensors} sensors",
        f"known noise: {setting.null} streams without a change, {setting.streams} to a delay",
        f"estimated: {setting.baselines} baselines of {BASELINE} rows, {setting.each} streams each",
        f"changes after {setting.onset} rows",
    ]


def _tables(result: DetectionResult) -> list[TextTable]:
    """All tables."""
    found = [
        _alarms(result),
        _delays(result, "Delay, noise known", [one for one in result.delays if one.known]),
        _delays(
            result, "Delay, baseline estimated", [one for one in result.delays if not one.known]
        ),
    ]
    if result.judged:
        found.append(_judged(result.judged))
    for case, figures in groupby(result.throughput, lambda one: one.case):
        found.append(TextTable(case, HEADINGS, [one.cells() for one in figures]))
    return found


def _alarms(result: DetectionResult) -> TextTable:
    headings = ["detector", "limit", "noise", "baseline", "rows between alarms", "quiet"]
    rows = [
        [
            one.detector,
            "" if one.limit is None else f"{one.limit:.4g}",
            one.noise,
            "known" if one.known else "estimated",
            _arl0(one.arl0),
            _share(one.quiet),
        ]
        for one in result.alarms
    ]
    wanted = digits(result.setting.arl0)
    return TextTable(f"False alarms; there should be {wanted} rows between them", headings, rows)


def _delays(result: DetectionResult, title: str, seen: Sequence[Seen]) -> TextTable:
    detectors = list(dict.fromkeys(one.detector for one in seen))
    detectors.sort(key=OPTIMUM.__eq__)  # the optimum last
    cells = {(one.fault, one.count, one.detector): _delay(one.delay) for one in seen}
    places = dict.fromkeys((one.fault, one.count) for one in seen)
    rows = [
        [fault, str(count), *(cells.get((fault, count, name), "") for name in detectors)]
        for fault, count in places
    ]
    left_out = {one.detector: one.delay.left_out for one in seen}
    runs = {one.detector: one.delay.left_out + one.delay.runs for one in seen}
    rows.append(["left out", "", *(f"{left_out[one]} of {runs[one]}" for one in detectors)])
    return TextTable(title, ["change", "sensors", *detectors], rows)


def _judged(judged: Sequence[JudgedFigure]) -> TextTable:
    rows = [
        [
            one.name,
            "" if one.value is None else digits(one.value),
            _interval(one.low, one.high),
            _bounds(one.least),
            _bounds(one.aim),
            one.verdict,
        ]
        for one in judged
    ]
    return TextTable("Targets", ["figure", "found", "90 %", "least", "aim", ""], rows)


def _arl0(one: Arl0) -> str:
    if one.rows is None:
        return f"no alarm in {digits(one.watched)}"
    return f"{digits(one.rows)} ({_interval(one.low, one.high)})"


def _share(one: Share) -> str:
    return f"{one.share:.2f} ({one.low:.2f} to {one.high:.2f})"


def _delay(one: Delay) -> str:
    if one.mean is None:
        return "none left"
    reach = "" if one.high is None else f" ± {digits(one.high - one.mean)}"
    return f"{'≥ ' if one.capped else ''}{digits(one.mean)}{reach}"


def _interval(low: float | None, high: float | None) -> str:
    bounds = ["?" if one is None else digits(one) for one in (low, high)]
    return f"{bounds[0]} to {bounds[1]}"


def _bounds(bounds: Bounds) -> str:
    low, high = bounds
    if low is None:
        return f"≤ {high:g}"
    return f"≥ {low:g}" if high is None else f"{low:g} to {high:g}"
