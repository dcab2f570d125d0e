"""When the twin is brought into sync again: on an alarm, by the clock, by both, or as it paid."""

from dataclasses import dataclass
from typing import Self

import numpy as np

from rga.twin.run_state import Standing
from rga.twin.settings import Pace, Settings

#: an adaptive interval stays within this factor of the one that it began with, either way
REACH = 4.0
#: and changes by this factor at most from one recalibration to the next
STEP = 2.0


@dataclass(frozen=True)
class Policy:
    """When a recalibration is begun (the four categories of Alghamdi et al., 2024).

    An alarm first gathers rows under the new conditions. A clock that runs out meanwhile does not
    wait for them, and the alarm still has its recalibration when they are there.

    Attributes:
        alarms: an alarm begins one.
        clock: one is begun when the interval has passed since the last.
        adapts: the interval follows what recalibrations were worth.
        settle: rows that a recalibration learns from at the least.
        interval: that the clock begins with, in rows.
    """

    alarms: bool
    clock: bool
    adapts: bool
    settle: int
    interval: int

    @classmethod
    def of(cls, settings: Settings, pace: Pace) -> Self:
        """The policy that settings ask for; on level A nothing begins a recalibration."""
        kind, kept = settings.policy, settings.level != "A"
        return cls(
            alarms=kept and kind != "time",
            clock=kept and kind != "event",
            adapts=kind == "adaptive",
            settle=pace.settle,
            interval=pace.interval,
        )

    def due(self, standing: Standing) -> int | None:
        """First of the rows that a recalibration is to be about now; None: none is due."""
        row = standing.row
        if self.alarms and standing.alarm is not None and not self.waits(standing):
            return standing.since
        if self.clock and row - standing.synchronised >= standing.interval:
            return max(0, min(standing.synchronised, row - self.settle))
        return None

    def waits(self, standing: Standing) -> bool:
        """Whether an alarm is gathering rows for a recalibration of its own."""
        if not self.alarms or standing.alarm is None:
            return False
        return not standing.ended and standing.row - standing.alarm < self.settle

    def next_interval(self, interval: int, gain: float, allowed: float) -> int:
        """The interval after a recalibration.

        A twin that drifts away at a steady rate has a squared gap that grows with the square of
        time. The interval h after which a recalibration takes off no more than what is allowed is
        then h sqrt(allowed / gain), as a step size is chosen from the error of the step before
        (Hairer, Norsett and Wanner, Solving Ordinary Differential Equations I, section II.4).

        Args:
            interval: before it, in rows.
            gain: what it took off the gap, as a multiple of the gap to expect [-].
            allowed: what may stay beyond the gap to expect, as a multiple of that [-].

        >>> policy = Policy.of(Settings(policy="adaptive"), Settings().pace(480))
        >>> [policy.next_interval(80, gain, 0.8) for gain in (0.0, 0.8, 1.6, 100.0)]
        [160, 80, 57, 40]
        >>> policy.next_interval(320, 0.0, 0.8)
        320
        """
        if not self.adapts:
            return interval
        factor = np.sqrt(allowed / gain) if gain > 0 else STEP
        wanted = interval * float(np.clip(factor, 1 / STEP, STEP))
        return round(float(np.clip(wanted, max(1, self.interval / REACH), self.interval * REACH)))
