"""A record of one size, drawn by one process and diagnosed by another: `python -m` this file.

What is drawn takes more memory than what is diagnosed, and is not to be counted.
"""

import json
import resource
import sys
import time
from pathlib import Path

from rga.diagnosis import diagnose
from rga.model import load_model
from rga.model.io import model_text
from rga.records import load_record
from rga_bench.speed.sized_case import SizedCase

#: panels of a span, of 46 m
OF_A_SPAN = 10
MODEL, PART = "model.json", "part {:02}.parquet"


def draw(folder: Path, rows: int, sensors: int, panels: int, seed: int) -> None:
    """Write a model and a record in which nothing is hidden."""
    case = SizedCase(rows, sensors, panels, "nothing", seed, spans=panels // OF_A_SPAN)
    model = case.model()
    (folder / MODEL).write_text(model_text(model), "utf-8")
    for number, table in enumerate(case.tables(model)):
        table.write_parquet(folder / PART.format(number))


def measure(folder: Path) -> dict[str, object]:
    """Read and diagnose, and say what that takes."""
    begun = time.perf_counter()
    model = load_model(folder / MODEL)
    record = load_record(sorted(folder.glob("part *.parquet")), model)
    read = time.perf_counter()
    findings = diagnose(model, record)
    ended = time.perf_counter()
    return {
        "members": len(model.members),
        "reading": read - begun,
        "diagnosis": ended - read,
        "memory": 1024 * resource.getrusage(resource.RUSAGE_SELF).ru_maxrss,
        "verdict": findings.verdict,
    }


if __name__ == "__main__":
    what, place, *numbers = sys.argv[1:]
    if what == "draw":
        draw(Path(place), *map(int, numbers))
    else:
        sys.stdout.write(json.dumps(measure(Path(place))))
