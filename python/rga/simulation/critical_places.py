"""Section forces everywhere along members: between two places where loads change they are cubics.

Statics gives them from the forces at the first node and the loads behind a section, so that no
further solve is needed and nothing is missed between stations: the peak under a point load or an
axle, wherever it stands in a row, the jump of V there, and a maximum of M where V is zero.
"""

from collections.abc import Iterator, Sequence
from dataclasses import dataclass

import numpy as np

from rga.arrays import FloatArray
from rga.model.effect import Values
from rga.model.schema import Model
from rga.model.structure import Spread, Structure, build_structure
from rga.simulation.simulator import Simulator

#: places of a piece at which its cubics are known, as shares of its length
NODES = np.array([0.0, 1.0, 2.0, 3.0]) / 3
#: values there -> factors of 1, t, t2, t3
FACTORS = np.linalg.inv(np.vander(NODES, increasing=True)).T
#: numbers of a piece, and those that are worked on at a time
PIECE, AT_ONCE = 6 * len(NODES), 4_000_000
#: digits of a share of a length beyond which two places are one
DIGITS = 12
#: share of the largest value of a member, or of its length, that is no difference in a diagram
FLAT = 1e-9
EVERY = slice(None)
#: a load along a member, and its coefficients, float[rows]
ActingLoad = tuple[FloatArray, Spread]


@dataclass(frozen=True)
class Pieces:
    """Section forces of members, cut where point loads stand and where other loads begin or end.

    Attributes:
        members: their numbers among those that were asked for: one with loads, or some without.
        straight: nothing bends them but their ends, so that no force turns between these.
        places: shares of the length, four of each piece (`NODES`), float[pieces, 4].
        forces: N, Vy, Vz [N], T, My, Mz [N m] there, float[rows, members, pieces, 4, 6].
        rows: those of the forces, among those that were asked for.
    """

    members: list[int]
    straight: bool
    places: FloatArray
    forces: FloatArray
    rows: slice


@dataclass(frozen=True)
class ForcesAlong:
    """Section forces everywhere along members.

    Attributes:
        model: the structure with its effects.
        members: names.
        first: N, Vy, Vz [N], T, My, Mz [N m] at the first nodes, float[rows, members, 6].
        parameters: of all effects, by name, float[rows] each.
        thirds: forces at the thirds of the members, float[rows, members, 2, 6], where the
            equilibrium is that of the deformed structure; else None.
    """

    model: Model
    members: Sequence[str]
    first: FloatArray
    parameters: dict[str, Values]
    thirds: FloatArray | None = None

    def pieces(self, rows: slice = EVERY) -> Iterator[Pieces]:
        """The pieces of every member, in parts of so many rows and members as are few numbers."""
        structure, loads = self._loads(rows)
        first, numbers = self.first[rows], [structure.members[name] for name in self.members]
        thirds = None if self.thirds is None else self.thirds[rows]
        lengths = structure.lengths[numbers]
        plain = [k for k, number in enumerate(numbers) if thirds is None and number not in loads]
        for part in _parts(len(first), 1):
            count = max(1, AT_ONCE // (PIECE * len(first[part])))
            for begin in range(0, len(plain), count):
                chosen = plain[begin : begin + count]
                x = lengths[chosen, None, None] * NODES
                forces = _without_loads(first[part][:, chosen, None, None], x)
                yield Pieces(chosen, True, NODES[None], forces, part)
        for member in sorted(set(range(len(numbers))) - set(plain)):
            own = loads.get(numbers[member], [])
            for part in _parts(len(first), 1 + 2 * len(own)):
                acting = [(share[part], load) for share, load in own if share[part].any()]
                span = _Span(float(lengths[member]), first[part, member], acting)
                places, forces = span.pieces()
                if thirds is not None:
                    forces += _beyond(span, thirds[part, member], places)
                yield Pieces([member], False, places, forces[:, None], part)

    def limits(self, rows: slice = EVERY) -> FloatArray:
        """Lowest and highest of each section force, float[rows, members, 6, 2] [N, N m]."""
        found = np.empty((*self.first[rows].shape, 2))
        for one in self.pieces(rows):
            found[one.rows, one.members] = limits(np.moveaxis(one.forces, 4, 2))
        return found

    def curves(self, row: int, stations: FloatArray) -> list[tuple[FloatArray, FloatArray]]:
        """What a diagram of each member goes through in a row: a jump has its place twice.

        Args:
            row: its number, from 0.
            stations: shares of the length, float[stations], both ends among them, to which cuts
                and extremes are added.

        Returns:
            Places as shares, float[k], and section forces there, float[k, 6], of each member.
        """
        found: dict[int, tuple[FloatArray, FloatArray]] = {}
        for one in self.pieces(slice(row, row + 1)):
            if one.straight:
                values = at_shares(one.forces[0, :, 0].swapaxes(1, 2), stations).swapaxes(1, 2)
                found |= {k: (stations, own) for k, own in zip(one.members, values, strict=True)}
            else:
                found[one.members[0]] = _curve(one.places, one.forces[0, 0], stations)
        return [found[member] for member in range(len(self.members))]

    def _loads(self, rows: slice) -> tuple[Structure, dict[int, list[ActingLoad]]]:
        """The structure, and the loads along each member by its number."""
        bare = {name: one for name, one in self.model.effects.items() if not one.at_sensors()}
        exact = {name: one.exact_for(self.parameters[name]) for name, one in bare.items()}
        silent = self.model.model_copy(update={"sensors": {}, "effects": exact})
        structure = build_structure(silent)
        chosen = {
            name: {key: column[rows] for key, column in self.parameters[name].items()}
            for name in exact
        }
        found: dict[int, list[ActingLoad]] = {}
        for load in Simulator(silent, structure).assembly.loads(structure, chosen):
            for spread in load.spread:
                found.setdefault(spread[0], []).append((load.coefficient, spread))
        return structure, found


@dataclass(frozen=True)
class _Span:
    """One member with the loads along it.

    Attributes:
        length: [m].
        first: section forces at its first node, float[rows, 6].
        loads: along it.
    """

    length: float
    first: FloatArray
    loads: Sequence[ActingLoad]

    def pieces(self) -> tuple[FloatArray, FloatArray]:
        """Places as shares, float[pieces, 4], and the forces there, float[rows, pieces, 4, 6]."""
        ends = [self._share(place) for _, load in self.loads for place in load[2:4]]
        cuts = np.unique(np.clip([0.0, *ends, 1.0], 0.0, 1.0))
        if any(load[3] == 0 for _, load in self.loads):
            # The section at the first node is before a force that acts there.
            cuts = np.append(0.0, cuts)
        places = cuts[:-1, None] + NODES * np.diff(cuts)[:, None]
        # What begins where a piece begins acts on all of it.
        return places, self.forces(places, np.where(np.diff(cuts) > 0, cuts[:-1], -1.0)[:, None])

    def forces(self, places: FloatArray, behind: FloatArray) -> FloatArray:
        """Section forces, float[rows, ..., 6] [N, N m].

        Args:
            places: shares of the length, float[...].
            behind: share up to which point loads act, float[...] that fits the places.
        """
        x = self.length * places
        forces = _without_loads(self.first.reshape(-1, *[1] * x.ndim, 6), x)
        for coefficient, (_, axis, begin, end, start, last) in self.loads:
            begin_at, end_at = self.length * self._share(begin), self.length * self._share(end)
            past = np.maximum(x - begin_at, 0.0)
            if begin == end:
                size, moment = start * (self._share(begin) <= behind), start * past
            else:
                under, growth = np.minimum(past, end_at - begin_at), (last - start) / (end - begin)
                size = start * under + growth * under**2 / 2
                moment = size * past - (start * under**2 / 2 + growth * under**3 / 3)
            forces[..., axis] -= np.multiply.outer(coefficient, size * np.ones(x.shape))
            if axis == 1:
                forces[..., 5] += np.multiply.outer(coefficient, moment)
            elif axis == 2:
                forces[..., 4] -= np.multiply.outer(coefficient, moment)
        return forces

    def _share(self, place: float) -> float:
        """Of the length; places that differ by rounding are one."""
        return round(place / self.length, DIGITS)


def _without_loads(first: FloatArray, x: FloatArray) -> FloatArray:
    """Section forces that those at the first node make alone, float[..., 6] [N, N m].

    Args:
        first: these, float[..., 6].
        x: distances from the node, float[...] that fits them [m].
    """
    forces = np.empty((*np.broadcast_shapes(first.shape[:-1], x.shape), 6))
    forces[...] = first
    forces[..., 4] += first[..., 2] * x
    forces[..., 5] -= first[..., 1] * x
    return forces


def _parts(rows: int, pieces: int) -> Iterator[slice]:
    """Rows in parts of few enough numbers."""
    step = max(1, AT_ONCE // (PIECE * pieces))
    return (slice(begin, min(begin + step, rows)) for begin in range(0, rows, step))


def _beyond(span: _Span, thirds: FloatArray, places: FloatArray) -> FloatArray:
    """What the axial force adds where the axis bows: a cubic that is nothing at both nodes.

    Beside a rigid zone the axis has a corner, which the cubic rounds.

    Args:
        span: the member.
        thirds: section forces at its thirds, float[rows, 2, 6].
        places: shares of its length, float[pieces, 4].

    Returns:
        float[rows, pieces, 4, 6] [N, N m].
    """
    inner = NODES[1:3]
    more = thirds - span.forces(inner, inner)
    nothing = np.zeros_like(more[:, :1])
    factors = np.einsum("rnf,nk->rfk", np.concatenate([nothing, more, nothing], axis=1), FACTORS)
    powers = np.stack([places**k for k in range(4)], axis=-1)
    return np.asarray(np.einsum("rfk,pnk->rpnf", factors, powers))


def _curve(
    places: FloatArray, forces: FloatArray, stations: FloatArray
) -> tuple[FloatArray, FloatArray]:
    """Places float[k], and the forces there, of pieces float[pieces, 4] and float[pieces, 4, 6]."""
    least = FLAT * np.abs(forces).max(axis=(0, 1))[:, None]
    found: list[tuple[FloatArray, FloatArray]] = []
    for (begin, *_, end), values in zip(places, forces.swapaxes(1, 2), strict=True):
        at_ends, inner = values[:, [0, -1]], turns(values)
        there = at_shares(values, inner)
        beyond = there > at_ends.max(axis=1, keepdims=True) + least
        beyond |= there < at_ends.min(axis=1, keepdims=True) - least
        within = stations[(stations > begin + FLAT) & (stations < end - FLAT)]
        at = np.unique([begin, *within, *(begin + (end - begin) * inner[beyond])])
        at = np.append(at[np.append(True, np.diff(at) > FLAT)], end)
        along = at_shares(values, (at - begin) / max(end - begin, FLAT))
        goes_on = bool(found) and bool((np.abs(along[:, :1] - found[-1][1][:, -1:]) <= least).all())
        found.append((at[goes_on:], along[:, goes_on:]))
    return (
        np.concatenate([at for at, _ in found]),
        np.concatenate([along for _, along in found], axis=1).T,
    )


def limits(values: FloatArray) -> FloatArray:
    """Lowest and highest values of cubics, over pieces and within them, float[..., 2].

    Args:
        values: at the `NODES` of pieces, float[..., pieces, 4].

    >>> limits((NODES * (1 - NODES))[None]).round(12).tolist()
    [0.0, 0.25]
    """
    of_all = np.concatenate([values, at_shares(values, turns(values))], axis=-1)
    return np.stack([of_all.min(axis=(-2, -1)), of_all.max(axis=(-2, -1))], axis=-1)


def turns(values: FloatArray) -> FloatArray:
    """Where cubics turn, as shares of their pieces, float[..., 2]; an end where they do not.

    Args:
        values: at the `NODES`, float[..., 4].
    """
    _, slope, bend, twist = np.moveaxis(values @ FACTORS, -1, 0)
    # Of slope + 2 bend t + 3 twist t2; the sum of equal signs loses no digits.
    with np.errstate(all="ignore"):
        large = -(bend + np.copysign(np.sqrt(bend**2 - 3 * twist * slope), bend))
        found = np.stack([large / (3 * twist), slope / large], axis=-1)
    return np.asarray(np.clip(np.nan_to_num(found, nan=0.0), 0.0, 1.0))


def at_shares(values: FloatArray, shares: FloatArray) -> FloatArray:
    """Cubics at shares of their pieces, float[..., k].

    Args:
        values: at the `NODES`, float[..., 4].
        shares: float[..., k].
    """
    constant, slope, bend, twist = np.moveaxis((values @ FACTORS)[..., None], -2, 0)
    return np.asarray(constant + shares * (slope + shares * (bend + shares * twist)))
