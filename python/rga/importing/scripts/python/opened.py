"""What a script may use of the libraries that it names."""

from abc import ABC, abstractmethod
from typing import Any

from rga.importing.scripts.values import Trust, Unknown


class Opened(ABC):
    """A module, class, object or function that stands for one of a library.

    Attributes:
        trust: what it may do to the model; "model": it is the model, or a part of it.
    """

    trust: Trust = "computes"

    @abstractmethod
    def attribute(self, name: str) -> Any:
        """What a name of it is; `Unknown` where it is not known."""

    def call(self, values: list[Any], named: dict[str, Any], where: str) -> Any:
        """What calling it gives.

        Raises:
            InputError: its arguments do not fit.
        """
        return Unknown("the result of a library")


class Anything(Opened):
    """Something of which nothing is known but what it may do, nor of what it gives."""

    def __init__(self, name: str, trust: Trust = "computes") -> None:
        self.name, self.trust = name, trust

    def attribute(self, name: str) -> Any:
        return Anything(f"{self.name}.{name}", self.trust)

    def call(self, values: list[Any], named: dict[str, Any], where: str) -> Any:
        return Unknown(f"the result of {self.name}", self.trust)


class OpenedNames(Opened):
    """A module as a table of its names."""

    def __init__(self, name: str, names: dict[str, Any]) -> None:
        self.name, self.names = name, names

    def attribute(self, name: str) -> Any:
        return self.names.get(name, Anything(f"{self.name}.{name}"))
