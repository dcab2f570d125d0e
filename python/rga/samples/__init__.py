"""Samples that are shipped: a structure, what was measured of it, and a cause that is hidden.

They are made by `python -m rga_bench.samples`, whose physics are not those of the simulator.
"""

import io
from importlib.resources import files
from zipfile import ZipFile

from rga.errors import InputError

SAMPLE_NAMES = ("footbridge", "roof", "portal", "mast", "crane")


def sample_files(name: str) -> dict[str, bytes]:
    """The files of a sample by name: model, record or modes, what it is, and the answer.

    Raises:
        InputError: there is no such sample.

    >>> list(sample_files("roof"))
    ['README.txt', 'answer.txt', 'import.toml', 'logger.csv', 'model.json']
    """
    if name not in SAMPLE_NAMES:
        known = ", ".join(SAMPLE_NAMES)
        raise InputError(f"there is no sample {name!r}", "rga example", f"use {known}")
    content = files(__package__).joinpath(f"{name}.zip").read_bytes()
    with ZipFile(io.BytesIO(content)) as archive:
        return {file: archive.read(file) for file in archive.namelist()}
