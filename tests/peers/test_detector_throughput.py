"""What the window costs: peers decide alike, one that does not is refused, one may be missing."""

import sys
from typing import Any

import numpy as np
import pytest

from rga_bench.detection import throughput
from rga_bench.detection.throughput import CALL, SENSORS, WINDOW, Z, agree
from rga_bench.detection.windows import Bottleneck, River

#: what of the packages is measured beside, by figure
PEERS = {"river": "river GaussianScorer", "bottleneck": "bottleneck move_mean, move_std"}


@pytest.mark.parametrize(("package", "kind"), [("river", River), ("bottleneck", Bottleneck)])
def test_a_peer_decides_alike(package: str, kind: Any) -> None:
    pytest.importorskip(package)
    rows = np.random.default_rng(2).standard_normal((WINDOW + 40, SENSORS)) ** 2
    alarms = kind(WINDOW, Z).alarms(rows)
    assert alarms.sum() > 10
    agree(package, kind(WINDOW, Z).alarms, rows)
    with pytest.raises(ArithmeticError, match=f"{package} decides [0-9]+ of 3360 values otherwise"):
        agree(package, kind(WINDOW, 1.1 * Z).alarms, rows)


def test_figures_come_out(monkeypatch: pytest.MonkeyPatch) -> None:
    monkeypatch.setitem(sys.modules, "bottleneck", None)
    figures = throughput.throughput(0.0, size=8 * SENSORS * CALL)
    # What a row costs beyond reading it is a difference of two times: on a busy machine anything.
    assert all(one.value > 0.0 for one in figures if "beyond" not in one.name)
    assert sum(one.least is not None for one in figures) == len(figures) - 1
    values = {one.peer: one.peer_value for one in figures}
    assert len(values) == 4
    assert values[PEERS["bottleneck"]] is None


@pytest.mark.parametrize("package", list(PEERS))
def test_what_is_not_installed_has_no_figure(package: str, monkeypatch: pytest.MonkeyPatch) -> None:
    monkeypatch.setitem(sys.modules, package, None)
    if package == "river":
        monkeypatch.setitem(sys.modules, "river.anomaly", None)
    rows = np.ones((WINDOW + 2, SENSORS))
    assert getattr(throughput, package)(rows, 0.0) is None
