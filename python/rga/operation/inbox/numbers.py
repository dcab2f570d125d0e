"""Which numbers of a stream have come, and which are missing."""

from bisect import bisect_right
from collections.abc import Iterable

#: gaps in the numbers of one stream
MOST_GAPS = 10_000


class Numbers:
    """The numbers of a stream that have come.

    Attributes:
        next: number after the highest that has come.
        gaps: first and last of the missing numbers below it, in order.

    >>> numbers = Numbers()
    >>> [numbers.take(one) for one in (0, 3, 3, 1)], numbers.gaps
    ([True, True, False, True], [(2, 2)])
    """

    def __init__(self, next: int = 0, gaps: Iterable[tuple[int, int]] = ()) -> None:
        self.next, self.gaps = next, list(gaps)

    @property
    def missing(self) -> int:
        """How many numbers below the highest have not come."""
        return sum(last - first + 1 for first, last in self.gaps)

    @property
    def whole(self) -> int:
        """Number below which all have come.

        >>> Numbers(5, [(2, 3)]).whole
        2
        """
        return self.gaps[0][0] if self.gaps else self.next

    def take(self, number: int) -> bool:
        """Take a number in; False: it has come before."""
        if number >= self.next:
            if number > self.next:
                self.gaps.append((self.next, number - 1))
            self.next = number + 1
            return True
        place = bisect_right(self.gaps, number, key=lambda gap: gap[0]) - 1
        if place < 0 or number > self.gaps[place][1]:
            return False
        first, last = self.gaps[place]
        parts = ((first, number - 1), (number + 1, last))
        self.gaps[place : place + 1] = [gap for gap in parts if gap[0] <= gap[1]]
        return True

    def takes(self, number: int) -> bool:
        """Whether a number leaves no more gaps than are kept of a stream."""
        return len(self.gaps) < MOST_GAPS or number <= self.next
