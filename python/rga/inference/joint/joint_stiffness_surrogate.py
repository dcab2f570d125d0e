"""Members that bend beside pinned ones: joints that are not quite pins."""

from rga.model import Model

#: group of the members that bend beside pinned ones, and what of them is left of A and J
BENDING, SLIGHT = "bending beside pins", 1e-6


def with_bending(model: Model) -> Model:
    """The model with a member that bends, and does nothing else, beside each pinned member.

    A share of its stiffness stands for the rigidity of the joints: stiffnesses are linear in it,
    which they are not in springs at the ends of a member.
    """
    bending = {}
    sections = dict(model.sections)
    for name, member in model.members.items():
        section = model.sections[member.section]
        if member.kind == "truss" and min(section.Iy, section.Iz) > 0.0:
            slight = {"A": SLIGHT * section.A, "J": SLIGHT * section.J}
            sections[f"{member.section}, {BENDING}"] = section.model_copy(update=slight)
            changed = {
                "kind": "frame",
                "section": f"{member.section}, {BENDING}",
                "groups": [BENDING, *(f"bending of {group}" for group in member.groups[:1])],
            }
            bending[f"{name}, {BENDING}"] = member.model_copy(update=changed)
    return Model.model_validate(
        {
            **{key: getattr(model, key) for key in Model.model_fields},
            "sections": sections,
            "members": {**model.members, **bending},
        }
    )
