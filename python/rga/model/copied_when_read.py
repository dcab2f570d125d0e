"""Arrays by name that a copy shares until it reads them."""

from typing import Any

from numpy.typing import NDArray


class CopiedWhenRead(dict[str, NDArray[Any]]):
    """Arrays of another structure, each copied when it is first read: an effect needs few of them.

    What is not read the core knows to be the same.

    Args:
        arrays: cannot be written any more from now on, by anyone.
    """

    def __init__(self, arrays: dict[str, NDArray[Any]]) -> None:
        super().__init__(arrays)
        for array in arrays.values():
            array.flags.writeable = False
        self._shared = set(arrays)

    def __getitem__(self, name: str) -> NDArray[Any]:
        if name in self._shared:
            self[name] = super().__getitem__(name).copy()
        return super().__getitem__(name)

    def __setitem__(self, name: str, array: NDArray[Any]) -> None:
        self._shared.discard(name)
        super().__setitem__(name, array)
