"""A run whose past outgrows what a diagnosis analyses."""

from dataclasses import replace
from pathlib import Path

import numpy as np
import pytest

from rga.findings.criteria import Criteria
from rga.twin.runner import taken_up
from rga.twin.settings import Settings
from site_truss import ROWS, STEP, Site, logged, model

MOST, LATE = 80, 72
SETTINGS = Settings(
    level="B",
    inference="joint",
    criteria=Criteria.model_validate({"record": {"most_rows": MOST}}),
)


@pytest.mark.parametrize("sinks", [0.0, 0.005])
def test_a_run_taken_up_diagnoses_the_same_chosen_rows(tmp_path: Path, sinks: float) -> None:
    site = Site(sinks=sinks * (np.arange(ROWS) >= LATE))
    record = replace(logged(site).record(), sha256="a" * 64)
    with taken_up(model(), record, tmp_path, SETTINGS, 1) as run:
        while run.stage != "report":
            run.step()
        told, kinds = run.findings(), {event.kind for event in run.history().events}
    assert ({"alarm", "version"} <= kinds) == bool(told.causes) == bool(sinks)
    # Where nothing happened rows are taken evenly.
    words = f"diagnosed were {MOST} of {ROWS} rows, 4 on end: "
    assert (words in " ".join(told.warnings)) == bool(sinks)
    assert len(told.account.record) <= MOST < told.account.recorded == ROWS
    assert told.account.record.time[-1] >= STEP * (ROWS - 2)
    with taken_up(model(), record, tmp_path, SETTINGS, 1) as again:
        assert again.findings().to_json() == again.stored_findings().to_json() == told.to_json()
