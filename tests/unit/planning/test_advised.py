"""What findings advise to measure, found again among what could be measured."""

from dataclasses import replace

from made_findings import cause, findings
from planned_bridge import EAST
from rga.experiments.measurement_model import MeasurementModel
from rga.planning.advised import advised


def numbers(bridge: MeasurementModel, *phrases: str) -> tuple[list[int], list[int]]:
    said = (cause(EAST, separated_by=f"against it: {one} tells them apart") for one in phrases)
    return advised(findings(*said), bridge.added, bridge.tests)


def test_sensors_and_tests_are_found_by_their_words(bridge: MeasurementModel) -> None:
    sensor, test = bridge.added[3].advice, bridge.tests[1].advice
    assert numbers(bridge, sensor) == ([3], [])
    assert numbers(bridge, test) == ([], [1])
    assert numbers(bridge, test, sensor, sensor) == ([3], [1])


def test_words_of_none_are_left_out(bridge: MeasurementModel) -> None:
    assert numbers(bridge, "measuring the moon", "") == ([], [])


def test_of_names_that_begin_alike_the_longer_is_meant(bridge: MeasurementModel) -> None:
    longest = {}
    for number, one in enumerate(bridge.added):
        longest[numbers(bridge, one.advice)[0][0]] = number
    assert longest == {number: number for number in range(len(bridge.added))}


def test_of_words_that_are_the_beginning_of_others_the_longer_are_meant(
    bridge: MeasurementModel,
) -> None:
    short = bridge.added[3]
    long = replace(short, words=f"{short.words} at midspan")
    said = findings(cause(EAST, separated_by=f"{long.advice} tells them apart"))
    assert advised(said, [short, long], []) == ([1], [])
    assert advised(said, [long, short], []) == ([0], [])
