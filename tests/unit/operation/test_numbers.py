"""Numbers of a stream: what has come, and what is missing."""

from hypothesis import given
from hypothesis import strategies as st

from rga.operation.inbox.numbers import MOST_GAPS, Numbers


@given(st.lists(st.integers(0, 30)))
def test_numbers_are_those_of_a_set(sent: list[int]) -> None:
    numbers, known = Numbers(), set[int]()
    for one in sent:
        assert numbers.take(one) == (one not in known)
        known.add(one)
        missing = set(range(max(known))) - known
        assert {n for first, last in numbers.gaps for n in range(first, last + 1)} == missing
        assert numbers.missing == len(missing)
        assert numbers.whole == min(missing, default=max(known) + 1)
        assert numbers.gaps == sorted(numbers.gaps)


def test_no_more_gaps_are_kept_than_can_be() -> None:
    numbers = Numbers()
    for one in range(MOST_GAPS):
        assert numbers.takes(2 * one + 1)
        numbers.take(2 * one + 1)
    assert not numbers.takes(2 * MOST_GAPS + 1)
    # What goes on, or fills a gap, is taken still.
    assert numbers.takes(2 * MOST_GAPS)
    assert numbers.takes(4)
