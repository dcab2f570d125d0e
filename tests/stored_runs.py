"""What tests of the repository store, and an empty place on every kind of database."""

import json
import os
import uuid
from collections.abc import Iterator
from pathlib import Path
from typing import Any

import numpy as np
import pytest
from sqlalchemy import create_engine, text

from rga.twin.repository import Identity
from rga.twin.repository.database import database

SERVER = os.environ.get("RGA_TEST_POSTGRES", "")
IDENTITY = Identity("a" * 64, "b" * 64, 3, json.dumps({"level": "C"}))


def noisy(*shape: int, seed: int = 0) -> np.ndarray[Any, np.dtype[np.float64]]:
    """Numbers with NaN among them."""
    generator = np.random.default_rng(seed)
    values = generator.normal(size=shape)
    values[generator.random(shape) < 0.2] = np.nan
    return values


def version(number: int, row: int) -> dict[str, Any]:
    return {
        "number": number,
        "row": row,
        "model_json": json.dumps({"name": f"model {number}"}),
        "model_sha256": str(number) * 64,
        "causes_json": "{}",
        "gain": None if number == 1 else 12.5,
        "gain_ci90": None if number == 1 else (10.0, 14.0),
        "status": "given" if number == 1 else "accepted",
    }


def alter(place: str, statement: str) -> None:
    """Change the database behind the repository's back."""
    opened = database(place, read_only=False)
    with opened.engine.begin() as connection:
        connection.execute(text(statement))
    opened.close()


@pytest.fixture(params=["sqlite", "postgresql"])
def place(request: pytest.FixtureRequest, tmp_path: Path) -> Iterator[str]:
    """An empty place for a repository: a file, or a schema of its own on a server."""
    if request.param == "sqlite":
        yield str(tmp_path / "twin.sqlite")
    else:
        yield from _schema()


@pytest.fixture
def server() -> Iterator[str]:
    """A schema of its own on a server."""
    yield from _schema()


def _schema() -> Iterator[str]:
    if not SERVER:
        pytest.skip("RGA_TEST_POSTGRES names no server")
    schema = f"rga_{uuid.uuid4().hex}"
    address = SERVER.replace("postgresql://", "postgresql+psycopg://", 1)
    engine = create_engine(address, isolation_level="AUTOCOMMIT")
    with engine.connect() as connection:
        connection.execute(text(f"CREATE SCHEMA {schema}"))
        yield f"{SERVER}{'&' if '?' in SERVER else '?'}options=-csearch_path%3D{schema}"
        connection.execute(text(f"DROP SCHEMA {schema} CASCADE"))
    engine.dispose()
