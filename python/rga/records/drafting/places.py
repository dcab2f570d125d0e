"""The members and nodes that the names of columns tell of."""

import re
import unicodedata
from collections.abc import Mapping

from rga.model import Model

#: words of a name, folded
Words = tuple[str, ...]
#: members and nodes of a model by the words of their names
Places = Mapping[Words, frozenset[str]]


def words_of(name: str) -> Words:
    """Words of a name, without what people write in different ways.

    >>> words_of("Weg L02 (Träger)"), words_of("S_L3-L4")
    (('weg', 'l2', 'trager'), ('s', 'l3', 'l4'))
    """
    plain = unicodedata.normalize("NFKD", name).encode("ascii", "ignore").decode().lower()
    return tuple(
        re.sub(r"(?<![0-9])0+(?=[0-9])", "", word) for word in re.findall("[a-z0-9]+", plain)
    )


def places_of(model: Model) -> Places:
    """Members and nodes of a model, by the words of their names."""
    found: dict[Words, frozenset[str]] = {}
    for name in (*model.nodes, *model.members):
        words = words_of(name)
        found[words] = found.get(words, frozenset()) | {name}
    found.pop((), None)
    return found


def named_places(column: str, places: Places) -> frozenset[str]:
    """Members and nodes that the name of a column has in it, the longest of those that overlap.

    >>> places = {("l3",): frozenset({"L3"}), ("l3", "l4"): frozenset({"L3-L4"})}
    >>> named_places("DMS L3-L4", places), named_places("Weg L3 [mm]", places)
    (frozenset({'L3-L4'}), frozenset({'L3'}))
    """
    words, longest = words_of(column), max(map(len, places), default=0)
    found: frozenset[str] = frozenset()
    first = 0
    while first < len(words):
        for last in range(min(len(words), first + longest), first, -1):
            if words[first:last] in places:
                found |= places[words[first:last]]
                first = last - 1
                break
        first += 1
    return found


def is_number(place: str) -> bool:
    """Whether a place is but a number, as channels of a logger have them too."""
    return all(word.isdigit() for word in words_of(place))
