"""A response along a curve is no cause that follows its straight part."""

from pathlib import Path

import rga
from rga_bench.diagnosis.design import Draw


def loaded(name: str, folder: Path) -> tuple[rga.Model, rga.Record]:
    Draw.parse(name).case().write(str(folder))
    model = rga.load_model(folder / "model.json")
    return model, rga.load_record(folder / "record.csv", model)


def test_a_cause_that_follows_the_linear_part_of_a_curve_is_not_named(tmp_path: Path) -> None:
    strange = rga.diagnose(*loaded("8-outside-5", tmp_path), seed=8)
    assert strange.verdict == "unknown"
    assert "go with the square of temperature" in strange.unexplained.looks_like
    straight = rga.diagnose(*loaded("8-outside-5-null", tmp_path), seed=8)
    assert straight.verdict == "nothing_wrong"


def test_the_square_of_a_latent_context_is_seen(tmp_path: Path) -> None:
    strange = rga.diagnose(*loaded("2033-outside-13", tmp_path), seed=1)
    assert strange.verdict == "unknown"
    assert "go with the square of air" in strange.unexplained.looks_like
    straight = rga.diagnose(*loaded("2033-outside-13-null", tmp_path), seed=1)
    assert straight.verdict == "nothing_wrong"
