"""`rga schema` and the program agree: what one describes, the other reads."""

import json
from collections.abc import Iterator
from pathlib import Path
from typing import Any

import jsonschema
import pytest
from pydantic import BaseModel

from rga.errors import InputError, SeveralMistakes
from rga.operation.configuration import Configuration
from rga.operation.feeding.faults import Faults
from rga.settings_files import validated

#: a file of a service without any durations, with a source of each kind
SERVICE: dict[str, Any] = {
    "twin": [
        {
            "name": "a",
            "model": "a.json",
            "settings": "settings.toml",
            "source": [
                {"kind": "http"},
                {"kind": "mqtt", "url": "mqtt://broker:1883", "topics": ["a/#"]},
                {"kind": "folder", "path": "logger"},
                {"kind": "sql", "url": "postgresql://plant/x", "table": "t", "position": "id"},
                {"kind": "opcua", "url": "opc.tcp://plant:4840", "nodes": {"D1": "ns=2;s=D1"}},
            ],
        }
    ],
    "notify": [{"url_file": "mail.secret"}],
}
#: by the class that reads it, the least of each file
FILES: dict[type[BaseModel], dict[str, Any]] = {Configuration: SERVICE, Faults: {}}
#: fields that are written in words
WORDS = {
    Configuration: {
        "every", "lateness", "patience", "raw", "false_alarms", "tolerance", "backlog", "poll",
        "lag", "on", "off", "at_most",
    },
    Faults: {"out_of_order_by", "late_by"},
}  # fmt: skip


def places(
    content: Any, schema: Any, definitions: Any
) -> Iterator[tuple[dict[str, Any], str, dict[str, Any]]]:
    """Fields that are written in words, with their tables, made where they are left out.

    Gives the table, the name of the field, and what the schema says of it.
    """
    if "$ref" in schema:
        schema = definitions[schema["$ref"].rpartition("/")[2]]
    if "oneOf" in schema:
        kind = schema["discriminator"]["mapping"][content["kind"]]
        schema = definitions[kind.rpartition("/")[2]]
    if schema.get("type") == "array":
        for one in content:
            yield from places(one, schema["items"], definitions)
    for name, field in schema.get("properties", {}).items():
        words = next((one for one in (field, *field.get("anyOf", ())) if "examples" in one), None)
        if words is not None:
            yield content, name, field | words
        elif "$ref" in field:
            yield from places(content.setdefault(name, {}), field, definitions)
        elif isinstance(content.get(name), list):
            yield from places(content[name], field, definitions)


@pytest.mark.parametrize("kind", FILES)
def test_what_the_schema_gives_as_default_or_example_is_read(kind: type[BaseModel]) -> None:
    schema, content = kind.model_json_schema(), json.loads(json.dumps(FILES[kind]))
    found = list(places(content, schema, schema.get("$defs", {})))
    assert {name for _, name, _ in found} == WORDS[kind]
    for table, name, field in found:
        for written in (*field["examples"], field.get("default")):
            if written is not None:
                table[name] = written
                jsonschema.validate(content, schema)
                validated(kind, content, "here", "file")
        del table[name]


@pytest.mark.parametrize("kind", FILES)
def test_what_the_schema_gives_as_table_is_read(kind: type[BaseModel]) -> None:
    schema, content = kind.model_json_schema(), json.loads(json.dumps(FILES[kind]))
    for name, field in schema["properties"].items():
        if name not in content and field.get("default") is not None:
            content[name] = field["default"]
    validated(kind, content, "here", "file")


@pytest.mark.parametrize("kind", FILES)
def test_a_number_is_a_duration_for_neither(kind: type[BaseModel]) -> None:
    schema, content = kind.model_json_schema(), json.loads(json.dumps(FILES[kind]))
    for table, name, _ in places(content, schema, schema.get("$defs", {})):
        table[name] = 1800
        with pytest.raises(jsonschema.ValidationError):
            jsonschema.validate(content, schema)
        with pytest.raises((InputError, SeveralMistakes), match=r"1800 is no (duration|rate)"):
            validated(kind, content, "here", "file")
        del table[name]


def test_a_bound_is_told_as_the_writer_writes() -> None:
    content = json.loads(json.dumps(SERVICE))
    content["twin"][0]["retention"] = {"raw": "1 d"}
    with pytest.raises(InputError, match=r"retention\.raw: it is 1 d, and at least 7 d is needed"):
        validated(Configuration, content, str(Path("serve.toml")), "configuration")
