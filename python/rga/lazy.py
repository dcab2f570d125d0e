"""Names that a package opens on first use, and packages that only some of them need."""

import gc
import sys
from collections.abc import Callable, Iterable, Iterator, Mapping
from contextlib import contextmanager
from importlib import import_module
from types import ModuleType
from typing import Any

from rga.errors import MissingPackageError

#: extra of rga that installs a package
EXTRAS = {
    "torch": "networks",
    "safetensors": "networks",
    "sqlalchemy": "twin",
    "alembic": "twin",
    "weasyprint": "pdf",
    "ezdxf": "formats",
    "openpyxl": "formats",
    "nptdms": "formats",
    "pyuff": "formats",
    "pyfive": "formats",
    "msgspec": "serve",
    "fastapi": "serve",
    "starlette": "serve",
    "uvicorn": "serve",
    "paho": "serve",
    "apprise": "serve",
    "argon2": "serve",
    "prometheus_client": "serve",
    "asyncua": "opcua",
    "pyoma2": "oma",
}


@contextmanager
def needing_extras() -> Iterator[None]:
    """Says of a package that is missed which extra installs it.

    Raises:
        MissingPackageError: it belongs to an extra, and is not installed.

    >>> with needing_extras():
    ...     raise ModuleNotFoundError("No module named 'torch'", name="torch")
    Traceback (most recent call last):
    rga.errors.MissingPackageError: torch is not installed: pip install "rga[networks]"
    """
    try:
        yield
    except ModuleNotFoundError as error:
        package = (error.name or "").partition(".")[0]
        if package not in EXTRAS:
            raise
        raise MissingPackageError(package, EXTRAS[package]) from None


@contextmanager
def importing_much() -> Iterator[None]:
    """No garbage is looked for while a block imports, and later none in what it has made.

    It would be a third of the time that a service takes to start.

    >>> with importing_much():
    ...     import json
    >>> gc.isenabled(), gc.get_freeze_count() > 0
    (True, True)
    """
    gc.disable()
    try:
        yield
    finally:
        gc.freeze()
        gc.enable()


def listing(package: str, names: Iterable[str]) -> Callable[[], list[str]]:
    """What a package lists as its own: `__dir__`.

    Args:
        package: its name.
        names: of its interface, those that it has not opened yet too; modules in it that are
            imported come beside them.

    >>> import rga
    >>> "diagnose" in dir(rga), "opening" in dir(rga)
    (True, False)
    """

    def listed() -> list[str]:
        own = vars(sys.modules[package]).items()
        beside = {name for name, one in own if isinstance(one, ModuleType) or name.startswith("__")}
        return sorted({*names, *beside})

    return listed


def opening(package: str, homes: Mapping[str, str]) -> Callable[[str], Any]:
    """What a package does for a name that it has not imported: `__getattr__`.

    Args:
        package: its name.
        homes: modules of the names.
    """

    def opened(name: str) -> Any:
        if name not in homes:
            raise AttributeError(f"module {package!r} has no attribute {name!r}")
        with needing_extras():
            return getattr(import_module(homes[name]), name)

    return opened
