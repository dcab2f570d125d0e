"""The same rows, cut anyhow, fed twice, and in processes that are killed: the same bits?"""

import os
import shutil
import signal
import tempfile
from collections.abc import Iterator
from dataclasses import dataclass
from itertools import pairwise
from multiprocessing import get_context
from pathlib import Path

import numpy as np

import rga
from rga.twin.history import History
from rga.twin.runner import Running
from rga_bench.endless.stream import Progress, Stream, settings

#: rows of a run that is cut, and of one whose processes are killed
CUT, KILLED = 300, 1_000
#: mean time that a process lives after it has begun to play [s]
LIFE = 0.4


@dataclass(frozen=True)
class SameBits:
    """What came of runs that were disturbed.

    Attributes:
        what: how they were.
        times: how often.
        runs: that they were.
        rows: of each.
        lost, doubled: rows that were acknowledged and are not there, or are there twice.
        differing: runs that ended otherwise than undisturbed.
    """

    what: str
    times: int
    runs: int
    rows: int
    lost: int
    doubled: int
    differing: int


def cuts(times: int, seed: int, progress: Progress) -> SameBits:
    """Runs whose rows come in pieces at random, some twice, the twin now and then closed."""
    stream = _stream(seed)
    draw = np.random.default_rng(seed)
    wanted, differing, lost, doubled = _undisturbed(stream, CUT), 0, 0, 0
    for number in range(times):
        progress(number / times)
        with tempfile.TemporaryDirectory() as folder:
            place = Path(folder)
            twin = stream.twin(place)
            for first, end in _pieces(draw):
                twin.feed(stream.rows(max(0, first - int(draw.integers(0, 30))), end))
                if draw.random() < 0.7:
                    twin.play()
                if draw.random() < 0.2:
                    twin.close()
                    twin = rga.LiveTwin(place)
            twin.play()
            history = twin.twin.history()
            twin.close()
        differing += not _same(history, wanted)
        lost += max(0, CUT - len(history.record))
        doubled += len(history.record) - len(set(history.record.time.tolist()))
    return SameBits("cut at random", times, times, CUT, lost, doubled, differing)


def kills(times: int, seed: int, progress: Progress) -> SameBits:
    """Runs whose processes are killed at random while they feed and play."""
    stream = _stream(seed)
    draw = np.random.default_rng([seed, 1])
    wanted, killed, runs, lost, doubled, differing = _undisturbed(stream, KILLED), 0, 0, 0, 0, 0
    # Processes begin as copies of one that has all modules: a kill meets them at their work.
    context = get_context("forkserver")
    context.set_forkserver_preload([_feed.__module__, Running.__module__])
    while killed < times:
        with tempfile.TemporaryDirectory() as folder:
            place, acknowledged = Path(folder) / "twin", Path(folder) / "acknowledged"
            acknowledged.write_bytes(b"")
            runs += 1
            while True:
                process = context.Process(target=_feed, args=(stream, place, acknowledged))
                process.start()
                process.join(float(draw.exponential(LIFE)) + 0.2 if killed < times else None)
                if process.exitcode is not None:
                    break
                assert process.pid is not None
                os.kill(process.pid, signal.SIGKILL)
                process.join()
                killed += 1
                progress(killed / times)
            with rga.LiveTwin(place) as twin:
                history = twin.twin.history()
            fed = acknowledged.stat().st_size
            shutil.rmtree(place)
        lost += max(0, fed - len(history.record))
        doubled += len(history.record) - len(set(history.record.time.tolist()))
        differing += not _same(history, wanted)
    return SameBits("killed at random", killed, runs, KILLED, lost, doubled, differing)


def _feed(stream: Stream, place: Path, acknowledged: Path) -> None:
    """Feed what was not acknowledged, note every row that was, and play."""
    with stream.twin(place) as twin, acknowledged.open("ab") as note:
        first = note.tell()
        while first < KILLED:
            end = min(first + 37, KILLED)
            twin.feed(stream.rows(first, end))
            note.write(b"." * (end - first))
            note.flush()
            first = end
            twin.play()
        twin.play()


def _stream(seed: int) -> Stream:
    clock = settings(10, calibration_rows=60, settle=30, policy="time", interval=150)
    return Stream(12, 10, clock, seed)


def _undisturbed(stream: Stream, rows: int) -> History:
    with tempfile.TemporaryDirectory() as folder, stream.twin(Path(folder)) as twin:
        twin.feed(stream.rows(0, rows))
        twin.play()
        return twin.twin.history()


def _pieces(draw: np.random.Generator) -> Iterator[tuple[int, int]]:
    inside = np.sort(draw.choice(np.arange(1, CUT), int(draw.integers(0, 25)), replace=False))
    return pairwise([0, *inside.tolist(), CUT])


def _same(one: History, other: History) -> bool:
    arrays = ("inferred", "spread", "simulated", "gaps", "noise")
    pairs = [(getattr(one, name), getattr(other, name)) for name in arrays]
    pairs.append((one.record.readings, other.record.readings))
    return (
        all(np.array_equal(a, b, equal_nan=True) for a, b in pairs)
        and one.events == other.events
        and one.versions == other.versions
        and one.growth == other.growth
    )
