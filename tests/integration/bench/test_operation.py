"""What live operation costs and loses, as it is measured and shown."""

import json

import pytest

from rga.twin.versions import written
from rga_bench.endless.stream import Stream, settings
from rga_bench.operation.broker import PROGRAM
from rga_bench.operation.experiment import Operation, OperationExperiment
from rga_bench.operation.kills import Losses
from rga_bench.operation.rates import Rate, rate


@pytest.mark.skipif(PROGRAM is None, reason="mosquitto is not installed")
def test_packets_that_wait_in_a_broker_are_all_kept() -> None:
    stream = Stream(12, 10, settings(10), 0)
    found = rate(40, 12, 25, json.loads(written(stream.model)[0]), stream.settings)
    assert (found.packets, found.values) == (40, 300)
    assert found.size > 4 * 300
    assert found.ratio == found.durable / found.bare > 0


def test_the_page_has_what_was_measured() -> None:
    result = Operation([Rate(100, 60, 1, 1000.0, 400.0)], [Losses("broker", 7, 140, 1, 2, 3, 4)])
    experiment = OperationExperiment.of(0, quick=True)
    text = experiment.page(result, "rga benchmark operation").text()
    assert "0.40" in text
    assert "| broker | 7 | 140 | 1 | 2 | 3 | 4 |" in " ".join(text.split("  ")).replace("  ", " ")
    content = experiment.content(result, "rga benchmark operation")
    assert content["rates"][0]["ratio"] == 0.4
