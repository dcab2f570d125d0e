"""What reads the sources of a twin: mistakes of mappings are told with their files, all at once."""

from pathlib import Path
from typing import Any

import pytest

from rga.errors import InputError, SeveralMistakes
from rga.model import Model, read_model
from rga.operation.sources.readers import readers_of
from rga.operation.sources.settings import HttpSource


@pytest.fixture(scope="module")
def model(measured_bridge: dict[str, Any]) -> Model:
    return read_model(measured_bridge, "measured bridge")


def source(folder: Path, name: str, mapping: str) -> HttpSource:
    path = folder / f"{name}.toml"
    path.write_text(mapping, "utf-8")
    return HttpSource(kind="http", name=name, mapping=path)


def test_a_mistake_of_a_mapping_is_told_with_its_file(model: Model, tmp_path: Path) -> None:
    one = source(tmp_path, "logger", '[channels]\nD9 = { unit = "mm" }')
    with pytest.raises(InputError, match="'D9', which the model does not have") as raised:
        readers_of("east", {"logger": one}, model)
    assert raised.value.where == f"{tmp_path}/logger.toml, twin 'east', source 'logger'"
    one = source(tmp_path, "logger", '[time]\nzone = "Europe/Atlantis"')
    with pytest.raises(InputError, match="no time zone 'Europe/Atlantis'") as raised:
        readers_of("east", {"logger": one}, model)
    assert raised.value.where == f"{tmp_path}/logger.toml"


def test_all_sources_that_are_wrong_are_told_at_once(model: Model, tmp_path: Path) -> None:
    sources = {
        "first": source(tmp_path, "first", "[channels]\nD8 = {}\nD9 = {}"),
        "sound": source(tmp_path, "sound", ""),
        "last": source(tmp_path, "last", '[time]\nformat = "%Q"'),
    }
    with pytest.raises(SeveralMistakes) as raised:
        readers_of("east", sources, model)
    told = raised.value.mistakes
    assert len(told) == 3
    assert all(
        f"{name}.toml" in one for name, one in zip(("first", "first", "last"), told, strict=True)
    )
    assert raised.value.where == "twin 'east'"
    del sources["first"], sources["last"]
    assert readers_of("east", sources, model).keys() == {"sound"}
