"""What is asked of the monitor."""

import math
from collections.abc import Sequence

from rga.benchmark.detector.detectors import MONITOR, WINDOW_RULE
from rga.benchmark.detector.optimum import OPTIMUM
from rga.benchmark.detector.rates import Delay
from rga.benchmark.detector.result import Alarms, Bounds, Judged, Seen

#: delay over the optimum's: asked for, and aimed at for one sensor and for more
OVER_OPTIMUM, ONE, MORE = 1.6, 1.2, 1.4
#: the window rule's delay over the monitor's: asked for and aimed at
SHORTER, MUCH_SHORTER = 30.0, 130.0
#: streams without an alarm in as many rows as there should be between alarms; 0.37 is right
QUIET: Bounds = (0.2, 0.6)
QUIET_AIM: Bounds = (0.3, 0.45)


def targets(alarms: Sequence[Alarms], delays: Sequence[Seen]) -> list[Judged]:
    """All that is asked, of figures that are there."""
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
                    (None, OVER_OPTIMUM), (None, ONE if count == 1 else MORE),
                )
            )  # fmt: skip
        if MONITOR in found and WINDOW_RULE in found and (size, count) == (1.0, 1):
            judged.append(
                _ratio(
                    f"{words}: window rule's delay over the monitor's",
                    found[WINDOW_RULE], found[MONITOR],
                    (SHORTER, None), (MUCH_SHORTER, None),
                )
            )  # fmt: skip
    return judged + [
        Judged(
            f"{one.noise}, baseline estimated: monitor quiet as long as it should be",
            one.quiet.share, one.quiet.low, one.quiet.high, QUIET, QUIET_AIM,
        )
        for one in alarms
        if one.detector == MONITOR and not one.known
    ]  # fmt: skip


def _ratio(name: str, over: Delay, under: Delay, least: Bounds, aim: Bounds) -> Judged:
    """Of means; the interval adds the squares of both relative errors."""
    if over.mean is None or under.mean is None:
        return Judged(name, None, None, None, least, aim)
    ratio = over.mean / under.mean
    error = math.exp(math.hypot(_relative(over), _relative(under)))
    return Judged(name, ratio, ratio / error, ratio * error, least, aim)


def _relative(delay: Delay) -> float:
    if delay.mean is None or delay.low is None:
        return 0.0
    return (delay.mean - delay.low) / delay.mean
