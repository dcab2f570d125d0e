"""Sources are listened to for a moment, and what they bring stays in memory."""

from pathlib import Path

import pytest
from sqlalchemy import create_engine, text

from rga.operation.sources.settings import FolderSource, OpcUaSource, SqlSource
from rga.operation.trial.listening import Heard, listened_to
from rga.records import RecordMapping

#: long enough for a source to be looked at twice [s]
WAIT = 1.0


def heard(source: FolderSource | OpcUaSource | SqlSource, wait: float = WAIT) -> Heard:
    """What comes of one source."""
    return listened_to([("east", (), source, RecordMapping())], wait)[0]


def test_a_table_is_read(tmp_path: Path) -> None:
    url = f"sqlite:///{tmp_path / 'plant.sqlite'}"
    engine = create_engine(url)
    with engine.begin() as connection:
        connection.execute(text("CREATE TABLE reading (id INTEGER, time INTEGER, D1 REAL)"))
        connection.execute(text("INSERT INTO reading VALUES (1, 1795392000, 1.5)"))
    engine.dispose()
    before = (tmp_path / "plant.sqlite").read_bytes()
    found = heard(SqlSource(kind="sql", url=url, table="reading", position="id"))
    assert found.fault is None
    assert b"D1" in found.inlet.payloads[0][1]
    assert [one.name for one in tmp_path.iterdir()] == ["plant.sqlite"]
    assert (tmp_path / "plant.sqlite").read_bytes() == before


def test_a_file_that_is_no_text_is_read_whole(tmp_path: Path) -> None:
    (tmp_path / "a.json").write_text('{"v": 1}', "utf-8")
    found = heard(FolderSource(kind="folder", path=tmp_path))
    assert found.inlet.payloads[0] == ("a.json", b'{"v": 1}')


def test_an_empty_folder_brings_nothing(tmp_path: Path) -> None:
    found = heard(FolderSource(kind="folder", path=tmp_path))
    assert (found.inlet.is_empty, found.fault) == (True, None)


def test_a_server_is_asked() -> None:
    pytest.importorskip("asyncua", reason="asyncua is not installed")
    nodes = {"D1": "ns=2;i=7"}
    found = heard(OpcUaSource(kind="opcua", url="opc.tcp://127.0.0.1:1", nodes=nodes))
    assert "the server is away" in str(found.fault)
