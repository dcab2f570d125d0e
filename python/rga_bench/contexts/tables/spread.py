"""Means over splits, with their intervals."""

from collections.abc import Sequence
from dataclasses import dataclass

import numpy as np
from scipy.stats import t

#: probability of the intervals
CONFIDENCE = 0.9


@dataclass(frozen=True)
class Mean:
    """A mean over splits.

    Attributes:
        value: of it.
        reach: half of its 90 % interval, by Student's distribution; None: there is one split.
    """

    value: float
    reach: float | None

    @classmethod
    def of(cls, values: Sequence[float]) -> "Mean":
        """Of a value or more, one from each split.

        >>> Mean.of([1.0, 2.0, 3.0]).reach.__round__(3)
        1.686
        """
        count = len(values)
        if count < 2:
            return cls(float(np.mean(values)), None)
        error = np.std(values, ddof=1) / np.sqrt(count)
        return cls(float(np.mean(values)), float(t.ppf((1 + CONFIDENCE) / 2, count - 1) * error))

    @property
    def sure(self) -> bool:
        """Whether the interval leaves out 0."""
        return self.reach is not None and abs(self.value) > self.reach

    def text(self, form: str) -> str:
        """In words, with a format of the numbers.

        >>> Mean(0.5, 0.021).text(".2f")
        '0.50 ± 0.02'
        """
        if self.reach is None:
            return format(self.value, form)
        return f"{self.value:{form}} ± {self.reach:{form.removeprefix('+')}}"
