"""What docs/reference/http-api.md says of every path, written from the OpenAPI of a service.

    python tools/http_api.py

What stands above that on the page is written by hand.
"""

import re
from collections.abc import Iterator
from pathlib import Path
from typing import Any

from fastapi import FastAPI

from rga.dashboard.app import add_routes

PAGE = Path(__file__).parents[1] / "docs" / "reference" / "http-api.md"
MARK = "<!-- paths: python tools/http_api.py -->\n"
#: what every path of a service may answer, which stands above them on the page
EVERYWHERE = {"400", "401", "403", "404", "422", "503"}
_ATTRIBUTE = re.compile(r"^    ([\w, ]+): (.+(?:\n {6,}.+)*)", re.MULTILINE)


def page(written: str) -> str:
    """The page with its paths anew."""
    return "\n".join([written.split(MARK, 1)[0] + MARK, *_sections(_described())])


def _described() -> dict[str, Any]:
    """The OpenAPI of a service, which does not have to run for it."""
    app = FastAPI()
    add_routes(app)
    return app.openapi()


def _sections(api: dict[str, Any]) -> Iterator[str]:
    for path, methods in api["paths"].items():
        for method, one in methods.items():
            yield f"## `{method.upper()} {path}`"
            yield one["description"].split("\n\n")[0].replace("\n", " ")
            yield ""
            yield from _parameters(one.get("parameters", []))
            yield from _body(one.get("requestBody"))
            yield from _answers(one["responses"])
            yield ""
    yield "## What is answered"
    yield ""
    for name, schema in sorted(api["components"]["schemas"].items()):
        yield from _schema(name, schema)


def _parameters(parameters: list[dict[str, Any]]) -> Iterator[str]:
    for one in parameters:
        if one["name"] == "twin" or one["in"] == "cookie":
            continue
        place = "" if one["in"] == "query" else f" ({one['in']})"
        told = f": {one['description']}" if "description" in one else ""
        yield f"- `{one['name']}`{place}, {_kind(one['schema'])}{told}"


def _body(body: dict[str, Any] | None) -> Iterator[str]:
    if body is None:
        return
    for media, content in body["content"].items():
        schema = content.get("schema")
        kinds = [] if schema is None else schema.get("oneOf", [schema])
        if schema is None:
            yield f"- body `{media}`"
        elif all("properties" in one for one in kinds):
            yield f"- body `{media}`, one of"
            for one in kinds:
                yield f"  - {_keys(one)}: {_text(one.get('description', ''))[0]}"
        else:
            yield f"- body `{media}`, {_kind(schema)}"


def _answers(answers: dict[str, Any]) -> Iterator[str]:
    for status, one in sorted(answers.items()):
        if status in EVERYWHERE:
            continue
        kinds = [
            f"`{media}` {_kind(content['schema'])}" if content.get("schema") else f"`{media}`"
            for media, content in one.get("content", {}).items()
        ]
        yield f"- answers {status}: {', '.join(kinds) or 'nothing'}"


def _schema(name: str, schema: dict[str, Any]) -> Iterator[str]:
    text, told = _text(schema.get("description", ""))
    yield f"### {name}"
    yield text
    yield ""
    for key, one in schema.get("properties", {}).items():
        yield f"- `{key}`, {_kind(one)}{f': {told[key]}' if key in told else ''}"
    yield ""


def _keys(schema: dict[str, Any]) -> str:
    """Keys of an object, with what those are that have one value."""
    return ", ".join(
        f"`{key}: {one['const']!r}`" if "const" in one else f"`{key}`"
        for key, one in sorted(schema["properties"].items(), key=lambda pair: pair[0] != "kind")
    )


def _kind(schema: dict[str, Any]) -> str:
    """What a value is, in words."""
    if "$ref" in schema:
        name = schema["$ref"].rpartition("/")[2]
        return f"[{name}](#{name.lower()})"
    if "const" in schema:
        return f"`{schema['const']!r}`"
    if "enum" in schema:
        return " or ".join(f"`{one!r}`" for one in schema["enum"])
    for several in ("anyOf", "oneOf"):
        if several in schema:
            return " or ".join(dict.fromkeys(_kind(one) for one in schema[several]))
    kind = str(schema.get("type", "anything"))
    if kind == "array" and "items" in schema:
        return f"list of {_kind(schema['items'])}"
    if kind == "object" and isinstance(schema.get("additionalProperties"), dict):
        return f"{_kind(schema['additionalProperties'])} by name"
    return f"{kind} ({schema['format']})" if "format" in schema else kind


def _text(docstring: str) -> tuple[str, dict[str, str]]:
    """The text of a docstring in one line, and what it says of attributes."""
    text, _, attributes = docstring.partition("Attributes:\n")
    told: dict[str, str] = {}
    for names, words in _ATTRIBUTE.findall(attributes):
        told |= dict.fromkeys(names.split(", "), " ".join(words.split()))
    return " ".join(text.split()), told


if __name__ == "__main__":
    PAGE.write_text(page(PAGE.read_text(encoding="utf-8")), encoding="utf-8")
