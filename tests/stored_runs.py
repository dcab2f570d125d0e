"""What tests of the repository store."""

import json
from typing import Any

import numpy as np
from sqlalchemy import text

from rga.twin.repository import Identity
from rga.twin.repository.database import database

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
    opened.engine.dispose()
