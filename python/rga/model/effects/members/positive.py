"""Factors on stiffnesses, which have to leave some."""

from rga.errors import InputError
from rga.model.effect import Effect


def positive(effect: Effect, factor: float, remedy: str = "give a factor above 0") -> None:
    """InputError where a factor on a stiffness is not positive."""
    if not factor > 0:
        raise InputError(
            f"the factor {factor:g} leaves no stiffness", f"{effect.kind} of {effect.place}", remedy
        )
