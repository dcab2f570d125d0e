"""Whether a mass is one that people have, and can leave on the structure."""

from rga.experiments.truck import Truck
from rga.model import Model
from rga.model.effects.loads.load_mass import GRAVITY
from rga.model.mass_budget import mass_budget

#: share of the structure's mass beyond which a parked mass is another structure, and not a test
LARGE = 0.1
#: mass of a full truck [t], and how many can be had for a test
FULL, TRUCKS = 40.0, 4


def mass_of(truck: Truck) -> float:
    """Of a truck, or of weights in its place [t].

    >>> round(mass_of(Truck((60.0, 100.0), (3.5,))), 2)
    16.32
    """
    return sum(truck.loads) / GRAVITY


def impractical(model: Model, truck: Truck, given: bool) -> str | None:
    """In words why a mass is larger than is practical to park; None where it is not.

    Args:
        model: the structure.
        truck: that is left standing.
        given: the user named it, and has it.
    """
    mass = mass_of(truck)
    whole = sum(part.total for part in mass_budget(model)) / 1e3
    reasons = []
    if mass > LARGE * whole:
        reasons.append(f"{mass / whole:.2g} of the {whole:.3g} t that the structure weighs")
    if not given and mass > TRUCKS * FULL:
        reasons.append(f"as much as {mass / FULL:.0f} full trucks")
    if not reasons:
        return None
    return (
        f"the mass of {mass:.3g} t that is to be parked is {', and '.join(reasons)}, which is more "
        f"than is practical: give the truck that there is with --truck ({100 * LARGE:.0f} % of the "
        "structure at most)"
    )
