"""What a large data set costs: memory and time of a process that writes one."""

import json
import subprocess
import sys
import time
from pathlib import Path
from tempfile import TemporaryDirectory

from rga.errors import InputError
from rga_bench.synthetic.bridges.case_study import case_study_bridge

#: sensors of the data set
SENSORS = 16
#: runs a command and prints its peak memory; a process that we started ourselves would count ours
WATCH = """\
import resource, subprocess, sys
status = subprocess.call(sys.argv[1:])
print(resource.getrusage(resource.RUSAGE_CHILDREN).ru_maxrss)
sys.exit(status)
"""


def data_set_cost(rows: int) -> tuple[float, float]:
    """Peak memory [MiB] and time [s] of `rga dataset` on the case study with 16 sensors.

    Raises:
        InputError: the data set could not be written: no room on the disk, say.
    """
    model = case_study_bridge().model
    names = list(model["sensors"])[:: len(model["sensors"]) // SENSORS][:SENSORS]
    model["sensors"] = {name: model["sensors"][name] for name in names}
    with TemporaryDirectory() as folder:
        path = Path(folder) / "model.json"
        path.write_text(json.dumps(model), encoding="utf-8")
        target = str(Path(folder) / "samples.parquet")
        command = ["-m", "rga", "dataset", str(path), "-n", str(rows), "-o", target]
        watched = [sys.executable, "-c", WATCH, sys.executable, *command]
        begin = time.perf_counter()
        writer = subprocess.run(watched, capture_output=True, text=True, check=False)
        seconds = time.perf_counter() - begin
        if writer.returncode:
            raise InputError(
                "the data set of the benchmark could not be written", folder, writer.stderr.strip()
            )
    per_mebibyte = 1024**2 if sys.platform == "darwin" else 1024
    return int(writer.stdout.splitlines()[-1]) / per_mebibyte, seconds
