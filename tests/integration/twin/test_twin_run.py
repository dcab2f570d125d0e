"""Runs of the twin on a short stream: the story, its repetition, its interruption, its past."""

import json
import os
import random
import shutil
from collections.abc import Callable
from contextlib import suppress
from multiprocessing import get_context
from pathlib import Path
from typing import Any

import numpy as np
import pytest

import rga
from rga.cli import main
from rga.errors import InputError
from rga.twin import Outcome, Settings, rollback
from rga.twin.repository import Repository
from rga.twin.restore import log_of
from rga.twin.runner import Running

Stream = Callable[..., Path]
#: `RGA_TEST_KILLS=200` makes the test of killed runs as long as the acceptance wants it
KILLS = int(os.environ.get("RGA_TEST_KILLS", "3"))


def run(
    folder: Path, directory: Path, *, seed: int = 0, report: bool = False, **more: Any
) -> Outcome:
    """A run, whose report takes as long as a third of it and is not drawn for its own sake."""
    model = rga.load_model(folder / "model.json")
    record = rga.load_record(folder / "record.csv", model)
    wanted = json.loads((folder / "settings.json").read_text(encoding="utf-8"))
    settings = Settings.model_validate(wanted | more.pop("settings", {}))
    with pytest.MonkeyPatch.context() as patch:
        if not report:
            patch.setattr("rga.report.write_run_report", lambda history, findings, path: path)
        return rga.run(model, record, directory, settings=settings, seed=seed, **more)


def events(outcome: Outcome) -> list[tuple[str, int, float | None, float | None]]:
    return [(e.kind, e.row, e.gap_before, e.gap_after) for e in outcome.history.events]


@pytest.fixture(scope="module")
def stream(small_stream: Stream) -> Path:
    return small_stream()


@pytest.fixture(scope="module")
def finished(stream: Path, tmp_path_factory: pytest.TempPathFactory) -> tuple[Path, Outcome]:
    """A finished run and its directory."""
    directory = tmp_path_factory.mktemp("finished")
    return directory, run(stream, directory, report=True)


@pytest.fixture(scope="module")
def at_level(
    stream: Path, tmp_path_factory: pytest.TempPathFactory
) -> Callable[[str], tuple[Path, Outcome]]:
    """A finished run at a level of integration, and its directory."""
    finished: dict[str, tuple[Path, Outcome]] = {}

    def level(name: str) -> tuple[Path, Outcome]:
        if name not in finished:
            directory = tmp_path_factory.mktemp(name)
            finished[name] = directory, run(stream, directory, settings={"level": name})
        return finished[name]

    return level


def test_the_story_of_a_stream(finished: tuple[Path, Outcome]) -> None:
    """Calibration, a novel context, an alarm, a doubt, a cause, a version."""
    directory, outcome = finished
    kinds = [event.kind for event in outcome.history.events]
    first = {kind: kinds.index(kind) for kind in kinds}
    order = ["calibration", "novel context", "alarm", "recalibration", "diagnosis", "version"]
    assert sorted(order, key=first.__getitem__) == order
    by_kind = {e.kind: e for e in reversed(outcome.history.events)}
    assert 60 <= by_kind["novel context"].row < 90
    assert 105 <= by_kind["alarm"].row < 115
    recalibration, version = by_kind["recalibration"], by_kind["version"]
    assert recalibration.gap_before is not None
    assert version.gap_after is not None
    assert version.gap_after < 0.1 * recalibration.gap_before
    assert "no contexts explain rows" in recalibration.words
    causes = [cause.effect for cause in outcome.findings.causes]
    assert [(c["kind"], c["support"], c["dof"]) for c in causes] == [
        ("support_settlement", "east", "uz")
    ]
    low, high = causes[0]["displacement"]["ci90"]
    assert low <= -0.002 <= high
    for name in ("findings.json", "model.json", "report.html", "twin.sqlite"):
        assert (directory / name).exists()
    extended = rga.load_model(directory / "model.json")
    assert any(effect.kind == "support_settlement" for effect in extended.effects.values())


def test_contexts_are_inferred_within_their_intervals(finished: tuple[Path, Outcome]) -> None:
    history = finished[1].history
    days = np.arange(150) / 24
    east = 25 + 10 * np.cos(2 * days) + 4  # plus a draw of 0 to 8
    off = history.inferred[:100, history.contexts.index("east load")] - east[:100]
    assert np.sqrt((off**2).mean()) < 4
    assert (history.spread[:100] < 5).all()


def test_the_null_twin_stays_as_it_is(small_stream: Stream, tmp_path: Path) -> None:
    """The same stream with no drift and nothing hidden: nothing may be found."""
    outcome = run(small_stream(drifts=False, sinks=False), tmp_path)
    assert outcome.findings.verdict == "nothing_wrong"
    assert outcome.findings.causes == []
    assert len(outcome.history.versions) == 1
    assert not any(e.kind == "novel context" for e in outcome.history.events)


def test_a_drift_alone_is_no_cause(small_stream: Stream, tmp_path: Path) -> None:
    outcome = run(small_stream(sinks=False), tmp_path)
    assert outcome.findings.causes == []
    assert len(outcome.history.versions) == 1


class _Stop(Exception):
    pass


def test_the_same_seed_gives_the_same_though_interrupted_after_every_step(
    stream: Path, finished: tuple[Path, Outcome], tmp_path: Path
) -> None:
    def stop(running: Running) -> None:
        raise _Stop

    for _ in range(200):
        try:
            outcome = run(stream, tmp_path, watch=stop)
        except _Stop:
            continue
        break
    assert events(outcome) == events(finished[1])
    np.testing.assert_array_equal(outcome.history.inferred, finished[1].history.inferred)
    np.testing.assert_array_equal(outcome.history.gaps, finished[1].history.gaps)
    expected = (finished[0] / "findings.json").read_text(encoding="utf-8")
    assert (tmp_path / "findings.json").read_text(encoding="utf-8") == expected


def test_a_run_that_is_done_is_not_done_again(stream: Path, finished: tuple[Path, Outcome]) -> None:
    directory, first = finished
    with Repository.open(directory, read_only=True) as kept:
        steps = kept.runs()[0].steps
    steps_seen: list[int] = []
    again = run(stream, directory, watch=lambda running: steps_seen.append(running.row))
    assert steps_seen == []
    assert again.findings.model_dump() == first.findings.model_dump()
    with Repository.open(directory, read_only=True) as kept:
        assert kept.runs()[0].steps == steps


@pytest.mark.thorough
def test_another_model_in_the_same_directory_is_another_run(
    stream: Path, at_level: Callable[[str], tuple[Path, Outcome]], tmp_path: Path
) -> None:
    """Files and twin are always those of the run that was asked for last."""
    stiffer = json.loads((stream / "model.json").read_text(encoding="utf-8"))
    stiffer["sections"]["bar"]["A"] = 0.005
    other = tmp_path / "other"
    other.mkdir()
    (other / "model.json").write_text(json.dumps(stiffer), encoding="utf-8")
    for name in ("record.csv", "settings.json"):
        (other / name).write_bytes((stream / name).read_bytes())
    directory = tmp_path / "out"
    finished, _ = at_level("A")
    shutil.copytree(finished, directory)
    expected = (finished / "findings.json").read_text(encoding="utf-8")
    for folder in (stream, other, stream):
        outcome = run(folder, directory, settings={"level": "A"})
        text = (directory / "findings.json").read_text(encoding="utf-8")
        assert outcome.findings.to_json() + "\n" == text
        assert (text == expected) == (folder == stream)
        with rga.Twin.open(directory) as twin:
            area = twin.given.sections["bar"].A
        assert area == (0.004 if folder == stream else 0.005)


@pytest.mark.thorough
def test_killed_at_random_it_loses_nothing_and_ends_the_same(
    stream: Path,
    finished: tuple[Path, Outcome],
    tmp_path: Path,
    monkeypatch: pytest.MonkeyPatch,
) -> None:
    """Every acknowledged step is there after a kill, and each resume ends in the same findings."""
    monkeypatch.setenv("OMP_NUM_THREADS", "1")
    # Processes begin as copies of one that has all modules: a kill meets the run at its work.
    context = get_context("forkserver")
    context.set_forkserver_preload(
        [main.__module__, Running.__module__, "rga.inference.networks.training"]
    )
    draw = random.Random(5)
    command = ["run", stream / "model.json", stream / "record.csv"]
    command += ["--settings", stream / "settings.json", "-o"]
    expected = (finished[0] / "findings.json").read_text(encoding="utf-8")
    kills, directories, waiting = 0, 0, 5.0
    while kills < KILLS:
        directory = tmp_path / f"run {directories}"
        directories += 1
        acknowledged = 0
        for _ in range(1000):
            process = context.Process(target=main, args=([*map(str, command), str(directory)],))
            process.start()
            # The last run of all is left to end.
            process.join(draw.uniform(0.0, waiting) if kills < KILLS else None)
            if process.exitcode is None:
                process.kill()
                process.join()
                kills += 1
            else:
                assert process.exitcode == 0
                break
            before, acknowledged = acknowledged, _kept(directory, acknowledged)
            # A machine that is slow to start would never get on: it is granted a little more,
            # and less again when it got on, so that most processes are killed.
            waiting = waiting * 1.1 if acknowledged == before else max(5.0, waiting / 1.2)
        assert (directory / "findings.json").read_text(encoding="utf-8") == expected
        with rga.Twin.open(directory) as twin:
            assert stored_events(twin) == events(finished[1])


def _kept(directory: Path, acknowledged: int) -> int:
    """Steps in the repository: never fewer than before, each with a standing."""
    if not (directory / "twin.sqlite").exists():
        return acknowledged
    steps = 0
    # Killed before the tables were there, it is no repository yet.
    with suppress(InputError), Repository.open(directory, read_only=True) as kept:
        runs = kept.runs()
        steps = runs[0].steps if runs else 0
        if steps:
            log_of(runs[0])
            assert runs[0].kept("standing") is not None
    assert steps >= acknowledged
    return steps


def stored_events(twin: rga.Twin) -> list[tuple[str, int, float | None, float | None]]:
    return [(e.kind, e.row, e.gap_before, e.gap_after) for e in twin.history().events]


def test_the_log_has_the_sequence_of_the_paper(finished: tuple[Path, Outcome]) -> None:
    with rga.Twin.open(finished[0]) as twin:
        log = twin.log()
    kinds = [kinds for _, kinds, _ in log]
    for task in ("T1 alarm", "T1 recalibration", "T2 stored", "diagnosis", "version"):
        assert task in kinds
    kinds = [one for one in kinds if one.startswith("Q")]
    # A calibration ends with what it has found of structure and sensors (Q1).
    sequence = ["Q1 R1", "Q2 R2", "Q3 R3", "Q4 R4", "Q1 R1", "Q5 R5"]
    assert kinds[:6] == sequence
    update = [words.startswith("update of the model") for _, _, words in log].index(True)
    later = [one for _, one, _ in log[update:] if one.startswith("Q")]
    assert later[:6] == sequence
    rows = [row for row, what, _ in log if what.startswith("Q")]
    assert rows == sorted(rows)


def test_the_past_stands_as_it_was(finished: tuple[Path, Outcome]) -> None:
    with rga.Twin.open(finished[0]) as twin:
        early = twin.as_of(row=79)
        assert (early.version, early.state.row) == (1, 79)
        assert twin.version > 1
        assert len(early.history().events) < len(twin.history().events)
        assert twin.as_of(time=600.0 * 79).context == early.context


@pytest.mark.parametrize(("level", "kinds"), [("A", set()), ("B", {"alarm", "recalibration"})])
def test_levels_of_integration(
    at_level: Callable[[str], tuple[Path, Outcome]], level: str, kinds: set[str]
) -> None:
    _, outcome = at_level(level)
    found = {event.kind for event in outcome.history.events}
    assert found - {"calibration", "diagnosis", "version"} == kinds
    assert [cause.effect["kind"] for cause in outcome.findings.causes] == ["support_settlement"]


def test_rollback_puts_an_earlier_version_in_force(
    at_level: Callable[[str], tuple[Path, Outcome]], tmp_path: Path
) -> None:
    shutil.copytree(at_level("B")[0], tmp_path, dirs_exist_ok=True)
    with rga.Twin.open(tmp_path) as twin:
        assert twin.version > 1
    rollback(tmp_path, 1)
    with rga.Twin.open(tmp_path) as twin:
        assert twin.version == 1
        assert twin.model.effects.keys() == twin.given.effects.keys()
        assert [one.kind for one in twin.history().events[-2:]] == ["rollback", "command"]
    with pytest.raises(InputError, match="no version 9"):
        rollback(tmp_path, 9)


def test_whatif_answers_from_where_the_twin_stands(finished: tuple[Path, Outcome]) -> None:
    with rga.Twin.open(finished[0]) as twin:
        answer = twin.whatif({"west load": 60.0})
        assert answer.contexts["east load"] == twin.context["east load"]
        far = twin.whatif({"west load": 400.0})
    assert answer.after_ci90 is not None
    low, high = answer.after_ci90.T
    assert (low <= answer.after + 1e-9).all()
    assert (answer.after <= high + 1e-9).all()
    # The settlement that the twin found is not sure, and moves the middle of the span.
    assert high[1] - low[1] > 0
    assert answer.warnings == []
    assert any("outside its range" in warning for warning in far.warnings)
    assert any("no simulated or stored context" in warning for warning in far.warnings)


def test_postgresql_serves_as_well(
    stream: Path, finished: tuple[Path, Outcome], tmp_path: Path
) -> None:
    url = os.environ.get("RGA_TEST_POSTGRES")
    if not url:
        pytest.skip("RGA_TEST_POSTGRES names no server")
    seed = random.SystemRandom().randrange(2**31)
    outcome = run(stream, tmp_path, seed=seed, repository=url, settings={"level": "B"})
    assert not (tmp_path / "twin.sqlite").exists()
    assert [c.effect["kind"] for c in outcome.findings.causes] == ["support_settlement"]


def test_a_record_with_all_contexts_measured_needs_no_network(stream: Path, tmp_path: Path) -> None:
    """Nothing is latent: contexts go as they are measured, and the gap is watched all the same."""
    import polars as pl

    table = pl.read_csv(stream / "record.csv")
    days = np.arange(150) / 24
    loads = {"west load": np.full(150, 30.0), "east load": 29 + 10 * np.cos(2 * days)}
    loaded = table.with_columns(**{name: pl.Series(values) for name, values in loads.items()})
    loaded.head(70).write_csv(tmp_path / "record.csv")
    for name in ("model.json", "settings.json"):
        shutil.copy(stream / name, tmp_path)
    outcome = run(tmp_path, tmp_path / "out")
    assert outcome.history.contexts == ()
    assert outcome.history.gaps.shape == (70, len(outcome.history.record.sensors))
    assert np.isfinite(outcome.history.gaps).all()


def test_a_version_put_in_force_by_hand_is_learned_before_the_run_goes_on(
    stream: Path, tmp_path: Path
) -> None:
    """What was learned under another version infers nothing under this one."""

    def until_named(running: Running) -> None:
        if running.version > 1:
            raise _Stop

    with pytest.raises(_Stop):
        run(stream, tmp_path, watch=until_named)
    rollback(tmp_path, 1)
    outcome = run(stream, tmp_path)
    kinds = [event.kind for event in outcome.history.events]
    assert "rollback" in kinds
    assert np.isfinite(outcome.history.gaps[120:]).mean() > 0.9
    assert [cause.effect["kind"] for cause in outcome.findings.causes] == ["support_settlement"]
