"""What one command begins is done before the next, whether they come together or one by one."""

import json
from collections.abc import Callable, Iterable
from pathlib import Path
from random import Random
from typing import Any

import numpy as np
import pytest

import rga
from live_streams import LOW, SINKS_AT, assert_same, commands, history, kinds, play_step_by_step
from rga.model import Model
from rga.records import Record
from rga.twin import Accept, Exclude, Note, Recalibrate, Reject, Rollback

Given = tuple[Model, Record]
BY: dict[str, str] = {"who": "Ada", "why": "as said", "given_at": "2026-11-26T12:00:00+00:00"}
#: rows that a twin has taken in before it is asked for anything, and how many there are
BEFORE, ROWS = 50, 90


def drawn(draw: Random, count: int) -> list[Any]:
    """Commands, possible and impossible."""
    made: list[Callable[[], Any]] = [
        lambda: Note(**BY),
        lambda: Recalibrate(**BY),
        lambda: Rollback(version=draw.randint(1, 3), **BY),
        lambda: Accept(proposal=draw.choice([None, 1, 2]), **BY),
        lambda: Reject(**BY),
        lambda: Exclude(sensor=draw.choice(["D1", "S L0-L1", "D9"]), **BY),
        lambda: Exclude(sensor="D2", since=600.0 * draw.randint(0, ROWS), until=5e4, **BY),
    ]
    return [draw.choice(made)() for _ in range(count)]


def assert_order_is_all(
    copy: Callable[[], Path], record: Record, first: int, batches: Iterable[list[Any]]
) -> None:
    """Commands asked for together end in the same twin as one by one, by one twin after another.

    Args:
        copy: makes a directory of the same twin.
        record: whose rows it takes, a few after each batch.
        first: rows that it has taken.
        batches: of commands.
    """
    ends, batches = [], list(batches)
    for together in (True, False):
        place, fed = copy(), first
        for batch in batches:
            for asked in [batch] if together else [[one] for one in batch]:
                with rga.LiveTwin(place) as twin:
                    for command in asked:
                        twin.ask(command)
                    if together:
                        twin.play()
                play_step_by_step(place)
            fed = min(len(record), fed + 5)
            with rga.LiveTwin(place) as twin:
                twin.feed(record.rows(slice(0, fed)))
                if together:
                    twin.play()
            play_step_by_step(place)
        with rga.Twin.open(place) as stored:
            ends.append((stored.state, stored.history(), commands(place)))
    assert len(ends[0][2]) == sum(map(len, batches))
    assert ends[1][2] == ends[0][2]
    assert ends[1][0].version == ends[0][0].version
    assert ends[1][0].versions == ends[0][0].versions
    assert_same(ends[1][1], ends[0][1])


@pytest.mark.parametrize(
    "seed", [1, *(pytest.param(seed, marks=pytest.mark.thorough) for seed in (2, 3))]
)
def test_reopening_between_commands_changes_nothing(
    seed: int, sinks: Given, taken_in: Callable[..., Path]
) -> None:
    draw = Random(seed)
    batches = [drawn(draw, draw.randint(1, 3)) for _ in range(4)]
    assert_order_is_all(lambda: taken_in(sinks, 90, adopt="ask"), sinks[1], 90, batches)


@pytest.fixture(scope="module")
def latent(small_stream: Callable[..., Path]) -> tuple[Model, Record, dict[str, Any]]:
    """A model two of whose contexts are inferred, a sound record, and settings."""
    folder = small_stream(drifts=False, sinks=False, rows=ROWS)
    model = rga.load_model(folder / "model.json")
    record = rga.load_record(folder / "record.csv", model)
    kept: dict[str, Any] = json.loads((folder / "settings.json").read_text("utf-8"))
    return model, record, kept | {"inference": "joint", "level": "B", "adopt": "ask"}


def propose(place: Path) -> None:
    """Let a twin propose that a bearing has sunk a little, as a diagnosis would."""
    effect = LOW | {"displacement": -1e-5, "onset": 600.0 * 45}
    with rga.LiveTwin(place) as twin:
        running = twin._taken_up()
        with running._archive.step():
            running.analysis._propose({"low": effect}, 1.0, None)
            running._checkpoint.keep()


@pytest.mark.parametrize(
    "asked",
    [
        pytest.param(
            [Accept(**BY), Rollback(version=1, **BY), Recalibrate(**BY)],
            marks=pytest.mark.thorough,
        ),
        [Rollback(version=1, **BY), Recalibrate(**BY), Accept(**BY), Exclude(sensor="D1", **BY)],
        pytest.param(
            [Accept(**BY), Rollback(version=1, **BY), Rollback(version=2, **BY), Note(**BY)],
            marks=pytest.mark.thorough,
        ),
    ],
)
def test_a_version_is_learned_before_the_next_command(
    asked: list[Any],
    latent: tuple[Model, Record, dict[str, Any]],
    taken_in: Callable[..., Path],
) -> None:
    model, record, settings = latent

    def copy() -> Path:
        place = taken_in((model, record), BEFORE, **settings)
        propose(place)
        return place

    assert_order_is_all(copy, record, BEFORE, [asked, [Recalibrate(**BY)]])


def test_a_diagnosis_that_a_command_begins_comes_before_the_next(
    sinks: Given, taken_in: Callable[..., Path]
) -> None:
    place = taken_in(sinks, SINKS_AT + 5)
    with rga.LiveTwin(place) as twin:
        for command in (Recalibrate(**BY), Recalibrate(**BY), Note(**BY)):
            twin.ask(command)
        happened = kinds(twin.play())
        assert np.isfinite(history(twin).simulated).all()
    assert [one.outcome for one in commands(place)] == ["recalibrated", "recalibrated", "noted"]
    first, second = (k for k, kind in enumerate(happened) if kind == "recalibration")
    assert "diagnosis" in happened[first:second]
