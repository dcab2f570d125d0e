"""An empty repository on every kind of database."""

from collections.abc import Iterator

import pytest

from rga.twin.repository import Repository, Run
from stored_runs import IDENTITY, place

__all__ = ["place"]


@pytest.fixture
def repository(place: str) -> Iterator[Repository]:
    with Repository.open(place) as repository:
        yield repository


@pytest.fixture
def run(repository: Repository) -> Run:
    return repository.run(IDENTITY)
