"""Clocks of loggers: what is believed, what is refused aside, and that it is told once."""

import pytest

from rga.operation.packets.packet import MICROSECONDS, Number
from rga.operation.sources.clock import ClockRule, ClockSight, ClockWatch

NOON = 1_795_435_200_000_000
MINUTE, HOUR = 60 * MICROSECONDS, 3600 * MICROSECONDS


def sight(place: str, number: Number | None, first: int, last: int, arrived: int) -> ClockSight:
    return ClockSight(place, frozenset(["D1"]), number, first, last, arrived)


class Logger:
    """A logger that sends a packet a minute, by a clock that is set.

    Args:
        numbered: whether it counts its packets.
    """

    def __init__(self, numbered: bool) -> None:
        self.watch = ClockWatch(ClockRule())
        self._numbered, self._count = numbered, 0
        self.now = NOON

    def send(self, minutes: int, ahead: int = 0, stuck: int | None = None) -> list[str | None]:
        """Why each of the packets of so many minutes is not believed."""
        return [self._packet(ahead if stuck is None else stuck - self.now) for _ in range(minutes)]

    def _packet(self, ahead: int) -> str | None:
        self.now += MINUTE
        self._count += 1
        number = Number("s", self._count) if self._numbered else None
        moment = self.now + ahead
        return self.watch.refused(sight("site", number, moment, moment, self.now))


@pytest.fixture(params=[True, False], ids=["numbered", "plain"])
def logger(request: pytest.FixtureRequest) -> Logger:
    return Logger(request.param)


def test_a_clock_that_is_right_is_believed(logger: Logger) -> None:
    assert set(logger.send(200) + logger.send(60, ahead=-20 * MINUTE)) >= {None}
    assert logger.send(60, ahead=20 * MINUTE) == [None] * 60
    assert logger.watch.fault is None


def test_a_clock_that_jumps_ahead_is_refused_until_it_is_set(logger: Logger) -> None:
    logger.send(10)
    assert logger.send(100, ahead=2 * HOUR) == ["its clock is 2 h ahead"] * 100
    assert logger.watch.fault == "site: its clock is 2 h ahead"
    assert logger.send(10) == [None] * 10
    assert logger.watch.fault is None


def test_a_clock_that_jumps_back_is_believed_when_it_is_past_what_it_showed(
    logger: Logger,
) -> None:
    logger.send(10)
    back = logger.send(119, ahead=-2 * HOUR)
    # Where packets have no numbers, the first may be one that was on its way for long.
    assert all(one is not None and "run back" in one for one in back[1:])
    told = logger.watch.fault
    assert told is not None
    assert logger.send(1, ahead=-2 * HOUR) != [None]
    # What comes now was never shown before: it is believed, and told to be old.
    logger.send(1, ahead=-2 * HOUR)
    assert logger.send(30, ahead=-2 * HOUR) == [None] * 30
    assert logger.watch.fault == (
        "site: its readings are 2 h old: it was away, or its clock is behind"
    )


def test_a_clock_that_stands_is_refused(logger: Logger) -> None:
    logger.send(10)
    stuck = logger.send(60, stuck=logger.now)
    # The second may have been on its way for a minute.
    assert stuck[:2] == [None, None]
    assert set(stuck[2:]) == {"its clock stands"}
    assert logger.watch.fault == "site: its clock stands"


def test_1970_is_refused(logger: Logger) -> None:
    refused = logger.send(60, ahead=-NOON)
    assert all(one is not None and one.endswith("years old") for one in refused)
    # In the words in which it was told first, however old they are by now.
    assert logger.watch.fault == f"site: {refused[0]}"
    assert logger.send(1) == [None]


def test_what_was_kept_while_the_network_was_away_is_believed(logger: Logger) -> None:
    logger.send(10)
    last = logger.now
    logger.now += 5 * HOUR
    moments = range(last + MINUTE, logger.now, MINUTE)
    for k, moment in enumerate(moments, 100):
        number = Number("s", k) if logger._numbered else None
        assert logger.watch.refused(sight("site", number, moment, moment, logger.now)) is None
    logger._count = 1000
    assert logger.watch.fault is None
    assert logger.send(10) == [None] * 10


def test_the_first_packet_is_believed_when_it_is_older(logger: Logger) -> None:
    assert logger.send(1, ahead=-5 * HOUR) == [None]
    assert "5 h old" in str(logger.watch.fault)


def test_what_fills_a_gap_is_believed() -> None:
    watch = ClockWatch(ClockRule())
    for number, moment in ((0, NOON), (9, NOON + HOUR), (5, NOON + MINUTE), (6, NOON)):
        assert watch.refused(sight("a", Number("s", number), moment, moment, NOON + HOUR)) is None


def test_disorder_on_the_way_is_no_clock_that_runs_back() -> None:
    watch = ClockWatch(ClockRule())
    late = MINUTE
    for k in range(0, 600, 2):
        for moment in (NOON + k * MICROSECONDS, NOON + k * MICROSECONDS - late):
            assert watch.refused(sight("a", None, moment, moment, NOON + k * MICROSECONDS)) is None


def test_loggers_are_told_apart_and_forgotten(monkeypatch: pytest.MonkeyPatch) -> None:
    watch = ClockWatch(ClockRule())
    for name in "abc":
        watch.refused(sight(name, None, NOON + 2 * HOUR, NOON + 2 * HOUR, NOON))
    assert watch.fault == "a: its clock is 2 h ahead, and 2 more of the loggers"
    watch.refused(sight("b", None, NOON, NOON, NOON))
    assert watch.fault == "a: its clock is 2 h ahead, and 1 more of the loggers"
    # Of what was not heard of for long, nothing is known.
    watch.refused(sight("b", None, NOON + HOUR, NOON + HOUR, NOON + HOUR))
    assert watch.fault is None
    monkeypatch.setattr("rga.operation.sources.clock.MOST_STREAMS", 2)
    for k in range(10):
        watch.refused(sight(str(k), None, NOON, NOON, NOON))
    assert len(watch._shown) == 2


def test_what_is_not_kept_comes_again_and_is_believed(logger: Logger) -> None:
    logger.send(5)
    logger.watch.keep()
    numbers = [Number("s", k) if logger._numbered else None for k in (6, 7, 8)]
    for minutes in range(30):
        # The disk is full, and the same packets are tried again.
        arrived = logger.now + 3 * MINUTE + minutes * MINUTE
        for k, number in enumerate(numbers, 1):
            moment = logger.now + k * MINUTE
            assert logger.watch.refused(sight("site", number, moment, moment, arrived)) is None
        logger.watch.undo()


def test_loggers_that_send_other_channels_have_clocks_of_their_own() -> None:
    watch = ClockWatch(ClockRule())
    for k in range(60):
        now = NOON + k * 10 * MINUTE
        for channel, behind in (("D1", 0), ("D2", 9 * MINUTE)):
            moment, late = now - behind, now + behind // 2
            shown = ClockSight("http", frozenset([channel]), None, moment, moment, late)
            assert watch.refused(shown) is None
