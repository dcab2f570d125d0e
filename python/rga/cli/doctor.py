"""`rga doctor`: what this installation consists of."""

import typer

from rga.cli.options import JsonTarget

NEEDED = (
    "numpy", "scipy", "pydantic", "polars", "PyYAML", "typer", "rich", "jinja2", "matplotlib",
    "pint", "filelock",
)  # fmt: skip
OPTIONAL = (
    "torch", "safetensors", "sqlalchemy", "alembic", "psycopg", "distributed",
    "scikit-sparse", "PyNiteFEA", "ezdxf", "openpyxl", "npTDMS",
)  # fmt: skip
CPU_FEATURES = ("sse4_2", "avx", "avx2", "fma", "avx512f", "neon", "asimd", "sve")


def doctor(json: JsonTarget = None) -> None:
    """Show versions, threads, CPU features and optional parts."""
    import os
    import platform

    from rga import __version__
    from rga.cli.output import write_json

    content = {
        "rga": __version__,
        "core": _core(),
        "python": platform.python_version(),
        "platform": platform.platform(),
        "libraries": {name: _version(name) for name in NEEDED},
        "optional": {name: _version(name) for name in OPTIONAL},
        "threads": {"cores": os.cpu_count(), "RAYON_NUM_THREADS": os.getenv("RAYON_NUM_THREADS")},
        "cpu_features": _cpu_features(),
    }
    if json is not None:
        write_json(content, json)
    if json == "-":
        return
    for name, value in content.items():
        if isinstance(value, dict):
            value = ", ".join(f"{key} {part or 'none'}" for key, part in value.items())
        elif isinstance(value, list):
            value = ", ".join(value) or "none"
        typer.echo(f"{name.replace('_', ' ')}: {value}")


def _core() -> str:
    from importlib import import_module

    try:
        import_module("rga._core")
    except ImportError as error:
        return f"does not load: {error}"
    return "loads"


def _version(name: str) -> str | None:
    from importlib.metadata import PackageNotFoundError, version

    try:
        return version(name)
    except PackageNotFoundError:
        return None


def _cpu_features() -> list[str]:
    from pathlib import Path

    try:
        words = set(Path("/proc/cpuinfo").read_text(encoding="utf-8").split())
    except OSError:
        return []
    return [feature for feature in CPU_FEATURES if feature in words]
