"""What a model file says about itself: its head, its schema, masses, fibres."""

import json
from pathlib import Path

import pytest

from crossed_truss import crossed_truss
from rga.errors import InputError
from rga.model import load_model
from rga.model.io import model_content, read_model, write_model

HEAD = {
    "$schema": "model.schema.json",
    "about": {"client": "Roads office", "structure": "Mill bridge", "author": "A. Engineer"},
    "masses": {"box": {"node": "", "mass": 250.0}},
}


def with_head() -> dict[str, object]:
    content = model_content(crossed_truss(both_ways=False))
    return {
        **content,
        **HEAD,
        "masses": {"box": {"node": next(iter(content["nodes"])), "mass": 250.0}},
    }


class TestHead:
    def test_what_a_file_says_about_itself_stays_when_it_is_written(self, tmp_path: Path) -> None:
        content = with_head()
        write_model(read_model(content, "here"), tmp_path / "model.json")
        written = json.loads((tmp_path / "model.json").read_text())
        assert {key: written[key] for key in HEAD} == {key: content[key] for key in HEAD}
        assert load_model(tmp_path / "model.json").about.client == "Roads office"

    def test_a_mass_stands_on_a_node_of_the_model(self) -> None:
        content = with_head() | {"masses": {"box": {"node": "nowhere", "mass": 1.0}}}
        with pytest.raises(InputError, match=r"masses.box.node: there is no 'nowhere'"):
            read_model(content, "here")
