"""What a user names as a record: a file, several, a folder, a mapping."""

import csv
from collections.abc import Collection, Sequence
from glob import has_magic
from os.path import normpath
from pathlib import Path
from typing import Any

from rga.errors import InputError, kind_of
from rga.records.mapping import MAPPING_NAME, RecordMapping, find_mapping, read_mapping

#: letters of a header
MOST_HEADER = 1_000_000


def named_files(given: object) -> list[Path]:
    """The paths that a user names as a record.

    Raises:
        InputError: this is neither a path nor several.
    """
    several: Sequence[Any] = given if isinstance(given, (list, tuple)) else [given]
    wrong = [one for one in several if not isinstance(one, (str, Path))]
    if wrong:
        raise InputError(
            f"{kind_of(wrong[0])} is nothing that a record is read from",
            "record",
            "give the path of a file, several, a folder, or a data frame of polars or pandas",
        )
    return [Path(one) for one in several]


def find_sources(
    places: Sequence[Path],
    model: Path | None,
    mapping: str | Path | RecordMapping | None,
    names: Collection[str] = (),
) -> tuple[list[Path], RecordMapping]:
    """The files of a record, and its mapping.

    Args:
        places: a file, several in time, a pattern such as "2024-*.csv", a folder with an
            `import.toml` that names its files, or an `import.toml`.
        model: file of the model, beside which a mapping may stand.
        mapping: the mapping, or its file; None: beside the record, else beside the model, if any.
        names: of sensors and contexts of the model, by which its own records are known.

    Raises:
        InputError: a file or the mapping is missing, or a folder does not say what its files are.
    """
    if not places:
        raise InputError("no file is named", "record", "name a file, several, or a folder")
    first = places[0]
    whole = len(places) == 1 and (first.is_dir() or first.suffix.lower() == ".toml")
    if whole and first.suffix.lower() == ".toml" and not first.is_dir():
        mapping = mapping or first
    if not isinstance(mapping, RecordMapping):
        inside = first / MAPPING_NAME if first.is_dir() else first
        found = mapping or find_mapping(inside, model)
        stated = read_mapping(found) if found else RecordMapping()
        is_beside = mapping is None and not whole
        mapping = RecordMapping() if is_beside and _is_of_others(stated, places, names) else stated
    if not whole:
        return [path for place in places for path in _matching(place)], mapping
    folder = mapping.folder if mapping.folder != Path() or not first.is_dir() else first
    if not mapping.files:
        held = sorted(p.name for p in folder.iterdir() if p.is_file() and p.suffix != ".toml")
        shown = ", ".join(held[:8]) + (" ..." if len(held) > 8 else "")
        raise InputError(
            "nothing says which files are the record",
            str(first),
            f'state files = ["..."] in {MAPPING_NAME} there; the folder holds {shown or "none"}',
        )
    return files_in(folder, mapping.files), mapping


def _is_of_others(mapping: RecordMapping, places: Sequence[Path], names: Collection[str]) -> bool:
    """Whether a mapping is of a logger's files, and these are records that rga wrote."""
    if "time" in mapping.time.columns:
        return False
    return all(_is_own_record(path, names) for place in places for path in _matching(place))


def _is_own_record(path: Path, names: Collection[str]) -> bool:
    """Whether a file looks as `Record.write` leaves it: `time`, then sensors and contexts."""
    import polars as pl

    try:
        if path.suffix.lower() == ".parquet":
            columns = list(pl.read_parquet_schema(path))
        else:
            with path.open(encoding="utf-8", newline="") as file:
                columns = next(csv.reader([file.readline(MOST_HEADER)]), [])
    except (OSError, UnicodeDecodeError, csv.Error, pl.exceptions.PolarsError):
        return False
    return columns[:1] == ["time"] and len(columns) > 1 and set(columns[1:]) <= set(names)


def files_in(folder: Path, names: Sequence[str]) -> list[Path]:
    """Files that a mapping names, in its folder.

    Raises:
        InputError: a pattern fits none.
    """
    return [path for name in names for path in _matching(Path(normpath(folder / name)))]


def _matching(place: Path) -> list[Path]:
    if place.exists() or not has_magic(str(place)):
        return [place]
    base = Path(place.anchor) if place.is_absolute() else Path()
    parts = place.relative_to(base) if place.is_absolute() else place
    found = sorted(path for path in base.glob(str(parts)) if path.is_file())
    if not found:
        raise InputError("no file has a name like this", str(place), "correct the pattern")
    return found
