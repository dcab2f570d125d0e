"""Zeros of the logger that nobody declared, or that it took again on the way."""

from collections.abc import Iterator

from rga.checking.finding import Finding
from rga.checking.measured import Measured
from rga.diagnosis.preparation.zeros.undeclared_zeros import with_own_zeros


def zeros(measured: Measured) -> Iterator[Finding]:
    """Channels that look zeroed though no zero is declared, and jumps of many of them at once.

    Where contexts had to be guessed nothing is told of it: they would take up what zeros do.
    """
    found = with_own_zeros(measured.model, measured.over.simulator, measured.few, measured.data)
    for words in [*found.warnings, *found.doubts]:
        yield Finding(
            "warning",
            "zeros of the record",
            words,
            'declare it: zero = [from, to] in import.toml, or "zero" of the sensors in the model',
        )
