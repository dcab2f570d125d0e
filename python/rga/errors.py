"""Errors that a user meets."""


class InputError(ValueError):
    """Input that cannot be used: what is wrong, where, and how to mend it.

    >>> str(InputError("the unit 'kg' is not one of a strain", "sensor 'S1'", "use microstrain"))
    "the unit 'kg' is not one of a strain (sensor 'S1'): use microstrain"
    """

    def __init__(self, what: str, where: str, remedy: str) -> None:
        self.what, self.where, self.remedy = what, where, remedy
        # The parts are the arguments, so that the error passes from process to process.
        super().__init__(what, where, remedy)

    def __str__(self) -> str:
        return f"{self.what} ({self.where}): {self.remedy}"


class UnstableStructureError(InputError):
    """A structure that can move without resistance, with the node and the direction that move."""
