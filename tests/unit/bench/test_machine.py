"""The machine's record: what else a process has loaded does not show in it."""

import os
import shutil
import subprocess
import sys
from pathlib import Path

import pytest
from threadpoolctl import threadpool_info

from rga_bench.machine import versions

#: asks before and after another BLAS is loaded, as CHOLMOD and others bring one
BEFORE_AND_AFTER = """
import ctypes, sys
from threadpoolctl import threadpool_info
from rga_bench.machine import versions
alone, before = len(threadpool_info()), versions()
ctypes.CDLL(sys.argv[1])
assert len(threadpool_info()) > alone, "another BLAS was to be loaded"
assert versions() == before, (before, versions())
"""


def test_another_blas_does_not_change_the_versions(tmp_path: Path) -> None:
    blas = [Path(one["filepath"]) for one in threadpool_info() if one["user_api"] == "blas"]
    if not blas:
        pytest.skip("NumPy has a BLAS that is not told by name")
    # In another file the loader takes a library for another one.
    other = shutil.copy(blas[0], tmp_path / f"libopenblas_{blas[0].name}")
    done = subprocess.run(
        [sys.executable, "-c", BEFORE_AND_AFTER, str(other)],
        env={**os.environ, "LD_LIBRARY_PATH": str(blas[0].parent)},
        capture_output=True,
        text=True,
    )
    assert done.returncode == 0, done.stderr
    assert versions()["BLAS"]
