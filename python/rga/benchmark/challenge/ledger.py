"""The ledger of a challenge: a line for every finished draw, so that none is done twice."""

import hashlib
import json
import os
from dataclasses import asdict
from functools import cache
from importlib.metadata import version
from pathlib import Path
from typing import Any

import rga
from rga.benchmark.challenge.judge import Outcome
from rga.errors import InputError

NAME = "outcomes.jsonl"


@cache
def versions() -> dict[str, str]:
    """Versions that an outcome depends on; `code` is the hash of this package as it stands."""
    root = Path(rga.__file__).parent
    content = hashlib.sha256()
    for path in sorted([*root.rglob("*.py"), *root.glob("_core*")]):
        if path.suffix != ".pyi":
            content.update(path.relative_to(root).as_posix().encode() + path.read_bytes())
    return {
        **{name: version(name) for name in ("rga", "numpy", "scipy")},
        "code": content.hexdigest()[:16],
    }


class Ledger:
    """Outcomes in a folder, one JSON object a line.

    Args:
        folder: is made where it is missing.

    Raises:
        InputError: the folder cannot be used, or holds outcomes of other code.
    """

    def __init__(self, folder: Path) -> None:
        self._path = folder / NAME
        try:
            folder.mkdir(parents=True, exist_ok=True)
            self._path.touch()
            text = self._path.read_text(encoding="utf-8")
        except OSError as error:
            reason = (error.strerror or "refused").lower()
            raise InputError(
                f"the outcomes cannot be kept, {reason}", str(folder), "give another place"
            ) from None
        whole = text[: text.rfind("\n") + 1]
        if len(whole) < len(text):
            # The line that an interruption cut off.
            os.truncate(self._path, len(whole.encode()))
        self.outcomes = {
            one.id: one
            for number, line in enumerate(whole.splitlines(), 1)
            for one in (self._read(line, number),)
        }

    def add(self, outcome: Outcome) -> None:
        """Write an outcome down."""
        line = {"versions": versions(), **asdict(outcome)}
        with self._path.open("a", encoding="utf-8") as file:
            file.write(json.dumps(line, allow_nan=False) + "\n")
            file.flush()
            os.fsync(file.fileno())
        self.outcomes[outcome.id] = outcome

    def _read(self, line: str, number: int) -> Outcome:
        where = f"{self._path}, line {number}"
        try:
            content: dict[str, Any] = json.loads(line)
            own = dict(content.pop("versions"))
            if own == versions():
                chances = [(share, right) for share, right in content.pop("chances")]
                return Outcome(**content, chances=chances)
        except (ValueError, TypeError, KeyError, AttributeError):
            raise InputError(
                "this is no outcome of a challenge", where, "give a new folder"
            ) from None
        differs = ", ".join(
            f"{name} {own.get(name)}, now {now}"
            for name, now in versions().items()
            if own.get(name) != now
        )
        raise InputError(
            f"these outcomes are of another version: {differs}", where, "give a new folder"
        )
