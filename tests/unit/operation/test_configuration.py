"""The file of a service: what it says, and what is refused in a line."""

from pathlib import Path

import pytest

from rga.errors import InputError
from rga.operation.configuration import read_configuration
from rga.operation.sources.settings import FolderSource

SOUND = """
[service]
listen = "127.0.0.1:8471"
[[twin]]
name = "pratt-7"
model = "pratt.json"
settings = "settings.toml"
rows = { every = "60 s", lateness = "10 min" }
[[twin.source]]
kind = "folder"
path = "logger"
mapping = "import.toml"
[[twin.source]]
kind = "mqtt"
url = "mqtt://broker:1883"
topics = ["rga/v1/pratt-7/data/#"]
clock = { check = false }
"""


def written(folder: Path, text: str) -> Path:
    path = folder / "serve.toml"
    path.write_text(text, "utf-8")
    return path


def test_a_configuration_is_read(tmp_path: Path) -> None:
    found = read_configuration(written(tmp_path, SOUND))
    twin = found.twin[0]
    assert found.service.data == tmp_path / "data"
    assert twin.model == tmp_path / "pratt.json"
    assert (twin.rows.grid.every, twin.rows.grid.lateness) == (60_000_000, 600_000_000)
    folder, broker = twin.source
    assert isinstance(folder, FolderSource)
    assert folder.path == tmp_path / "logger"
    assert folder.mapping == tmp_path / "import.toml"
    assert folder.clock.rule is not None
    assert broker.clock.rule is None


@pytest.mark.parametrize(
    ("old", "new", "words"),
    [
        ('"pratt-7"', '"../up"', "twin.0.name"),
        ('"60 s"', '"60"', "no duration"),
        ('"60 s"', "60", "no duration"),
        ('"60 s"', '"0.1 ms"', "a millisecond at least"),
        ('"60 s"', '"999999 d"', "less than or equal"),
        ('"mqtt"', '"kafka"', "kafka"),
        ("mqtt://broker:1883", "http://broker", "no broker"),
        ("mqtt://broker:1883", "mqtt://a:b@broker", "password"),
        ("127.0.0.1:8471", "everywhere", "service.listen"),
        ('topics = ["rga/v1/pratt-7/data/#"]', "topics = []", "topics"),
        ("[service]", "[services]", "services"),
        ('path = "logger"', 'path = "logger"\nshift = 3', "shift"),
        ('kind = "folder"', 'kind = "folder"\nname = "mqtt"', "two sources are called 'mqtt'"),
    ],
)
def test_what_is_wrong_is_told(old: str, new: str, words: str, tmp_path: Path) -> None:
    assert old in SOUND
    with pytest.raises(InputError) as refused:
        read_configuration(written(tmp_path, SOUND.replace(old, new)))
    assert words in str(refused.value)
    assert "serve.toml" in str(refused.value)


def test_two_twins_of_one_name_are_refused(tmp_path: Path) -> None:
    twin = SOUND[SOUND.index("[[twin]]") :]
    with pytest.raises(InputError, match="two twins are called 'pratt-7'"):
        read_configuration(written(tmp_path, SOUND + twin))
