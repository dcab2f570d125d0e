"""A run says of exported rows what the served twin said: with adopt = "ask", and not without."""

import json
from dataclasses import replace
from pathlib import Path

import rga
from live_streams import assert_same
from rga.twin import Settings, Twin
from rga.twin.history import History
from rga.twin.runner import taken_up


def played(folder: Path, **more: str) -> History:
    """The exported rows of the first twin, played with its settings and more of them."""
    given = json.loads((folder / "settings.json").read_text("utf-8"))
    assert "adopt" not in given
    settings = Settings.model_validate(given | more)
    model = rga.load_model(folder / "east.json")
    record = rga.load_record(folder / "east.parquet", model)
    place = folder / f"{'-'.join(more) or 'plain'}.sqlite"
    with taken_up(model, record, place, settings, 0) as running:
        while running.stage != "close":
            running.step()
        return running.history()


def test_a_run_needs_what_a_service_adds_to_the_settings(folder: Path) -> None:
    with Twin.open(folder / "data" / "east") as twin:
        twin.record.write(folder / "east.parquet")
        served = twin.history()
    assert "proposal" in [one.kind for one in served.events]
    found = played(folder, adopt="ask")
    # When no more rows come, a run does what an alarm waits for.
    until = found.events[: len(served.events)]
    assert_same(replace(found, events=until), served)
    assert "proposal" not in [one.kind for one in played(folder).events]
