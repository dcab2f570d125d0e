"""What causes and verdicts call for, in words."""

from collections.abc import Mapping
from typing import Any

from rga.model.effect import Effect
from rga.report.drawing.places import place_names

#: what a verdict calls for, beside what its causes call for
BY_VERDICT = {
    "nothing_wrong": "Nothing needs doing: the model as it is predicts this record. What these "
    "data could not have shown stands below.",
    "named": "What each cause calls for stands with it.",
    "ambiguous": "First separate the causes from their rivals: what would do so stands with each. "
    "Until then act on the one that is worse for the structure.",
    "partial": "What each cause calls for stands with it. Something is left that no kind explains: "
    "what it follows stands below, and the log-odds are less sure than they look.",
    "unknown": "Do not use the model for what it gets wrong here until the reason is known. Where "
    "it shows, when, and what it goes with stand below: look at the structure, the sensors and the "
    "log book there and then.",
    "unidentifiable": "Measure more: what was sought cannot show in these data.",
}
#: and where nothing is wrong, yet something is not ruled out
NOT_RULED_OUT = (
    "The model as it is predicts this record. Look at what is not ruled out at the next "
    "inspection, and measure more there if it would matter."
)
#: what a place is a part of, and what stands before its name
PARTS = ("member", "group", "support", "sensor", "context", "effect", "material")
OF = {"member": "member ", "group": "the group ", "effect": "the load "}


def actions(effect: Mapping[str, Any], *, crossed: bool = True) -> list[tuple[str, str]]:
    """What an effect calls for: what sort of action, and in words.

    Args:
        effect: keys and values of a cause.
        crossed: whether loads drive across the structure.

    >>> actions({"kind": "sensor_bias", "sensor": "S1"})[0]
    ('inspect', 'the fixing of sensor S1')
    """
    kind = Effect.vocabulary.get(str(effect.get("kind")), Effect)
    return kind.action.at(_where(effect), crossed=crossed)


def _where(effect: Mapping[str, Any]) -> str:
    """The place in a sentence."""
    names: dict[str, list[str]] = {}
    for of, name in place_names(dict(effect)):
        names.setdefault(of, []).append(name)
    said = [
        f"{OF.get(of, '')}{' and '.join(some)}" if of in PARTS else f"({', '.join(some)})"
        for of, some in names.items()
        if of != "point"
    ]
    if points := names.get("point"):
        said.append(f"at point{'s' * (len(points) > 1)} {' and '.join(points)}")
    return " ".join(said) or "all channels"
