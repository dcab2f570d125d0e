"""What results were made by: the versions of packages."""

import platform
from importlib.metadata import version


def versions() -> dict[str, str]:
    """Versions of what took part."""
    packages = ("rga", "numpy", "scipy", "pydantic", "polars")
    return {**{name: version(name) for name in packages}, "python": platform.python_version()}
