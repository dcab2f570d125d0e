"""Synthetic datasets: contexts drawn over their ranges, and what the sensors show."""

import json
import shutil
from collections.abc import Callable, Iterator
from contextlib import closing, contextmanager
from dataclasses import dataclass
from hashlib import sha256
from importlib.metadata import version
from io import BytesIO
from pathlib import Path

import numpy as np
import polars as pl
import scipy
from threadpoolctl import threadpool_limits

from rga.errors import InputError
from rga.files import CannotWrite, as_file, cannot_write, check_place, check_room, write_whole
from rga.model import Model
from rga.numerics.seeds import as_seed
from rga.one_writer import only_writer
from rga.parallel import finished
from rga.simulation.simulator import Simulator

#: rows of a part: a power of two keeps the sequence of the contexts balanced
CHUNK = 16_384
#: rows that no disk holds
MOST_ROWS = 2**62
ELSEWHERE = "give another place, or make room: what is there is gone on from"


def write_dataset(
    model: Model,
    rows: int,
    path: str | Path,
    *,
    seed: int = 0,
    noise: bool = False,
    workers: int = 1,
    dask: str | None = None,
    progress: Callable[[str, float], None] | None = None,
) -> None:
    """Write a Parquet file of contexts and the sensor values that they give.

    The contexts follow a scrambled Sobol sequence over their ranges. Parts of 16 384 rows are
    written beside the file, in `NAME.parts`; a call that was interrupted goes on behind the last
    whole part, and the file appears when all are there. Memory holds one part a worker. The columns
    are the context variables, then the sensors, in the units of the model; seed, hash of the model
    and versions stand in the metadata of the file.

    Args:
        model: the model to simulate.
        rows: number of rows.
        path: the Parquet file.
        seed: of the sequence and of the noise.
        noise: adds to every reading the noise that the model states for its sensor.
        workers: processes at work on this machine; the file does not depend on it.
        dask: address of the scheduler of a Dask cluster, whose workers do the work instead; they
            need rga, and no file of ours.
        progress: is called with the stage and the share done.

    Raises:
        InputError: the model has no context variable or sensor, rows is not positive, the place
            cannot be written to or has no room for it, or there is no cluster.
    """
    if rows < 1:
        raise InputError(f"{rows} rows are no dataset", "rows", "ask for at least one")
    if not model.context or not model.sensors:
        raise InputError(
            "a dataset needs context variables and sensors", f"model {model.name!r}", "add them"
        )
    for name, effect in model.effects.items():
        if effect.remembers:
            raise InputError(
                f"{effect.kind} follows what came before, and rows of a dataset have no order",
                f"effect {name!r}",
                "leave it out, or simulate contexts that follow each other",
            )
    path, seed = as_file(path), as_seed(seed)
    if path.is_dir():
        raise CannotWrite("the output cannot be written, it is a directory", str(path))
    check_place(path)
    metadata = {
        "seed": str(seed),
        "noise": str(noise).lower(),
        "model": model.name,
        "model_sha256": model.sha256,
        **{f"version_{name}": version(name) for name in ("rga", "numpy", "scipy")},
    }
    parts = path.with_name(f"{path.name}.parts")
    if not parts.exists():
        # The parts and the whole, of numbers that hardly compress.
        columns = len(model.context) + len(model.sensors)
        check_room(path, 16.0 * min(rows, MOST_ROWS) * columns)
    content = [repr(model), metadata, rows, CHUNK]
    tasks = [
        _Part(model, seed, noise, begin, min(CHUNK, rows - begin))
        for begin in range(0, rows, CHUNK)
    ]
    with _written(path), only_writer(path):
        _begin(parts, sha256(json.dumps(content).encode()).hexdigest())
        waiting = [task for task in tasks if not task.is_in(parts)]
        done = len(tasks) - len(waiting)
        workers = min(workers, max(len(waiting), 1))
        simulated = finished(_Part.simulate, waiting, workers=workers, dask=dask)
        with closing(simulated), _nothing_left(parts):
            for number, (task, part) in enumerate(simulated, start=done + 1):
                write_whole({task.file(parts): part.result()})
                if progress is not None:
                    progress("simulating", number / len(tasks))
        draft = parts / "whole.parquet"
        frames = pl.scan_parquet([task.file(parts) for task in tasks], low_memory=True)
        frames.sink_parquet(draft, metadata=metadata, maintain_order=True)
        draft.replace(path)
        shutil.rmtree(parts)


@dataclass(frozen=True)
class _Part:
    """Rows of a dataset that are simulated together; a worker may share no disk with us."""

    model: Model
    seed: int
    noise: bool
    begin: int
    rows: int

    def file(self, parts: Path) -> Path:
        """Its place in the directory of parts."""
        return parts / f"{self.begin:012}.parquet"

    def is_in(self, parts: Path) -> bool:
        """Whether the file is there and has its rows."""
        try:
            rows = pl.scan_parquet(self.file(parts)).select(pl.len()).collect().item()
        except (OSError, pl.exceptions.PolarsError):
            return False
        return bool(rows == self.rows)

    def simulate(self) -> bytes:
        """A Parquet file."""
        file = BytesIO()
        with threadpool_limits(1):
            self._frame().write_parquet(file)
        return file.getvalue()

    def _frame(self) -> pl.DataFrame:
        model = self.model
        low, high = np.array([variable.range for variable in model.context.values()]).T
        sequence = scipy.stats.qmc.Sobol(len(model.context), scramble=True, rng=self.seed)
        if self.begin:
            sequence.fast_forward(self.begin)
        # A whole power of two is drawn for the balance of the sequence; the surplus is left out.
        share = sequence.random(1 << (self.rows - 1).bit_length())[: self.rows]
        contexts = dict(zip(model.context, (low + (high - low) * share).T, strict=True))
        readings = Simulator(model).predict(contexts)
        if self.noise:
            spread = np.array([sensor.noise or 0.0 for sensor in model.sensors.values()])
            generator = np.random.default_rng([self.seed, 1, self.begin])
            readings = readings + spread * generator.standard_normal(readings.shape)
        return pl.DataFrame({**contexts, **dict(zip(model.sensors, readings.T, strict=True))})


def _begin(parts: Path, key: str) -> None:
    """A directory for parts; those of another dataset are thrown away."""
    told = parts / "dataset.json"
    if told.exists() and told.read_text(encoding="utf-8") == key:
        return
    shutil.rmtree(parts, ignore_errors=True)
    parts.mkdir(parents=True)
    told.write_text(key, encoding="utf-8")


@contextmanager
def _nothing_left(parts: Path) -> Iterator[None]:
    """Where no part could be made, there is nothing to go on from."""
    try:
        yield
    except BaseException:
        if not any(parts.glob("*.parquet")):
            shutil.rmtree(parts, ignore_errors=True)
        raise


@contextmanager
def _written(place: Path) -> Iterator[None]:
    try:
        place.parent.mkdir(parents=True, exist_ok=True)
        yield
    except OSError as error:
        raise CannotWrite(cannot_write(error, place).what, str(place), ELSEWHERE) from None
    except pl.exceptions.ComputeError as error:
        words = str(error).partition("\n")[0]
        raise CannotWrite(f"the output cannot be written: {words}", str(place), ELSEWHERE) from None
