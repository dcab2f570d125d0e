"""TclVariables of a Tcl script: of the whole, and of the procedure at work."""

from collections.abc import Iterator
from contextlib import contextmanager
from typing import Any

from rga.errors import InputError
from rga.importing.scripts.values import Unknown


class TclVariables:
    """Values by name; an array is a table of values."""

    def __init__(self) -> None:
        self.everywhere: dict[str, Any] = {}
        self.here = self.everywhere
        self.shared: set[str] = set()

    @contextmanager
    def inside(self, frame: dict[str, Any]) -> Iterator[None]:
        """TclVariables of a procedure, until it is left."""
        here, shared = self.here, self.shared
        self.here, self.shared = frame, set()
        try:
            yield
        finally:
            self.here, self.shared = here, shared

    def _table(self, name: str) -> tuple[dict[str, Any], str]:
        if name.startswith("::"):
            return self.everywhere, name[2:]
        return (self.everywhere if name in self.shared else self.here), name

    def value(self, name: str, index: Any = None) -> Any:
        """The value of a variable, or of an element of an array; not known where it is not set."""
        if isinstance(index, Unknown):
            return index
        table, plain = self._table(name)
        found = table.get(plain)
        if index is not None:
            found = found.get(index) if isinstance(found, dict) else found
        if found is None or isinstance(found, dict):
            shown = name if index is None else f"{name}({index})"
            return Unknown(f"${shown}, which is not set")
        return found

    def set(self, name: str, value: Any) -> Any:
        """Set a variable, or an element as `name(index)`."""
        plain, _, index = name.partition("(")
        table, plain = self._table(plain)
        if index:
            array = table.setdefault(plain, {})
            if not isinstance(array, dict):
                if isinstance(array, Unknown):
                    return value
                raise InputError(f"{plain!r} is no array", name, "give it another name")
            array[index.removesuffix(")")] = value
        else:
            table[plain] = value
        return value

    def read(self, name: str) -> Any:
        """The value of a name as a command has it: `name` or `name(index)`."""
        plain, _, index = name.partition("(")
        return self.value(plain, index.removesuffix(")") if index else None)

    def exists(self, name: str) -> bool:
        """Whether a name is set."""
        plain, _, index = name.partition("(")
        table, plain = self._table(plain)
        found = table.get(plain)
        if index:
            return isinstance(found, dict) and index.removesuffix(")") in found
        return found is not None

    def array(self, name: str) -> dict[str, Any]:
        """The elements of an array; none where it is not set."""
        table, plain = self._table(name)
        found = table.get(plain)
        return found if isinstance(found, dict) else {}

    def unset(self, name: str) -> None:
        """Forget a variable."""
        table, plain = self._table(name.partition("(")[0])
        if "(" in name:
            self.array(plain).pop(name.partition("(")[2].removesuffix(")"), None)
        else:
            table.pop(plain, None)
