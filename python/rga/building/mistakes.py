"""What is wrong with a model that is being built, and what it leaves open: all of it at once."""

from collections.abc import Iterator
from typing import Any

from rga.errors import InputError, SeveralMistakes
from rga.model.io import read_model
from rga.model.schema import Model

REMEDY = "correct the names, or add what is missing"


def read_settled(content: dict[str, Any], where: str) -> Model:
    """The model of what was built.

    Args:
        content: of a model file.
        where: it stands.

    Raises:
        InputError: names that stand for nothing, parts that do not fit each other, members without
            a material, nodes at which nothing ends: all of it.
    """
    found = [*_without_material(content), *_idle_nodes(content)]
    try:
        model = read_model(content, where)
    except InputError as error:
        told = error.mistakes if isinstance(error, SeveralMistakes) else [error.what]
        found = [one for one in told if "there is no '' in materials" not in one] + found
    if not found:
        return model
    if len(found) == 1:
        raise InputError(found[0], where, REMEDY)
    raise SeveralMistakes(found, where, REMEDY)


def _without_material(content: dict[str, Any]) -> Iterator[str]:
    for name, member in content["members"].items():
        if not member["material"]:
            yield f"members.{name}: it names no material, of which there are " + str(
                len(content["materials"])
            )


def _idle_nodes(content: dict[str, Any]) -> Iterator[str]:
    ends = [member["nodes"] for member in content["members"].values()]
    ends += [(spring["node"], spring.get("to")) for spring in content["springs"]]
    ends += [tie["nodes"] for tie in content["ties"]]
    touched = {node for pair in ends for node in pair}
    for name in content["nodes"]:
        if name not in touched:
            yield f"nodes.{name}: no member ends there"
