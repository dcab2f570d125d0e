"""Doubts on their way to a reader: those of one kind are told together."""

from dataclasses import dataclass, field


@dataclass
class Doubts:
    """Doubts, in the order in which their kinds came up.

    >>> doubts = Doubts()
    >>> for name in "ab":
    ...     doubts.add("column {} is empty", "columns {} are empty", name, "x.csv")
    >>> for file in ("x.csv", "y.csv"):
    ...     doubts.add("no stamp has a zone", where=file)
    >>> doubts.told()
    ['x.csv: columns a, b are empty', 'x.csv, y.csv: no stamp has a zone']
    """

    _found: dict[tuple[str, str, str], tuple[list[str], list[str]]] = field(default_factory=dict)

    def add(self, one: str, several: str = "", name: str = "", where: str = "") -> None:
        """A doubt.

        Args:
            one: in words, {} for the name.
            several: the same of several names; left out, it names none.
            name: of what is doubted.
            where: the file.
        """
        kind = one, several, where if name else ""
        names, places = self._found.setdefault(kind, ([], []))
        names += [name] if name and name not in names else []
        places += [where] if where and where not in places else []

    def told(self) -> list[str]:
        """All of them, in words."""
        said = []
        for (one, several, _), (names, places) in self._found.items():
            text = several if len(names) > 1 else one
            if names:
                text = text.replace("{}", ", ".join(names), 1)
            said.append(f"{', '.join(places)}: {text}" if places else text)
        return said
