"""What findings advise to measure (`separated_by`), found again among what could be measured."""

from collections.abc import Mapping, Sequence

from rga.experiments.candidates import Added, LoadTest
from rga.findings import Findings


def advised(
    findings: Findings, added: Sequence[Added], tests: Sequence[LoadTest]
) -> tuple[list[int], list[int]]:
    """Numbers of the sensors and of the tests that findings advise.

    What an advice calls by words that are not among them, such as a test with another truck, is
    left out.
    """
    sensors = _named(findings, {one.advice: k for k, one in enumerate(added)})
    return sensors, _named(findings, {one.advice: k for k, one in enumerate(tests)})


def _named(findings: Findings, phrases: Mapping[str, int]) -> list[int]:
    found = []
    for cause in findings.causes:
        held = [phrase for phrase in phrases if f"{phrase} " in f"{cause.separated_by} "]
        if held:
            # A name may begin as another does.
            found.append(phrases[max(held, key=len)])
    return list(dict.fromkeys(found))
