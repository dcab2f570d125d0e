"""Results on the disk: whole or not at all."""

import json
import secrets
import shutil
from collections.abc import Iterator
from contextlib import contextmanager
from pathlib import Path
from typing import Any

import typer

from rga.errors import InputError
from rga.files import CannotWrite, as_file, cannot_write, check_place


@contextmanager
def whole_file(path: Path) -> Iterator[Path]:
    """A temporary file beside `path` to write to, which takes its place at the end.

    Raises:
        InputError: the place cannot be written to.
    """
    if path.is_dir():
        raise InputError("the output is a directory", str(path), "give a file")
    check_place(path)
    with _scratch(path) as scratch:
        draft = scratch / path.name
        yield draft
        draft.replace(path)


@contextmanager
def whole_directory(path: Path) -> Iterator[Path]:
    """A temporary directory to write to, which becomes `path` at the end.

    Files of a directory that exists are replaced one by one; its other files stay.

    Raises:
        InputError: the place cannot be written to.
    """
    if path.exists() and not path.is_dir():
        raise InputError("the output is a file", str(path), "give a directory")
    with _scratch(path) as scratch:
        # The current directory has no name.
        draft = scratch / "draft"
        draft.mkdir()
        yield draft
        if not path.exists():
            draft.rename(path)
            return
        for file in sorted(draft.rglob("*")):
            target = path / file.relative_to(draft)
            if file.is_dir():
                target.mkdir(exist_ok=True)
            else:
                check_place(target)
                file.replace(target)


def check_targets(*targets: str | None) -> None:
    """Refuse targets of JSON that would replace what was read, before the work is done.

    Raises:
        CannotWrite: one would, or is a device or a pipe.
    """
    for target in targets:
        if target is not None and target != "-":
            check_place(as_file(target))


def write_json(content: Any, target: str) -> None:
    """Write JSON to a file, or to the standard output where the target is "-"."""
    text = json.dumps(content, indent=1, allow_nan=False) + "\n"
    if target == "-":
        typer.echo(text, nl=False)
        return
    with whole_file(as_file(target)) as draft:
        draft.write_text(text, encoding="utf-8")


@contextmanager
def _scratch(path: Path) -> Iterator[Path]:
    """A temporary directory beside `path`, removed at the end."""
    # Its name is known before it is there: a signal may come as soon as it is.
    scratch = path.absolute().parent / f".rga-{secrets.token_hex(8)}"
    try:
        scratch.parent.mkdir(parents=True, exist_ok=True)
        scratch.mkdir(mode=0o700)
        yield scratch
    except CannotWrite as error:
        raise CannotWrite(error.what, str(path)) from error
    except OSError as error:
        raise cannot_write(error, path) from error
    finally:
        shutil.rmtree(scratch, ignore_errors=True)
