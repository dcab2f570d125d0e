"""Values of a script, and arguments of its commands."""

from collections.abc import Sequence
from typing import Any, Literal

from rga.errors import InputError
from rga.importing.numerals import float_of

#: steps that a script may take: the loops of any model of a structure
MOST_STEPS = 200_000
#: characters of the longest text, and items of the longest list
LONGEST = 300_000
#: characters or items that weigh as much as a step
WEIGHT = 2_000


#: what a thing that is not followed may do: show whatever it is given; compute, and leave alone
#: what it is not given; run code of its own; or it is a part of the model itself
Trust = Literal["shows", "computes", "foreign", "model"]


class Unknown:
    """A value that only running the script would give.

    Attributes:
        reason: what gives it, for an error.
        trust: what calling it may do.
    """

    def __init__(self, reason: str, trust: Trust = "computes") -> None:
        self.reason, self.trust = reason, trust


class Steps:
    """Counts the steps of a script, so that none goes on for ever."""

    def __init__(self) -> None:
        self.taken = 0

    def take(self, where: str, size: int = 0) -> None:
        """One more step, or as many as a value of a size weighs.

        Raises:
            InputError: there were too many.
        """
        self.taken += 1 + size // WEIGHT
        if self.taken > MOST_STEPS:
            raise InputError(
                f"the script takes more than {MOST_STEPS} steps",
                where,
                "give the part that builds the structure",
            )


def checked_size(value: Any, where: str) -> Any:
    """A value that is not too long, nor too large a number.

    Raises:
        InputError: it is.
    """
    if isinstance(value, str | list | tuple | dict | set) and len(value) > LONGEST:
        raise InputError("a value grows beyond bounds", where, "write it out")
    if isinstance(value, int) and abs(value) > 2**63:
        raise InputError("a number grows beyond bounds", where, "write it out")
    return value


class Arguments:
    """Arguments of a command, taken one by one.

    Args:
        command: as an error names it.
        values: texts, numbers, and what is not known.
        where: the command stands.
        named: arguments given by name.
    """

    def __init__(
        self,
        command: str,
        values: Sequence[Any],
        where: str,
        named: dict[str, Any] | None = None,
    ) -> None:
        self.command, self.where = command, where
        self.left = list(values)
        self.named = dict(named or {})

    def error(self, what: str) -> InputError:
        """An error about this command."""
        return InputError(f"{self.command}: {what}", self.where, "see how the command is written")

    def take(self, what: str) -> Any:
        """The next value.

        Raises:
            InputError: there is none, or it is not known.
        """
        if not self.left:
            raise self.error(f"its {what} is missing")
        return self.known(self.left.pop(0), what)

    def known(self, value: Any, what: str) -> Any:
        """A value that is known."""
        if isinstance(value, Unknown):
            raise InputError(
                f"{self.command}: its {what} cannot be evaluated, it is {value.reason}",
                self.where,
                "write the number in its place",
            )
        return value

    def word(self, what: str) -> str:
        """The next value as a word."""
        return str(self.take(what))

    def tag(self, what: str) -> str:
        """The next value as a whole number, in words."""
        number = self.number(what)
        if number != int(number):
            raise self.error(f"its {what} is {number:g}, no whole number")
        return str(int(number))

    def number(self, what: str) -> float:
        """The next value as a number."""
        return self.as_number(self.take(what), what)

    def as_number(self, value: Any, what: str) -> float:
        """A value as a number."""
        known = self.known(value, what)
        try:
            number = float_of(known)
        except ValueError:
            raise self.error(f"its {what} is {known!r}, no number") from None
        if number != number or abs(number) > 1e300:
            raise self.error(f"its {what} is {number}, no number")
        return number

    def numbers(self, what: str, least: int = 0) -> list[float]:
        """All numbers up to the next word that is none."""
        found: list[float] = []
        while self.left and is_number(self.left[0]):
            found.append(self.number(what))
        if len(found) < least:
            # Names the value that is no number, or says that it is missing.
            self.number(what)
        return found

    def option(self, name: str, count: int | None, what: str) -> list[float] | None:
        """Numbers after an option, which is taken out; None where it is not given.

        Args:
            count: how many; None: all that follow.
        """
        for place, value in enumerate(self.left):
            if value == name:
                tail = Arguments(self.command, self.left[place + 1 :], self.where)
                if count is None:
                    found = tail.numbers(what)
                else:
                    found = [tail.number(what) for _ in range(count)]
                self.left[place:] = tail.left
                return found
        return None

    def flag(self, name: str) -> bool:
        """Whether a word is given, which is taken out."""
        if name in self.left:
            self.left.remove(name)
            return True
        return False

    def peek(self) -> Any:
        """The next value, which stays; None where there is none."""
        return self.left[0] if self.left else None


def is_number(value: Any) -> bool:
    """Whether a value is a number, or is not known and so may be one."""
    if isinstance(value, Unknown):
        return True
    if isinstance(value, bool) or not isinstance(value, str | int | float):
        return False
    try:
        float_of(value)
    except ValueError:
        return False
    return True
