"""What a structure weighs, for whoever knows it from elsewhere, and members without weight."""

from collections.abc import Iterator

from rga.checking.finding import Finding, named, parts
from rga.checking.over_ranges import OverRanges
from rga.model.mass_budget import mass_budget

#: lines of the budget that are told
TOLD = 5
#: what lies beside members over what these weigh, outside of which a unit was mistaken: a bridge
#: deck weighs ten times its girders at the most, and what is stated moves some frequency
USUAL = 1e-3, 100.0


def masses(over: OverRanges) -> Iterator[Finding]:
    """The mass of a model that has masses or modes, part by part; members without density."""
    model = over.model
    if not (model.masses or model.modes):
        return
    light = [
        name
        for name, member in model.members.items()
        if model.materials[member.material].density == 0.0
    ]
    if light and len(light) < len(model.members):
        materials = {model.members[name].material for name in light}
        what = f"material {named(sorted(materials))} has no density, and others have one"
        yield Finding("warning", parts("member", light), what, "give its density [kg/m3]")
    budget = mass_budget(model)
    own, beside = (sum(getattr(one, part) for one in budget) for part in ("members", "beside"))
    if model.masses and own and not USUAL[0] < beside / own < USUAL[1]:
        what = f"masses beside the members are {beside:.3g} kg, the members {own:.3g} kg"
        remedy = "give masses in kg, and those along members in kg/m"
        yield Finding("warning", f"model {model.name!r}", what, remedy)
    total = sum(one.total for one in budget)
    if not total and model.modes:
        return  # effects may bring masses: whether there are modes is looked at with these
    told = [f"{one.of} {one.total / 1000:.3g}" for one in budget[:TOLD]]
    rest = sum(one.total for one in budget[TOLD:])
    told += [f"others {rest / 1000:.3g}"] if rest else []
    yield Finding(
        "note" if total else "warning",
        f"model {model.name!r}",
        f"it weighs {total / 1000:.4g} t: {', '.join(told)}" if total else "nothing has a mass",
        "compare with drawings or bearing loads" if total else "give densities, or masses",
    )
