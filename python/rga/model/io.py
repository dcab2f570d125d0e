"""Reading and writing model files."""

import hashlib
import json
from collections import Counter
from pathlib import Path
from typing import Any

from pydantic import ValidationError

from rga.bounded_files import LARGEST, bytes_of, fault_of, toml_of
from rga.errors import InputError, kind_of
from rga.files import write_whole
from rga.model.mistakes import REMEDY, refusal
from rga.model.schema import Model

#: of a model file, by its ending; JSON by any other
LANGUAGES = {".toml": "TOML", ".yaml": "YAML", ".yml": "YAML"}
#: bytes of a file in one of these, which take seconds a megabyte
SLOWLY_READ = 8 * 2**20
#: values of a YAML file, when what it refers to stands in every place
MOST_VALUES = 10**6
#: of an integer of a YAML file: no number is larger
MOST_BITS = 1024


def load_model(path: str | Path) -> Model:
    """Read a model file (JSON, TOML or YAML).

    Args:
        path: the file; the format follows from its suffix, and is JSON for an unknown one.

    Returns:
        The validated model.

    Raises:
        InputError: the file is missing or unreadable, or breaks the schema; where it does so in
            several places, with all of them (`SeveralMistakes`).
    """
    if not isinstance(path, (str, Path)):
        what = f"{kind_of(path)} is no path of a model file"
        raise InputError(what, "model", "give the path of a JSON, TOML or YAML file")
    path = Path(path)
    raw = bytes_of(path, "model file", SLOWLY_READ if path.suffix.lower() in LANGUAGES else LARGEST)
    try:
        content = _parse(raw, path.suffix.lower())
    except UnicodeDecodeError:
        raise InputError("this is no UTF-8 text", str(path), "save it as UTF-8") from None
    except RecursionError as error:
        raise InputError(fault_of(error), str(path), REMEDY) from None
    except ValueError as error:
        language = LANGUAGES.get(path.suffix.lower(), "JSON")
        raise InputError(
            f"this is no {language} text: {fault_of(error)}", str(path), "mend the syntax"
        ) from None
    model = read_model(content, str(path))
    model._sha256 = hashlib.sha256(raw).hexdigest()
    model._path = path
    return model


def model_of_text(text: str, place: str, sha256: str) -> Model:
    """A model from the text of its file.

    Args:
        text: JSON.
        place: where it was kept, for errors.
        sha256: hash of the file that it was read from first.

    Raises:
        InputError: it is no model.
    """
    model = read_model(json.loads(text), place)
    model._sha256 = sha256
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
        f"{kind_of(given)} is no model", "model", "give a Model, or the path of its file"
    )


def read_model(content: Any, where: str) -> Model:
    """A model from parsed content; InputError with every mistake: key, value, what is right."""
    if not isinstance(content, dict | Model):
        what = "there is nothing in it" if content is None else f"{kind_of(content)} is no model"
        raise InputError(what, where, f"give a table of the parts of a model, {REMEDY}")
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
    modal = content.pop("modal_sensors", {})
    return {**content, "sensors": {**content.get("sensors", {}), **modal}} if modal else content


def _parse(raw: bytes, suffix: str) -> Any:
    text = raw.decode("utf-8-sig")
    language = LANGUAGES.get(suffix)
    if language == "TOML":
        return toml_of(text)
    if language == "YAML":
        try:
            content = _yaml(text)
        except RecursionError:
            raise
        except Exception as error:
            # Of the language, and of values that are not what their tags say.
            told = fault_of(error).replace(' in "<unicode string>",', " in")
            raise ValueError(told) from None
        if _values(content, {}) > MOST_VALUES:
            raise ValueError(f"its aliases make more than {MOST_VALUES} values of it")
        return content
    return json.loads(text, object_pairs_hook=_unique)


def _yaml(text: str) -> Any:
    """What a text in YAML says.

    Raises:
        ValueError: a key stands twice.
        yaml.YAMLError: it is none.
    """
    import yaml

    loader = getattr(yaml, "CSafeLoader", yaml.SafeLoader)(text)
    try:
        root = loader.get_single_node()
        waiting, known = [root], set[int]()
        while waiting:
            node = waiting.pop()
            if id(node) in known:
                continue
            known.add(id(node))
            if isinstance(node, yaml.SequenceNode):
                waiting += node.value
            elif isinstance(node, yaml.MappingNode):
                keys = [(key.tag, key.value) for key, _ in node.value if key.id == "scalar"]
                counts = Counter(keys)
                twice = next((one for one in keys if counts[one] > 1), None)
                if twice is not None:
                    line = node.start_mark.line + 1
                    raise ValueError(f"the key {twice[1]!r} stands twice below line {line}")
                waiting += [one for pair in node.value for one in pair]
        return None if root is None else loader.construct_document(root)
    finally:
        loader.dispose()


def _values(content: Any, counted: dict[int, float]) -> float:
    """How many values there are, those that aliases repeat as often as they stand.

    >>> several = [1, 2]
    >>> _values([several, several], {})
    7
    """
    if isinstance(content, int) and content.bit_length() > MOST_BITS:
        raise ValueError(f"an integer has more than {MOST_BITS} bits")
    if not isinstance(content, dict | list):
        return 1
    if id(content) not in counted:
        # One that holds itself has no end.
        counted[id(content)] = float("inf")
        parts = content.values() if isinstance(content, dict) else content
        counted[id(content)] = 1 + sum(_values(part, counted) for part in parts)
    return counted[id(content)]


def _unique(pairs: list[tuple[str, Any]]) -> dict[str, Any]:
    content = dict(pairs)
    if len(content) < len(pairs):
        names = [name for name, _ in pairs]
        twice = next(name for name in names if names.count(name) > 1)
        raise ValueError(f"the key {twice!r} stands twice")
    return content
