"""What classes of the vocabulary say of their kinds: for its page in the docs, and the schema."""

import inspect
import sys
from collections.abc import Iterable, Iterator
from itertools import groupby
from typing import Any, Literal, get_args, get_origin

from rga.model.effect import Effect

FIRST, LAST = "<!-- kinds -->\n", "<!-- end of kinds -->\n"
#: what stands for the place of a cause in an entry
PLACE = "*place*"


def kind_text(kind: type[Effect]) -> str:
    """What a kind is: its docstring without the attributes, a line a paragraph."""
    paragraphs = _docstring(kind)[0].split("\n\n")
    return "\n\n".join(" ".join(paragraph.split()) for paragraph in paragraphs)


def field_texts(kind: type[Effect]) -> dict[str, str]:
    """What the keys of a kind in a model file mean; without those that all kinds have.

    >>> from rga.model import Effect
    >>> field_texts(Effect.vocabulary["bearing_friction"])["mu"]
    'coefficient of friction [-]; 0 does nothing'
    """
    own = [name for name in kind.model_fields if name not in Effect.model_fields]
    attributes = _docstring(kind)[1]
    return {name: "; ".join(_said(kind, name, attributes.get(name, ""))) for name in own}


def entry(kind: type[Effect]) -> str:
    """The entry of a kind, in Markdown."""
    lines = [f"- `{name}`: {text}" for name, text in field_texts(kind).items()]
    if kind.usual:
        lines.append(f"- usual size: {kind.usual}")
    if kind.action is not Effect.action:
        said = (f"*{sort}* {text}" for sort, text in kind.action.at(PLACE))
        lines.append(f"- advice: {'; '.join(said)}")
    return "\n".join((f"### `{_name(kind)}`", " ".join(kind_text(kind).split()), *lines)) + "\n"


def entries(kinds: Iterable[type[Effect]]) -> str:
    """A table of kinds and their entries in Markdown, by the folders that they stand in."""
    by_name = sorted(kinds, key=_name)
    folders = {
        package: list(inside)
        for package, inside in groupby(sorted(by_name, key=_package), key=_package)
    }
    rows = []
    for package, inside in folders.items():
        named = ", ".join(f"[`{_name(kind)}`](#{_name(kind)})" for kind in inside)
        rows.append(f"| {package.rpartition('.')[2] or 'your own'} | {named} |")
    written = ["\n".join(("| in | kinds |", "|---|---|", *rows)) + "\n"]
    for package, inside in folders.items():
        heading = inspect.getdoc(sys.modules[package]) if package else "Kinds of your own"
        written += [f"## {str(heading).rstrip('.')}", *map(entry, inside)]
    return "\n".join(written)


def updated(page: str) -> str:
    """A page with the entries of all kinds of rga between its marks."""
    before, _, rest = page.partition(FIRST)
    after = rest.partition(LAST)[2]
    own = filter(_package, Effect.vocabulary.values())
    return f"{before}{FIRST}{entries(own)}{LAST}{after}"


def _name(kind: type[Effect]) -> str:
    return str(kind.model_fields["kind"].default)


def _package(kind: type[Effect]) -> str:
    """The package that a kind of rga stands in; nothing for one of the user's."""
    return kind.__module__.rpartition(".")[0] if kind.__module__.startswith("rga.") else ""


def _said(kind: type[Effect], name: str, attribute: str) -> Iterator[str]:
    """Parts of what is said of a key."""
    words = [f"`{word}`" for word in _choices(kind.model_fields[name].annotation)]
    choices = f"one of {', '.join(words)}" if words else ""
    if name in kind.parameters():
        mark = kind.parameters()[name]
        yield attribute if "[" in attribute else f"{attribute} [{mark.unit}]".lstrip()
        if mark.neutral is not None:
            yield f"{mark.neutral:g} does nothing"
        return
    if name in kind.place_fields():
        of = kind.place_fields()[name].of
        yield ", ".join(filter(None, ("place", of, choices)))
    elif choices:
        yield choices
    if attribute:
        yield attribute


def _choices(annotation: Any) -> Iterator[str]:
    """Words among which a type leaves the choice."""
    if get_origin(annotation) is Literal:
        yield from get_args(annotation)
    else:
        for part in get_args(annotation):
            yield from _choices(part)


def _docstring(kind: type[Effect]) -> tuple[str, dict[str, str]]:
    """The text of a class, and what it says of its attributes, by name."""
    text, _, listed = inspect.cleandoc(kind.__doc__ or "").partition("\n\nAttributes:\n")
    attributes: dict[str, str] = {}
    name = ""
    for line in listed.splitlines():
        if line.startswith(" " * 8):
            attributes[name] += f" {line.strip()}"
        else:
            name, _, said = line.strip().partition(": ")
            attributes[name] = said
    return text, {name: said.rstrip(".") for name, said in attributes.items()}
