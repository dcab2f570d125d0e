"""What tests of the door share: a service whose twin has lived through something."""

import shutil
from collections.abc import Callable, Iterator
from datetime import UTC, datetime
from pathlib import Path
from typing import Any

import pytest
from starlette.testclient import TestClient

from live_streams import sinking
from rga.dashboard.app import app_of
from rga.model import read_model
from rga.operation.configuration import read_configuration
from rga.operation.service import Service
from rga.records import Record
from served.bridges import configured, lived, packets_of

#: time of the first row
START = datetime(2026, 11, 23, tzinfo=UTC)
#: as a browser of this machine sends it
HERE = "http://127.0.0.1:8471"


@pytest.fixture(scope="session")
def lived_through(
    measured_bridge: dict[str, Any],
    measured_record: Callable[..., Record],
    tmp_path_factory: pytest.TempPathFactory,
) -> tuple[Path, Record]:
    """Folder of a service of two twins, and the record that the first has lived through.

    A bearing sinks, and a proposal is open. The second twin has not begun.
    """
    folder = tmp_path_factory.mktemp("lived")
    configured(folder, {"east": measured_bridge, "west": measured_bridge})
    model = read_model(measured_bridge, "bridge")
    record = sinking(model, measured_record, 120)
    service = Service(read_configuration(folder / "serve.toml"))
    lived(service.twins["east"], packets_of(record, START))
    service.stop()
    return folder, record


@pytest.fixture
def folder(lived_through: tuple[Path, Record], tmp_path: Path) -> Path:
    """A copy of the folder, to be changed."""
    return Path(shutil.copytree(lived_through[0], tmp_path / "served"))


@pytest.fixture
def service(folder: Path) -> Iterator[Service]:
    """The service of the copy; nothing plays its twins."""
    found = Service(read_configuration(folder / "serve.toml"))
    yield found
    found.stop()


@pytest.fixture
def client(service: Service) -> Iterator[TestClient]:
    """A program of this machine that calls it."""
    with TestClient(app_of(service), base_url=HERE, raise_server_exceptions=True) as found:
        yield found


def page(client: TestClient, path: str, status: int = 200) -> str:
    """A page as a browser gets it."""
    answer = client.get(path, headers={"accept": "text/html"})
    assert answer.status_code == status, answer.text
    assert len(answer.content) < 400_000
    return answer.text
