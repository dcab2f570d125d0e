"""Loads along members."""

from typing import Annotated, Literal

from pydantic import model_validator

from rga.model.effect import Effect, Values
from rga.model.parameter import NotNegative, Number, Parameter, Place, Value, listed
from rga.model.structure import Load, Spread, Structure

LOCAL = ("x", "y", "z")


class MemberLoad(Effect):
    """A load along a member, in its local axes: uniform, trapezoidal or at a point.

    Attributes:
        uniform: [wx, wy, wz] over the whole member [N/m].
        axis: along which a trapezoid acts.
        trapezoid: [x1, x2, w1, w2]: from x1 to x2 [m], growing from w1 to w2 [N/m].
        point: [Px, Py, Pz] at x from the first node [N].
        x: place of the point load [m].
        factor: on the load.
    """

    kind: Literal["member_load"] = "member_load"
    is_load = True
    loads_by_geometry = True
    member: Annotated[str | list[str], Place("member")]
    uniform: tuple[Number, Number, Number] | None = None
    axis: Literal["x", "y", "z"] = "y"
    trapezoid: tuple[Number, Number, Number, Number] | None = None
    point: tuple[Number, Number, Number] | None = None
    x: NotNegative = 0.0
    factor: Annotated[Value, Parameter("-", 0.0)] = 1.0

    @model_validator(mode="after")
    def _one_shape(self) -> "MemberLoad":
        given = [shape for shape in (self.uniform, self.trapezoid, self.point) if shape is not None]
        if len(given) != 1:
            raise ValueError("give exactly one of 'uniform', 'trapezoid' and 'point'")
        return self

    def loads(self, structure: Structure, values: Values, others: dict[str, Values]) -> list[Load]:
        spread = structure.once_for_geometry(lambda: self._spread(structure), self)
        return [Load(values["factor"], spread=spread, permanent=not self.drivers())]

    def _spread(self, structure: Structure) -> list[Spread]:
        spread: list[Spread] = []
        for name in listed(self.member):
            member = structure.members[name]
            length = float(structure.lengths[member])
            if self.uniform is not None:
                spread += [(member, a, 0.0, length, w, w) for a, w in enumerate(self.uniform) if w]
            elif self.trapezoid is not None:
                x1, x2, w1, w2 = self.trapezoid
                spread.append((member, LOCAL.index(self.axis), x1, x2, w1, w2))
            elif self.point is not None:
                spread += [
                    (member, a, self.x, self.x, p, 0.0) for a, p in enumerate(self.point) if p
                ]
        return spread
