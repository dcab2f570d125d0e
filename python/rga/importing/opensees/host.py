"""What takes the OpenSees commands of a script: model by model, up to each `wipe`."""

from collections.abc import Collection
from typing import Any

from rga.errors import InputError
from rga.importing.opensees.command_names import NOT_DONE, PASSED_OVER
from rga.importing.opensees.commands import DEFINING, command, start
from rga.importing.opensees.script_model import ScriptModel
from rga.importing.scripts.values import Arguments, Unknown


class OpenSeesHost:
    """Collects the models of a script, and what it says beside them.

    Args:
        without: files that the script reads and that are not needed.

    Attributes:
        models: one for each `model` after a `wipe`.
        passed: commands passed over: name -> places.
        not_done: commands that only running would obey: words and place.
        unread: commands that this reader does not know: words and place.
        unfollowed: code that is not read and may change the model: words and place.
    """

    def __init__(self, without: Collection[str] = ()) -> None:
        self.models: list[ScriptModel] = []
        self.current: ScriptModel | None = None
        self.without = frozenset(without)
        self.passed: dict[str, list[str]] = {}
        self.not_done: list[tuple[str, str]] = []
        self.unread: list[tuple[str, str]] = []
        self.unfollowed: list[tuple[str, str]] = []

    def skips(self, name: str) -> bool:
        """Whether a command is passed over, its words unseen."""
        return name in PASSED_OVER or name in NOT_DONE

    def shapes(self, name: str) -> bool:
        """Whether a command would change the model."""
        return name in DEFINING or name in ("wipe", "model", "source")

    def pass_over(self, name: str, words: str, where: str) -> Any:
        """Pass a command over, and say what its result is."""
        if name in NOT_DONE:
            self.not_done.append((words, where))
        elif name in PASSED_OVER:
            self.passed.setdefault(name, []).append(where)
        else:
            self.unread.append((words, where))
        return Unknown(f"the result of {name}")

    def take(
        self, name: str, values: list[Any], where: str, named: dict[str, Any] | None = None
    ) -> tuple[bool, Any]:
        """Take a command; whether it is known, and its result."""
        given = Arguments(name, values, where, named)
        if name == "wipe":
            self.current = None
        elif name in ("model", "Model"):
            self._begin(given)
        elif name in DEFINING:
            if self.current is None:
                raise InputError(f"{name} stands before `model`", where, "begin with `model`")
            command(self.current, name, given)
        else:
            return False, Unknown(f"the result of {name}")
        self._leftover(given)
        return True, ""

    def _begin(self, given: Arguments) -> None:
        for kind in ("basic", "Basic", "BasicBuilder", "basicBuilder", "BasicModelBuilder"):
            given.flag(kind)
        begun = start(given)
        if self.current is None:
            self.current = begun
            self.models.append(begun)
        elif self.current.nodes and self.current.dimensions != begun.dimensions:
            raise given.error("the number of dimensions changes within a model")
        else:
            # Nodes from here on have other degrees of freedom.
            self.current.dimensions, self.current.freedoms = begun.dimensions, begun.freedoms

    def _leftover(self, given: Arguments) -> None:
        if given.named:
            name = next(iter(given.named))
            raise given.error(f"{name!r} is an argument that this reader does not know")
        if given.left and self.current is not None:
            words = " ".join(
                "?" if isinstance(value, Unknown) else str(value) for value in given.left
            )
            self.current.dropped.append(
                (given.where, f"{given.command}: the words {words[:60]!r} at its end")
            )
