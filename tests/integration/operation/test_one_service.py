"""`rga serve` says what it serves, and is the only one at its place."""

import subprocess
import sys
from pathlib import Path
from typing import Any

from rga_bench.operation.service_process import ServiceProcess
from served.made_service import write_service


def refused(folder: Path) -> str:
    """What another service says that cannot begin."""
    command = [sys.executable, "-m", "rga", "serve", "serve.toml"]
    done = subprocess.run(
        command, cwd=folder, capture_output=True, text=True, timeout=120, check=False
    )
    assert (done.returncode, done.stdout) == (2, "")
    assert done.stderr.startswith("error: ")
    assert done.stderr.count("\n") == 1
    return done.stderr


def test_it_says_what_it_serves_and_is_alone(
    measured_bridge: dict[str, Any], tmp_path: Path
) -> None:
    here, there = tmp_path / "here", tmp_path / "there"
    for folder in (here, there):
        folder.mkdir()
    address, elsewhere = (
        write_service(folder, measured_bridge).removeprefix("http://") for folder in (here, there)
    )
    with ServiceProcess(here, f"http://{address}") as service:
        said = (here / "service.log").read_text("utf-8").splitlines()
        assert said == [f"rga listens at http://{address} and serves east (http)"]
        assert "writes there (data/service.sqlite)" in refused(here)
        configuration = there / "serve.toml"
        text = configuration.read_text("utf-8")
        configuration.write_text(text.replace(elsewhere, address), "utf-8")
        words = refused(there)
        assert "address already in use" in words
        assert f"listen = {address!r}" in words
        # Neither did anything to the one that runs, nor begun a twin.
        assert service.get("/healthz") == {"state": "up"}
        assert not (there / "data" / "east").exists()
        # One that is killed leaves the place to the next.
        service.kill()
        service.start()
