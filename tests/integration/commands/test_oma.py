"""`rga oma`: a logger's file of accelerations in, a modal record out."""

from collections.abc import Callable
from pathlib import Path

import numpy as np
import polars as pl
import pytest
from scipy import signal

from conftest import Outcome

pytest.importorskip("pyoma2", reason='pyOMA2 is not installed: pip install "rga[oma]"')


@pytest.fixture
def logged(tmp_path: Path) -> Path:
    """Two accelerometers of an oscillator at 2 Hz that noise moves for five minutes."""
    draw, step = np.random.default_rng(2), 0.05
    time, rate = np.arange(0.0, 300.0, step), 4 * np.pi
    system = signal.cont2discrete(([1.0, 0.0, 0.0], [1.0, 0.02 * rate, rate**2]), step)
    swing = signal.lfilter(system[0].ravel(), system[1], draw.standard_normal(len(time)))
    noise = 0.05 * swing.std() * draw.standard_normal((2, len(time)))
    path = tmp_path / "logged.csv"
    columns = {"time": time.round(6), "a": swing + noise[0], "b": -0.5 * swing + noise[1]}
    pl.DataFrame(columns).write_csv(path)
    return path


def test_windows_become_a_record(rga: Callable[..., Outcome], logged: Path, tmp_path: Path) -> None:
    record = tmp_path / "modes.csv"
    done = rga(
        "oma", logged, "--highest", 5, "--minutes", 2, "--column", "a=A1", "--column", "b=A2",
        "-o", record,
    )  # fmt: skip
    assert done.code == 0, done.err
    assert "2 modes found in 2 windows." in done.out
    written = pl.read_csv(record)
    assert written["time"].to_list() == pytest.approx([60.0, 180.0], abs=0.1)
    assert written["duration"].to_list() == pytest.approx([120.0, 120.0])
    assert written["f"].to_list() == pytest.approx([2.0, 2.0], rel=0.01)
    ratio = (written["A2"] / written["A1"]).to_list()
    assert ratio == pytest.approx([-0.5, -0.5], abs=0.05)


@pytest.mark.parametrize(
    ("options", "told"),
    [
        (("--highest", 50, "--minutes", 2), "do not show frequencies up to 50 Hz"),
        (("--highest", 5, "--minutes", 20), "give shorter"),
        (("--highest", 5, "--minutes", 0.1), "give windows of"),
        (("--highest", 5, "--minutes", 0), "a window of 0 s holds no two readings"),
    ],
)
def test_what_cannot_be_found_is_told(
    rga: Callable[..., Outcome],
    logged: Path,
    tmp_path: Path,
    options: tuple[object, ...],
    told: str,
) -> None:
    done = rga("oma", logged, *options, "-o", tmp_path / "modes.csv")
    assert done.code != 0
    assert told in done.err
    assert not (tmp_path / "modes.csv").exists()
