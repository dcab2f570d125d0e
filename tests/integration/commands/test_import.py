"""`rga import` writes a model, or says why none is written."""

import json
from collections.abc import Callable
from pathlib import Path
from typing import Any

import pytest

from rga.model import load_model

TRUSS = """
model basic -ndm 2 -ndf 2
node 1 0 0; node 2 144 0; node 3 72 96
fix 1 1 1; fix 2 1 1
uniaxialMaterial Elastic 1 3000
element truss 1 1 3 10 1
element truss 2 2 3 5 1
pattern Plain 1 Linear { load 3 100 -50 }
analyze 1
"""


@pytest.fixture
def script(tmp_path: Path) -> Path:
    """A script of a small truss."""
    path = tmp_path / "truss.tcl"
    path.write_text(TRUSS, encoding="utf-8")
    return path


class TestImportCommand:
    def test_it_writes_a_model_and_says_all(
        self, rga: Callable[..., Any], script: Path, tmp_path: Path
    ) -> None:
        target = tmp_path / "model.json"
        outcome = rga("import", script, "-o", target, "--units", "kip, in")
        assert outcome.code == 0
        assert "3 nodes, 2 members, 2 supports" in outcome.out
        assert "dropped: analysis and output, which no model needs: analyze (line 9)" in outcome.out
        assert "load pattern 1: 444.822, 0, -222.411 kN" in outcome.out
        assert load_model(target).members["1"].nodes == ("1", "3")

    def test_a_question_leaves_nothing_behind(
        self, rga: Callable[..., Any], script: Path, tmp_path: Path
    ) -> None:
        outcome = rga("import", script, "-o", tmp_path / "model.json")
        assert outcome.code == 2
        assert "question: an OpenSees script never states its units" in outcome.out
        assert "no model is written: 1 thing would make it wrong" in outcome.err
        assert [one.name for one in tmp_path.iterdir()] == ["truss.tcl"]

    def test_json_has_the_complete_list(
        self, rga: Callable[..., Any], script: Path, tmp_path: Path
    ) -> None:
        script.write_text(TRUSS.replace("Elastic", "ElasticPP"), encoding="utf-8")
        outcome = rga("import", script, "-o", tmp_path / "model.json", "--json")
        said = json.loads(outcome.out)
        assert outcome.code == 2
        assert not said["written"]
        assert [note["severity"] for note in said["notes"]][:3] == [
            "refused",
            "refused",
            "question",
        ]
        assert said["notes"][0]["where"] == "line 5"

    def test_an_output_that_is_no_json_is_refused(
        self, rga: Callable[..., Any], script: Path, tmp_path: Path
    ) -> None:
        outcome = rga("import", script, "-o", tmp_path / "model.toml")
        assert outcome.code == 2
        assert "name a .json file" in outcome.err
