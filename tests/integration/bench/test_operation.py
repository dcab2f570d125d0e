"""What live operation costs and loses, as it is measured and shown."""

import json
from pathlib import Path

import pytest

from rga.twin.versions import written
from rga_bench.endless.stream import Stream, settings
from rga_bench.operation.broker import PROGRAM
from rga_bench.operation.experiment import Operation, OperationExperiment
from rga_bench.operation.kills import Losses
from rga_bench.operation.pages import PageCost, page_cost
from rga_bench.operation.rates import Rate, rate
from rga_bench.operation.unreadable import Unreadable, unreadable


@pytest.mark.skipif(PROGRAM is None, reason="mosquitto is not installed")
def test_packets_that_wait_in_a_broker_are_all_kept() -> None:
    stream = Stream(12, 10, settings(10), 0)
    found = rate(40, 12, 25, json.loads(written(stream.model)[0]), stream.settings)
    assert (found.packets, found.values) == (40, 300)
    assert found.size > 4 * 300
    assert found.ratio == found.durable / found.bare > 0


@pytest.mark.skipif(PROGRAM is None, reason="mosquitto is not installed")
def test_what_cannot_be_read_keeps_nothing_waiting() -> None:
    stream = Stream(12, 10, settings(10), 0)
    found = unreadable(100, stream, 1)
    assert found.garbage > 0
    expected = Unreadable(100, found.garbage, kept=100, aside=found.garbage, unaccounted=0)
    assert found == expected


@pytest.mark.thorough
@pytest.mark.skipif(not Path("/proc/self/io").exists(), reason="the system does not tell of usage")
def test_a_row_is_seen_by_all_who_look() -> None:
    found = page_cost(12, 10, rows=2, many=3, seed=0)
    assert (found.sensors, found.viewers) == (12, 3)
    assert 10_000 < found.weight < 400_000
    assert found.latest > 0
    assert (found.drawn is None) == bool(found.lacking)
    assert min(found.told, found.slowest, found.drawn or 1.0, found.together) > 0


def test_the_page_has_what_was_measured() -> None:
    seen = PageCost(84, 123_456, 0.0123, 0.5, None, "there is no Chromium", 50, 0.02, 0.9, 1.25)
    result = Operation(
        [Rate(100, 60, 1, 1000.0, 400.0)],
        [Losses("broker", 7, 140, 1, 2, 3, 4)],
        Unreadable(5000, 98, 5000, 97, 1),
        [seen],
    )
    experiment = OperationExperiment.of(0, quick=True)
    text = " ".join(experiment.page(result, "rga benchmark operation").text().split())
    assert "0.40" in text
    assert "| broker | 7 | 140 | 1 | 2 | 3 | 4 |" in text
    assert "| 5,000 | 5,000 | 98 | 97 | 1 |" in text
    assert "| 84 | 123 | 12.3 | 0.50 | - | 50 | 20 | 900 | 1.25 |" in text
    assert "in a browser: there is no Chromium." in text
    content = experiment.content(result, "rga benchmark operation")
    assert content["rates"][0]["ratio"] == 0.4
    assert content["pages"][0]["weight"] == 123_456
    assert content["unreadable"]["aside"] == 97
