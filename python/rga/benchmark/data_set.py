"""What a large data set costs: memory and time of a process that writes one."""

import json
import os
import subprocess
import sys
import time
from pathlib import Path
from tempfile import TemporaryDirectory

from rga.benchmark.truth.case_study import case_study_bridge
from rga.errors import InputError

#: sensors of the data set
SENSORS = 16


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
        command = [sys.executable, "-m", "rga", "dataset", str(path), "-n", str(rows), "-o", target]
        begin = time.perf_counter()
        complaints = Path(folder) / "complaints"
        with complaints.open("wb") as file:
            writer = subprocess.Popen(command, stdout=subprocess.DEVNULL, stderr=file)
            # The peak of this process alone, whatever else has run before.
            _, status, used = os.wait4(writer.pid, 0)
        seconds = time.perf_counter() - begin
        if status:
            raise InputError(
                "the data set of the benchmark could not be written",
                folder,
                complaints.read_text(encoding="utf-8", errors="replace").strip(),
            )
    per_mebibyte = 1024**2 if sys.platform == "darwin" else 1024
    return used.ru_maxrss / per_mebibyte, seconds
