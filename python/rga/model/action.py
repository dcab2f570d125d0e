"""What a cause calls for: where to inspect, which gauge to check, how to test by loading."""

from dataclasses import dataclass

#: the load of most tests, of a structure that loads cross, and of another
VEHICLE = "a heavy vehicle of known weight, at rest at several places"
WEIGHT = "a heavy known weight, at rest at several places"


@dataclass(frozen=True)
class Action:
    """What to do about a cause; empty where there is nothing.

    In each text `{place}` stands for the place of the cause, and `{load}` for the load of a test: a
    heavy vehicle of known weight, or where nothing drives on the structure another weight.

    Attributes:
        inspect: what to look at on the structure.
        check: which gauge, figure or drawing to check.
        test: which loading or measurement would confirm it.
    """

    inspect: str = ""
    check: str = ""
    test: str = ""

    def at(self, place: str, *, crossed: bool = True) -> list[tuple[str, str]]:
        """What sort of action, and in words, at a place.

        Args:
            place: in words.
            crossed: whether loads drive across the structure.

        >>> Action(check="the zero of {place}").at("sensor S1")
        [('check', 'the zero of sensor S1')]
        """
        return [
            (sort, text.format(place=place, load=VEHICLE if crossed else WEIGHT))
            for sort, text in (
                ("inspect", self.inspect),
                ("check", self.check),
                ("test", self.test),
            )
            if text
        ]
