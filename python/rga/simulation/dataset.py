"""Synthetic datasets: contexts drawn over their ranges, and what the sensors show."""

from collections.abc import Callable, Iterator
from importlib.metadata import version
from pathlib import Path

import numpy as np
import polars as pl
from polars.io.plugins import register_io_source
from scipy.stats import qmc

from rga.errors import InputError
from rga.model import Model
from rga.simulation.simulator import Simulator

CHUNK = 65_536


def write_dataset(
    model: Model,
    rows: int,
    path: str | Path,
    *,
    seed: int = 0,
    noise: bool = False,
    progress: Callable[[str, float], None] | None = None,
) -> None:
    """Write a Parquet file of contexts and the sensor values that they give.

    The contexts follow a scrambled Sobol sequence over their ranges; memory holds one chunk of
    65 536 rows. The columns are the context variables, then the sensors, in the units of the model;
    seed, hash of the model and versions stand in the metadata of the file.

    Args:
        model: the model to simulate.
        rows: number of rows.
        path: the Parquet file.
        seed: of the sequence and of the noise.
        noise: adds to every reading the noise that the model states for its sensor.
        progress: is called with the stage and the share done.

    Raises:
        InputError: the model has no context variable or sensor, or rows is not positive.
    """
    if rows < 1:
        raise InputError(f"{rows} rows are no dataset", "rows", "ask for at least one")
    if not model.context or not model.sensors:
        raise InputError(
            "a dataset needs context variables and sensors", f"model {model.name!r}", "add them"
        )
    failures: list[InputError] = []

    def frames(*_: object) -> Iterator[pl.DataFrame]:
        done = 0
        try:
            for frame in _chunks(model, rows, seed, noise):
                yield frame
                done += frame.height
                if progress is not None:
                    progress("simulating", done / rows)
        except InputError as error:
            failures.append(error)
            raise

    names = [*model.context, *model.sensors]
    source = register_io_source(io_source=frames, schema=dict.fromkeys(names, pl.Float64()))
    metadata = {
        "seed": str(seed),
        "noise": str(noise).lower(),
        "model": model.name,
        "model_sha256": model.sha256,
        **{f"version_{name}": version(name) for name in ("rga", "numpy", "scipy")},
    }
    try:
        source.sink_parquet(path, metadata=metadata, maintain_order=True)
    except pl.exceptions.PolarsError:
        # The writer wraps what the simulation raises.
        if failures:
            raise failures[0] from None
        raise


def _chunks(model: Model, rows: int, seed: int, noise: bool) -> Iterator[pl.DataFrame]:
    simulator = Simulator(model)
    low, high = np.array([variable.range for variable in model.context.values()]).T
    sequence = qmc.Sobol(len(model.context), scramble=True, rng=seed)
    spread = np.array([sensor.noise or 0.0 for sensor in model.sensors.values()])
    generator = np.random.default_rng([seed, 1])
    # A whole power of two is drawn for the balance of the sequence; the surplus is left out.
    draw = min(CHUNK, 1 << (rows - 1).bit_length())
    for begin in range(0, rows, CHUNK):
        share = sequence.random(draw)[: rows - begin]
        contexts = dict(zip(model.context, (low + (high - low) * share).T, strict=True))
        readings = simulator.predict(contexts)
        if noise:
            readings = readings + spread * generator.standard_normal(readings.shape)
        columns = dict(zip(model.sensors, readings.T, strict=True))
        yield pl.DataFrame({**contexts, **columns})
