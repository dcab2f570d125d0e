"""The machine, and the versions of all that is measured."""

import ctypes
import os
import platform
import subprocess
import sys
from ctypes.util import find_library
from functools import cache
from importlib.metadata import PackageNotFoundError, version
from pathlib import Path
from typing import Any

from threadpoolctl import threadpool_info

from rga import _core

PACKAGES = ("rga", "numpy", "scipy", "scikit-sparse", "PyNiteFEA", "river", "bottleneck")
#: prints the BLAS of what the benchmarks compute with
BLAS = """
import scipy.linalg
from rga_bench.machine import cholmod, loaded
cholmod()
print(loaded())
"""


def machine() -> dict[str, Any]:
    """Processor, instruction sets that rga uses, cores, memory [GiB], system."""
    return {
        "processor": _processor(),
        "instructions": _core.instructions(),
        "cores": os.cpu_count(),
        "memory_GiB": _memory(),
        "system": platform.platform(),
    }


def versions() -> dict[str, str | None]:
    """Of packages and libraries; None for what is not installed."""
    found = {"Python": platform.python_version(), **{name: _version(name) for name in PACKAGES}}
    return {**found, "CHOLMOD": cholmod(), "BLAS": _blas()}


def loaded() -> str:
    """The BLAS libraries that this process has loaded."""
    blas = [one for one in threadpool_info() if one["user_api"] == "blas"]
    described = [f"{one['internal_api']} {one['version']} {one['architecture']}" for one in blas]
    return ", ".join(sorted(described))


@cache
def _blas() -> str:
    """Those of NumPy, SciPy and CHOLMOD, whatever else this process has loaded by now.

    So a process that loads these alone reports them.
    """
    done = subprocess.run(
        [sys.executable, "-c", BLAS],
        env={**os.environ, "PYTHONPATH": os.pathsep.join(sys.path)},
        stdout=subprocess.PIPE,
        text=True,
        check=True,
    )
    return done.stdout.strip()


def _processor() -> str:
    path = Path("/proc/cpuinfo")
    if path.exists():
        for line in path.read_text(encoding="utf-8").splitlines():
            if line.startswith("model name"):
                return line.split(":", 1)[1].strip()
    return platform.processor() or platform.machine()


def _memory() -> float | None:
    if "SC_PHYS_PAGES" not in os.sysconf_names:
        return None
    return round(os.sysconf("SC_PHYS_PAGES") * os.sysconf("SC_PAGE_SIZE") / 2**30, 1)


def _version(name: str) -> str | None:
    try:
        return version(name)
    except PackageNotFoundError:
        return None


def cholmod() -> str | None:
    """The version that the library itself reports."""
    path = find_library("cholmod")
    if path is None:
        return None
    numbers = (ctypes.c_int * 3)()
    ctypes.CDLL(path).cholmod_version(numbers)
    return ".".join(map(str, numbers))
