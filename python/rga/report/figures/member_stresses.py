"""What the causes mean for the stresses of members: a table."""

from collections.abc import Mapping
from dataclasses import dataclass

from rga.diagnosis.member_forces import IDLE
from rga.diagnosis.member_stresses import MemberStress
from rga.quantities import DASH, fixed, number, percent

#: what is added to a stress, over the largest of all, that is not worth a sentence
GROWS = 0.01


@dataclass(frozen=True)
class StressTable:
    """The table of stresses in the heaviest row.

    Attributes:
        utilised: whether a yield strength is stated for one of the members.
        lines: member, moment as given and with causes [kN m], stress as given and with causes
            [MPa], their ratio, and the share of the section that is left; then the utilisation as
            given and with causes.
        lost: whether a member has lost a share of its section.
    """

    utilised: bool
    lines: list[list[str]]
    lost: bool


def consequence(stresses: Mapping[str, tuple[MemberStress, MemberStress]]) -> str:
    """The member to whose stress most is added, in a sentence; empty where it is too little."""
    heaviest = max((abs(given.stress) for given, _ in stresses.values()), default=0.0)
    added = {
        name: abs(extended.stress) - abs(given.stress)
        for name, (given, extended) in stresses.items()
    }
    if not added or max(added.values()) <= GROWS * heaviest:
        return ""
    name = max(added, key=lambda one: added[one])
    given, extended = stresses[name]
    by = ""
    if abs(given.stress) > IDLE * heaviest:
        by = f" by {percent(100 * added[name] / abs(given.stress), sign=False)},"
    said = (
        f"The stress of {name} grows{by} from {number(abs(given.stress) / 1e6)} to "
        f"{number(abs(extended.stress) / 1e6)} MPa"
    )
    if given.utilisation is None or extended.utilisation is None:
        return said + "."
    shares = (
        percent(100 * one.utilisation, sign=False) for one in (given, extended) if one.utilisation
    )
    return f"{said}: from {' to '.join(shares)} of its yield strength."


def stress_table(stresses: Mapping[str, tuple[MemberStress, MemberStress]]) -> StressTable:
    """Stresses as given and with the causes, member by member."""
    heaviest = max((abs(given.stress) for given, _ in stresses.values()), default=0.0)
    bent = max((max(one.moment for one in pair) for pair in stresses.values()), default=0.0)
    utilised = any(given.utilisation is not None for given, _ in stresses.values())

    def moment(value: float) -> str:
        return number(value / 1e3) if value > 1e-6 * bent else DASH

    lines = []
    for name, (given, extended) in stresses.items():
        idle = abs(given.stress) <= IDLE * heaviest
        line = [
            name,
            *(moment(one.moment) for one in (given, extended)),
            *(number(one.stress / 1e6) for one in (given, extended)),
            DASH if idle else fixed(extended.stress / given.stress, 2),
            DASH if extended.left == 1.0 else percent(100 * extended.left, sign=False),
        ]
        if utilised:
            line += [
                DASH if one.utilisation is None else percent(100 * one.utilisation, sign=False)
                for one in (given, extended)
            ]
        lines.append(line)
    return StressTable(
        utilised, lines, any(extended.left < 1.0 for _, extended in stresses.values())
    )
