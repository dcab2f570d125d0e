"""What does not fit together in a model that is being built: all of it at once."""

from collections.abc import Iterator
from typing import Any

from pydantic import ValidationError

from rga.errors import InputError
from rga.model.schema import Model, read_effect

#: mistakes that are told one by one; of more the number is told
MOST = 20


def check_whole(content: dict[str, Any], where: str) -> None:
    """InputError that lists what the parts of a model name and what there is not.

    Args:
        content: of a model file; each part is right by itself.
    """
    found = list(_dangling(content))
    if not found:
        found = list(_unfitting_effects(content))
    if not found:
        return
    told = "; ".join(found[:MOST])
    more = f"; and {len(found) - MOST} more" if len(found) > MOST else ""
    what = told if len(found) == 1 else f"{len(found)} mistakes: {told}{more}"
    raise InputError(what, where, "correct the names, or add what is missing")


def _dangling(content: dict[str, Any]) -> Iterator[str]:
    nodes, members = content["nodes"], content["members"]

    def missing(table: str, named: Any, by: str) -> Iterator[str]:
        if named is not None and named not in content[table]:
            yield f"{by}: there is no {named!r} in {table}"

    touched: set[str] = set()
    for name, member in members.items():
        by = f"member {name!r}"
        for node in member["nodes"]:
            touched.add(node)
            yield from missing("nodes", node, by)
        first, last = member["nodes"]
        if first == last or (first in nodes and nodes[first] == nodes.get(last)):
            yield f"{by}: it has no length"
        yield from missing("sections", member["section"], by)
        if member["material"]:
            yield from missing("materials", member["material"], by)
        else:
            yield f"{by}: it names no material, of which there are {len(content['materials'])}"
    for name, support in content["supports"].items():
        yield from missing("nodes", support["node"], f"support {name!r}")
    for spring in content["springs"]:
        for node in (spring["node"], spring.get("to")):
            touched.add(node)
            yield from missing("nodes", node, "spring")
    for tie in content["ties"]:
        for node in tie["nodes"]:
            touched.add(node)
            yield from missing("nodes", node, "tie")
    for name, mass in content["masses"].items():
        yield from missing("nodes", mass["node"], f"mass {name!r}")
    for name, sensor in content["sensors"].items():
        by = f"sensor {name!r}"
        yield from missing("members", sensor.get("member"), by)
        yield from missing("nodes", sensor.get("node"), by)
        yield from missing("nodes", sensor.get("relative_to"), by)
    for name in sorted(content["sensors"].keys() & content["context"].keys()):
        yield f"sensor {name!r}: a context variable has the same name"
    for name in nodes:
        if name not in touched:
            yield f"node {name!r}: no member ends there"


def _unfitting_effects(content: dict[str, Any]) -> Iterator[str]:
    bare = Model.model_validate({**content, "effects": {}})
    effects = {}
    for name, keys in content["effects"].items():
        try:
            effects[name] = read_effect(keys, name)
        except ValidationError as error:
            first = error.errors(include_url=False)[0]
            key = ".".join(str(part) for part in first["loc"])
            yield f"effect {name!r}: {key} {first['msg'].removeprefix('Value error, ')}"
        except ValueError as error:
            yield f"effect {name!r}: {str(error).removeprefix(f'effects.{name}.')}"
    # Effects may act on one another, so that each is held against the model with all of them.
    whole = bare.model_copy(update={"effects": effects})
    for name, effect in effects.items():
        try:
            whole.check_effect(effect, name)
        except ValueError as error:
            yield f"effect {name!r}: {str(error).removeprefix(name).lstrip('.: ')}"
