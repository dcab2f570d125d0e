"""A service for tests: the files of its folder."""

import time
from collections.abc import Callable
from pathlib import Path
from typing import Any

from live_streams import SETTINGS
from rga_bench.operation import service_folder
from rga_bench.operation.service_folder import HTTP, MIDNIGHT, sent_of

__all__ = ["HTTP", "MIDNIGHT", "sent_of", "waited_for", "write_service"]


def write_service(
    folder: Path, model: dict[str, Any], *, name: str = "east", source: str = HTTP
) -> str:
    """Write the files of a service of one twin, all of whose contexts are measured.

    Args:
        folder: that they are written to.
        model: content of the model file.
        name: of the twin.
        source: lines of its one source.

    Returns:
        Its address.
    """
    return service_folder.write_service(folder, model, SETTINGS, name=name, source=source)


def waited_for(what: Callable[[], Any], longest: float = 120.0) -> Any:
    """What there is as soon as it is there."""
    until = time.monotonic() + longest
    while not (found := what()):
        assert time.monotonic() < until, "it does not come"
        time.sleep(0.02)
    return found
