"""Reading and writing model files."""

import hashlib
import json
import tomllib
from pathlib import Path
from typing import Any

import yaml
from pydantic import ValidationError

from rga.errors import InputError
from rga.files import write_whole
from rga.model.mistakes import refusal
from rga.model.schema import Model


def load_model(path: str | Path) -> Model:
    """Read a model file (JSON, TOML or YAML).

    Args:
        path: the file; the format follows from its suffix.

    Returns:
        The validated model.

    Raises:
        InputError: the file is missing or unreadable, or breaks the schema; where it does so in
            several places, with all of them (`SeveralMistakes`).
    """
    path = Path(path)
    try:
        raw = path.read_bytes()
    except OSError as error:
        raise InputError(
            "the model file cannot be read", str(path), error.strerror or "check it"
        ) from None
    try:
        content = _parse(raw, path.suffix.lower())
    except (ValueError, yaml.YAMLError, RecursionError) as error:
        problem = " ".join(str(error).split())
        raise InputError(
            f"this is no {path.suffix[1:].upper()} text: {problem}", str(path), "mend the syntax"
        ) from None
    model = read_model(content, str(path))
    model._sha256 = hashlib.sha256(raw).hexdigest()
    model._path = path
    return model


def as_model(given: Model | str | Path) -> Model:
    """A model, read where its file is given.

    Args:
        given: the model, or the path of its file.

    Raises:
        InputError: the file cannot be used, or this is neither.
    """
    if isinstance(given, Model):
        return given
    if isinstance(given, str | Path):
        return load_model(given)
    raise InputError(
        f"a {type(given).__name__} is no model", "model", "give a Model, or the path of its file"
    )


def read_model(content: Any, where: str) -> Model:
    """A model from parsed content; InputError with every mistake: key, value, what is right."""
    try:
        return Model.model_validate(content)
    except ValidationError as error:
        raise refusal(error, content, where) from None


def write_model(model: Model, path: Path) -> None:
    """Write a model file as JSON: to a temporary file, then renamed."""
    write_whole({path: model_text(model).encode()})


def model_text(model: Model) -> str:
    """The model as the text of a JSON file."""
    return json.dumps(model_content(model), indent=1) + "\n"


def model_content(model: Model) -> dict[str, Any]:
    """The model as it stands in a file: keys that have their default are left out.

    An effect keeps what it was given, since one that is given nothing is refused.
    """
    content = model.model_dump(mode="json", exclude_defaults=True)
    content["effects"] = {
        name: {
            "kind": effect.kind,
            **effect.model_dump(mode="json", exclude_defaults=True),
            **effect.model_dump(mode="json", exclude_unset=True),
        }
        for name, effect in model.effects.items()
    }
    for name, member in model.members.items():
        content["members"][name]["kind"] = member.kind
    return content


def _parse(raw: bytes, suffix: str) -> Any:
    text = raw.decode("utf-8-sig")
    if suffix == ".toml":
        return tomllib.loads(text)
    if suffix in (".yaml", ".yml"):
        return yaml.safe_load(text)
    return json.loads(text, object_pairs_hook=_unique)


def _unique(pairs: list[tuple[str, Any]]) -> dict[str, Any]:
    content = dict(pairs)
    if len(content) < len(pairs):
        names = [name for name, _ in pairs]
        twice = next(name for name in names if names.count(name) > 1)
        raise ValueError(f"the key {twice!r} stands twice")
    return content
