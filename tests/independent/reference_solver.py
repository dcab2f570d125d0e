"""A slow, independent solver of verification cases: dense, in decimal numbers of 50 digits.

It shares nothing with the package and goes other ways than the core: members by the force method
(flexibility of a cantilever held at the first node), restraints by Lagrange multipliers.
"""

from collections.abc import Mapping, Sequence
from decimal import Decimal, getcontext
from typing import Any, NamedTuple

getcontext().prec = 50

Vector = list[Decimal]
Matrix = list[Vector]
Json = Mapping[str, Any]

DOFS = ("ux", "uy", "uz", "rx", "ry", "rz")
FORCES = ("fx", "fy", "fz", "mx", "my", "mz")
ZERO, ONE = Decimal(0), Decimal(1)


def number(value: Any) -> Decimal:
    return Decimal(str(value))


def three(values: Sequence[Any]) -> Vector:
    return [number(value) for value in [*values, 0, 0][:3]]


def dot(a: Vector, b: Vector) -> Decimal:
    return sum((x * y for x, y in zip(a, b, strict=True)), ZERO)


def cross(a: Vector, b: Vector) -> Vector:
    return [a[i - 2] * b[i - 1] - a[i - 1] * b[i - 2] for i in range(3)]


def unit(a: Vector) -> Vector:
    size = dot(a, a).sqrt()
    return [value / size for value in a]


def solve(matrix: Matrix, right: Vector) -> Vector:
    """Gaussian elimination with row pivots."""
    rows = [[*row, value] for row, value in zip(matrix, right, strict=True)]
    size = len(rows)
    for column in range(size):
        pivot = max(range(column, size), key=lambda row: abs(rows[row][column]))
        rows[column], rows[pivot] = rows[pivot], rows[column]
        top = rows[column]
        for row in rows[column + 1 :]:
            if row[column]:
                factor = row[column] / top[column]
                rest = zip(row[column:], top[column:], strict=True)
                row[column:] = [a - factor * b for a, b in rest]
    result = [ZERO] * size
    for index in reversed(range(size)):
        known = dot(rows[index][index + 1 : size], result[index + 1 :])
        result[index] = (rows[index][size] - known) / rows[index][index]
    return result


class Member:
    """A member as a cantilever: what its second end does under forces there and under loads."""

    def __init__(self, element: Json, start: Vector, end: Vector, plane: bool) -> None:
        along = [b - a for a, b in zip(start, end, strict=True)]
        self.length = dot(along, along).sqrt()
        self.beam = element["type"] == "beam"
        x = unit(along)
        given = element.get("local_y") or ([-x[1], x[0], 0] if plane or not self.beam else None)
        if not self.beam and not any(given or []):
            given = [0, 1, 0]
        assert given is not None, "a beam in space needs local_y"
        z = unit(cross(x, three(given)))
        self.axes = [x, cross(z, x), z]
        self.ea = number(element["E"]) * number(element["A"])
        self.turn = number(element.get("G", 1)) * number(element.get("J", 1))
        self.bend = [number(element["E"]) * number(element.get(key, 1)) for key in ("Iz", "Iy")]
        self.shear = [
            ONE / (number(element["G"]) * number(element[key])) if key in element else ZERO
            for key in ("Asy", "Asz")
        ]
        self.fixed_end = [ZERO] * 12
        self.stiffness = self._stiffness()

    def free_motion(self, axis: int, at: Decimal) -> Vector:
        """Of the second end, under a unit force (axis 0..2) or moment (3..5) at a place."""
        motion, rest = [ZERO] * 6, self.length - at
        if axis in (0, 3):
            motion[axis] = at / (self.ea if axis == 0 else self.turn)
            return motion
        plane = 0 if axis in (1, 5) else 1
        ei, sign = self.bend[plane], 1 - 2 * plane  # a slope dw/dx is -ry
        if axis < 3:
            slope = at**2 / (2 * ei)
            motion[axis] = at**3 / (3 * ei) + slope * rest + at * self.shear[plane]
            motion[5 - plane] = sign * slope
        else:
            motion[5 - plane] = at / ei
            motion[1 + plane] = sign * (at**2 / (2 * ei) + at / ei * rest)
        return motion

    def at_first(self, axis: int, at: Decimal) -> Vector:
        """What holds the cantilever at its first end against that unit force or moment."""
        held = [ZERO] * 6
        held[axis] = -ONE
        if axis == 1:
            held[5] = -at
        if axis == 2:
            held[4] = at
        return held

    def _stiffness(self) -> Matrix:
        if not self.beam:
            size = self.ea / self.length
            bar = [[ZERO] * 12 for _ in range(12)]
            bar[0][0] = bar[6][6] = size
            bar[0][6] = bar[6][0] = -size
            return bar
        columns = [self.free_motion(axis, self.length) for axis in range(6)]
        flexibility = transpose(columns)
        held = [self.at_first(axis, self.length) for axis in range(6)]
        # By virtual work, `held` also says how far a rigid motion of the first end leaves the
        # second end behind.
        columns = []
        for motion in [*transpose(held), *identity(6)]:
            far = solve(flexibility, motion)
            columns.append([*(dot(far, row) for row in transpose(held)), *far])
        return transpose(columns)

    def load(self, axis: int, at: Decimal, size: Decimal) -> None:
        """Adds a point load."""
        if not self.beam:
            share = at / self.length
            self.fixed_end[axis] -= size * (1 - share)
            self.fixed_end[axis + 6] -= size * share
            return
        self._hold([size * value for value in self.free_motion(axis, at)])
        for dof, value in enumerate(self.at_first(axis, at)):
            self.fixed_end[dof] += size * value

    def spread(self, axis: int, low: Decimal, high: Decimal, first: Decimal, last: Decimal) -> None:
        """Adds a linear load, by Boole's rule: exact to degree 5, and deflections that are cubic in
        the place, times a linear load, have degree 4."""
        step = (high - low) / 4
        for index, weight in enumerate((7, 32, 12, 32, 7)):
            size = first + (last - first) * index / 4
            self.load(axis, low + index * step, size * step * weight * 2 / 45)

    def heat(self, strain: Decimal, gradients: Sequence[Decimal]) -> None:
        """Adds a free axial strain and its gradients along local y and z."""
        motion = [strain * self.length, *[ZERO] * 5]
        for plane, gradient in enumerate(gradients):
            motion[1 + plane] = -gradient * self.length**2 / 2
            motion[5 - plane] = -(1 - 2 * plane) * gradient * self.length
        self._hold(motion)

    def _hold(self, motion: Vector) -> None:
        """Adds the end forces that take back a free motion of the second end."""
        for dof, row in enumerate(self.stiffness):
            self.fixed_end[dof] -= dot(row[6:], motion)

    def to_local(self, motion: Vector) -> Vector:
        parts = [motion[first : first + 3] for first in (0, 3, 6, 9)]
        return [dot(axis, part) for part in parts for axis in self.axes]

    def to_global(self, local: Vector) -> Vector:
        parts = [local[first : first + 3] for first in (0, 3, 6, 9)]
        return [dot(axis, part) for part in parts for axis in transpose(self.axes)]

    def end_forces(self, motion: Vector) -> Vector:
        local = self.to_local(motion)
        return [
            dot(row, local) + held for row, held in zip(self.stiffness, self.fixed_end, strict=True)
        ]


def identity(size: int) -> Matrix:
    return [[ONE if i == j else ZERO for j in range(size)] for i in range(size)]


def transpose(matrix: Matrix) -> Matrix:
    return [list(column) for column in zip(*matrix, strict=True)]


class Restraint(NamedTuple):
    """A sum over dofs that has a value: of a support, or of a tie, which is no reaction."""

    terms: dict[int, Decimal]
    value: Decimal
    supports: bool


class Frame:
    """A case under one of its load cases: stiffness, forces and restraints of all dofs."""

    def __init__(self, case: Json, load_case: Json) -> None:
        self.plane = case["dim"] == 2
        self.first = {str(name): 6 * index for index, name in enumerate(case["nodes"])}
        self.size = 6 * len(self.first)
        self.stiffness = [[ZERO] * self.size for _ in range(self.size)]
        self.forces = [ZERO] * self.size
        self.to_ground = [ZERO] * self.size
        points = {str(name): three(point) for name, point in case["nodes"].items()}
        self.members: dict[str, Member] = {}
        self.places: dict[str, list[int]] = {}
        for element in case["elements"]:
            name, ends = str(element["id"]), [str(node) for node in element["nodes"]]
            self.members[name] = Member(element, points[ends[0]], points[ends[1]], self.plane)
            self.places[name] = [self.first[node] + dof for node in ends for dof in range(6)]
        for load in load_case.get("element_loads") or []:
            apply(self.members[str(load["element"])], load)
        for load in load_case.get("nodal_loads") or []:
            for dof, key in enumerate(FORCES):
                self.forces[self.first[str(load["node"])] + dof] += number(load.get(key, 0))
        for name in self.members:
            self._add_member(name)
        for spring in case.get("springs") or []:
            self._add_spring(spring)
        self.restraints = [*self._held(case, load_case), *self._inclined(case, load_case)]
        for tie in case.get("ties") or []:
            for other in tie["nodes"][1:]:
                for dof in tie["dofs"]:
                    one, two = self.dof(tie["nodes"][0], dof), self.dof(other, dof)
                    self.restraints.append(Restraint({one: ONE, two: -ONE}, ZERO, False))

    def dof(self, node: Any, name: str) -> int:
        return self.first[str(node)] + DOFS.index(name)

    def _add_member(self, name: str) -> None:
        member, place = self.members[name], self.places[name]
        for column, motion in zip(place, identity(12), strict=True):
            local = [dot(row, member.to_local(motion)) for row in member.stiffness]
            for row, value in zip(place, member.to_global(local), strict=True):
                self.stiffness[row][column] += value
        for row, value in zip(place, member.to_global(member.fixed_end), strict=True):
            self.forces[row] -= value

    def _add_spring(self, spring: Json) -> None:
        k = number(spring["k"])
        ends = [self.dof(node, spring["dof"]) for node in spring.get("nodes") or [spring["node"]]]
        for row in ends:
            for column in ends:
                self.stiffness[row][column] += k if row == column else -k
        if len(ends) == 1:
            self.to_ground[ends[0]] += k

    def _held(self, case: Json, load_case: Json) -> list[Restraint]:
        """Supports, and what nothing stiffens or what leaves the plane."""
        moved = {
            self.dof(entry["node"], entry["dof"]): number(entry["value"])
            for entry in load_case.get("prescribed") or []
        }
        named = {self.dof(each["node"], dof) for each in case["supports"] for dof in each["dofs"]}
        out_of_plane = {dof for dof in range(self.size) if self.plane and dof % 6 in (2, 3, 4)}
        idle = {dof for dof, row in enumerate(self.stiffness) if not any(row)}
        held = sorted(named | out_of_plane | idle | moved.keys())
        return [Restraint({dof: ONE}, moved.get(dof, ZERO), True) for dof in held]

    def _inclined(self, case: Json, load_case: Json) -> list[Restraint]:
        pushed = {
            str(entry["node"]): number(entry["value"])
            for entry in load_case.get("prescribed_inclined") or []
        }
        found = []
        for support in case.get("inclined_supports") or []:
            node = str(support["node"])
            normal = enumerate(unit(three(support["direction"])), start=self.first[node])
            terms = {dof: cosine for dof, cosine in normal if cosine}
            found.append(Restraint(terms, pushed.get(node, ZERO), True))
        return found

    def solve(self) -> tuple[Vector, Vector]:
        """Motions and reactions of all dofs; the restraints' multipliers are their forces."""
        count = len(self.restraints)
        matrix = [[*row, *[ZERO] * count] for row in self.stiffness]
        matrix += [[ZERO] * (self.size + count) for _ in range(count)]
        for index, restraint in enumerate(self.restraints, start=self.size):
            for dof, factor in restraint.terms.items():
                matrix[dof][index] = matrix[index][dof] = factor
        values = [restraint.value for restraint in self.restraints]
        answer = solve(matrix, [*self.forces, *values])
        motions, multipliers = answer[: self.size], answer[self.size :]
        reactions = [-k * motion for k, motion in zip(self.to_ground, motions, strict=True)]
        for restraint, multiplier in zip(self.restraints, multipliers, strict=True):
            for dof, factor in restraint.terms.items() if restraint.supports else ():
                reactions[dof] -= factor * multiplier
        return motions, reactions


def solve_case(case: Json, load_case: Json) -> list[Decimal]:
    """The values that the expectations of a load case are about, in their order."""
    frame = Frame(case, load_case)
    motions, reactions = frame.solve()

    def value(entry: Json) -> Decimal:
        if entry["kind"] == "displacement":
            return motions[frame.dof(entry["node"], entry["dof"])]
        if entry["kind"] == "reaction":
            return reactions[frame.dof(entry["node"], entry["dof"])]
        name = str(entry["element"])
        ends = frame.members[name].end_forces([motions[dof] for dof in frame.places[name]])
        return ends[6] if entry["kind"] == "axial" else ends[entry["index"]]

    return [value(entry) for entry in load_case["expected"]]


def apply(member: Member, load: Json) -> None:
    """An element load as it stands in the file."""
    match load["kind"]:
        case "uniform":
            sizes = [number(load.get(key, 0)) for key in ("wx", "wy", "wz")]
            if "w_global" in load:
                sizes = [
                    size + dot(axis, three(load["w_global"]))
                    for size, axis in zip(sizes, member.axes, strict=True)
                ]
            for axis, size in enumerate(sizes):
                member.spread(axis, ZERO, member.length, size, size)
        case "trapezoid":
            ends = [number(load[key]) for key in ("x1", "x2", "w1", "w2")]
            member.spread("xyz".index(load["axis"]), *ends)
        case "point":
            for axis, key in enumerate(("Px", "Py", "Pz", "Mx", "My", "Mz")):
                if key in load:
                    member.load(axis, number(load["x"]), number(load[key]))
        case "thermal":
            alpha = number(load["alpha"])
            gradients = [alpha * number(load.get(key, 0)) for key in ("grad_y", "grad_z")]
            member.heat(alpha * number(load.get("dT", 0)), gradients)
        case "initial_elongation":
            member.heat(number(load["value"]) / member.length, (ZERO, ZERO))
