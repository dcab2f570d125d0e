"""What several commands are given."""

import json
from collections.abc import Callable
from pathlib import Path
from typing import Any

import pytest

from rga.model import read_model
from rga.records import Record

CRACK = {"kind": "member_stiffness", "member": "U2-U3", "factor": 0.7}


@pytest.fixture(scope="session")
def bridges(
    measured_bridge: dict[str, Any],
    measured_record: Callable[..., Record],
    tmp_path_factory: pytest.TempPathFactory,
) -> Path:
    """A list of a bridge with a cause, one whose record is cut off, and one that is as modelled."""
    folder = tmp_path_factory.mktemp("bridges")
    model = read_model(measured_bridge, "measured bridge")
    for name, hidden in (("west", [CRACK]), ("east", [])):
        (folder / name).mkdir()
        (folder / name / "model.json").write_text(json.dumps(measured_bridge), encoding="utf-8")
        measured_record(model, *hidden, rows=60).write(folder / name / "record.csv")
    (folder / "broken.csv").write_text("time\n0\n", encoding="utf-8")
    path = folder / "bridges.csv"
    path.write_text(
        "name,model,record\n"
        "west,west/model.json,west/record.csv\n"
        "broken,west/model.json,broken.csv\n"
        "east,east/model.json,east/record.csv\n",
        encoding="utf-8",
    )
    return path
