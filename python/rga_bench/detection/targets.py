"""Targets of the monitor."""

import math
from collections.abc import Sequence

from rga_bench.detection.detectors import MONITOR, WINDOW_RULE
from rga_bench.detection.optimum import OPTIMUM
from rga_bench.detection.rates import Delay
from rga_bench.detection.result import Alarms, Bounds, JudgedFigure, Seen

#: delay over the optimum's: required, and aimed at for one sensor and for more
OVER_OPTIMUM, ONE, MORE = 1.6, 1.2, 1.4
#: the window rule's delay over the monitor's: required and aimed at
SHORTER, MUCH_SHORTER = 30.0, 130.0
#: streams without an alarm in as many rows as there should be between alarms; 0.37 is right
QUIET: Bounds = (0.2, 0.6)
QUIET_AIM: Bounds = (0.3, 0.45)
#: part of the rows that should be between false alarms; so many fewer shorten a delay by 2 %
RARE = 0.8


def targets(arl0: float, alarms: Sequence[Alarms], delays: Sequence[Seen]) -> list[JudgedFigure]:
    """Figures that are there, each with its target.

    Args:
        arl0: rows that should be between false alarms.
        alarms: false alarms.
        delays: of every change.
    """
    rare = _rare(arl0, alarms)
    known = [one for one in delays if one.known and one.kind == "step"]
    places = dict.fromkeys((one.fault, one.size, one.count) for one in known)
    judged = []
    for fault, size, count in places:
        found = {
            one.detector: one.delay for one in known if (one.fault, one.count) == (fault, count)
        }
        words = f"{fault} in {count}"
        if MONITOR in found and OPTIMUM in found and size <= 2.0 and "sign" not in fault:
            judged.append(
                _ratio(
                    f"{words}: monitor's delay over the optimum's", found[MONITOR], found[OPTIMUM],
                    rare, (None, OVER_OPTIMUM), (None, ONE if count == 1 else MORE),
                )
            )  # fmt: skip
        if MONITOR in found and WINDOW_RULE in found and (size, count) == (1.0, 1):
            judged.append(
                _ratio(
                    f"{words}: window rule's delay over the monitor's",
                    found[WINDOW_RULE], found[MONITOR],
                    rare, (SHORTER, None), (MUCH_SHORTER, None),
                )
            )  # fmt: skip
    return judged + [
        JudgedFigure(
            f"{one.noise}, baseline estimated: monitor quiet as long as it should be",
            one.quiet.share, one.quiet.low, one.quiet.high, True, QUIET, QUIET_AIM,
        )
        for one in alarms
        if one.detector == MONITOR and not one.known
    ]  # fmt: skip


def _rare(arl0: float, alarms: Sequence[Alarms]) -> bool:
    """Whether false alarms of the monitor may be as rare as they should be."""
    highest = [one.arl0.high for one in alarms if one.detector == MONITOR and one.known]
    return all(high is None or high >= RARE * arl0 for high in highest)


def _ratio(
    name: str, over: Delay, under: Delay, rare: bool, least: Bounds, aim: Bounds
) -> JudgedFigure:
    """Of means; the interval adds the squares of both relative errors."""
    if over.mean is None or under.mean is None:
        return JudgedFigure(name, None, None, None, rare, least, aim)
    ratio = over.mean / under.mean
    error = math.exp(math.hypot(_relative(over), _relative(under)))
    return JudgedFigure(name, ratio, ratio / error, ratio * error, rare, least, aim)


def _relative(delay: Delay) -> float:
    if delay.mean is None or delay.low is None:
        return 0.0
    return (delay.mean - delay.low) / delay.mean
