"""A PostgreSQL server of a test's own, which can be stopped for a while."""

import shutil
import subprocess
from collections.abc import Iterator
from pathlib import Path
from tempfile import mkdtemp

import pytest

_SCRIPT = Path(__file__).parents[2] / ".ci" / "postgres"


class PostgreSQLServer:
    """A server that runs.

    Args:
        folder: of its files.
        url: of it.
    """

    def __init__(self, folder: Path, url: str) -> None:
        self.folder, self.url = folder, url

    def stop(self) -> None:
        """End it, as for an upgrade: connections break."""
        self._control("stop", "--mode", "fast")

    def start(self) -> None:
        """Start it again."""
        listen = f"-c listen_addresses= -c unix_socket_directories={self.folder} -c fsync=off"
        self._control("start", "--wait", "--log", str(self.folder / "log"), "--options", listen)

    def _control(self, *what: str) -> None:
        cluster = self.folder / "cluster"
        found = sorted(Path("/usr/lib/postgresql").glob("*/bin/pg_ctl"))
        program = str(found[-1]) if found else str(shutil.which("pg_ctl"))
        owner = [] if cluster.owner() == _user() else ["runuser", "-u", cluster.owner(), "--"]
        subprocess.run(
            [*owner, program, *what, "--pgdata", str(cluster)],
            check=True,
            stdout=subprocess.DEVNULL,
            cwd="/",
        )


def _user() -> str:
    return Path("/proc/self").owner()


@pytest.fixture
def postgresql_server() -> Iterator[PostgreSQLServer]:
    """A server while it is needed."""
    # The path of its socket is to be short.
    folder = Path(mkdtemp(prefix="rga"))
    started = subprocess.run(
        [str(_SCRIPT), "start", str(folder)], capture_output=True, text=True, check=False
    )
    url = started.stdout.strip()
    try:
        if not url:
            pytest.skip(started.stderr.strip() or "there is no PostgreSQL server here")
        yield PostgreSQLServer(folder, url)
    finally:
        subprocess.run([str(_SCRIPT), "stop", str(folder)], check=False)
