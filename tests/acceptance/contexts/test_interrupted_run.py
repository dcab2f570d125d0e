"""A benchmark that is killed at any time goes on, and tells what it would have told."""

import os
import signal
import subprocess
import sys
import time
from dataclasses import replace
from pathlib import Path

import numpy as np
import pytest

from rga_bench.contexts.experiment import ContextsExperiment
from rga_bench.contexts.setting import ContextsSetting, Sizes
from rga_bench.contexts.task_run import TaskOutcome
from rga_bench.experiment import Execution
from rga_bench.ledger import NAME

SETTING = ContextsSetting(
    seed=11,
    splits=1,
    gaps=("all",),
    manners=("same",),
    drifts=("none",),
    rows=("noise", "prior mean"),
    sizes=Sizes(source=128, unlabelled=32, stream=24, test=12),
)
TASKS = 2 * 2
#: `RGA_TEST_KILLS=50` kills more often
KILLS = int(os.environ.get("RGA_TEST_KILLS", "2"))


def outcomes(folder: Path, workers: int) -> list[TaskOutcome]:
    """Of all tasks, without the times."""
    execution = Execution(folder=folder, workers=workers)
    found = ContextsExperiment(SETTING).measure(execution).outcomes
    return [replace(one, learning=None, inference=None) for one in found]


def lines(folder: Path) -> int:
    """That the ledger has, a cut one included."""
    path = folder / NAME
    return len(path.read_bytes().splitlines()) if path.exists() else 0


@pytest.mark.thorough
def test_a_run_killed_at_random_has_the_same_results(tmp_path: Path) -> None:
    generator = np.random.default_rng(7)
    folder = tmp_path / "killed"
    kept = []
    for number in range(KILLS):
        after = 1 + number * (TASKS - 2) // KILLS
        # In two processes, in one, in two again.
        command = [sys.executable, __file__, str(folder), str(2 - number % 2)]
        process = subprocess.Popen(command, start_new_session=True)
        until = time.monotonic() + 120.0
        while lines(folder) < after and process.poll() is None and time.monotonic() < until:
            time.sleep(0.002)
        time.sleep(generator.uniform(0.0, 0.2))
        if process.poll() is None:
            os.killpg(process.pid, signal.SIGKILL)
        process.wait()
        kept.append(lines(folder))
    assert 0 < kept[0] < TASKS, "the first kill came too late to cut anything off"
    assert sorted(kept) == kept
    assert outcomes(folder, 1) == outcomes(tmp_path / "whole", 1)
    assert lines(folder) == TASKS


if __name__ == "__main__":
    outcomes(Path(sys.argv[1]), int(sys.argv[2]))
