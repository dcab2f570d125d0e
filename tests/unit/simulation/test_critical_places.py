"""Extremes of section forces and stresses beside closed forms, however few the stations."""

from collections.abc import Callable
from typing import Any

import numpy as np
import pytest

from rga.model import Model, read_effect, read_model
from rga.model.io import write_model
from rga.model.schema import DOFS
from rga.simulation import results

E, AREA, IY, IZ, HALF = 2.1e11, 0.01, 8e-5, 2e-5, 0.15
YIELD = 235e6
SPAN, FORCE, LOAD = 6.0, 6e4, 12e3
FIBRES = {"top": [0.0, HALF], "bottom": [0.0, -HALF], "corner": [0.05, HALF]}
CLAMPED, PINNED, SLIDING = list(DOFS), ["ux", "uy", "uz", "rx"], ["uy", "uz", "rx"]


def beam(left: list[str], right: list[str], *loads: dict[str, Any], **parts: Any) -> Model:
    """A level member of 6 m in space."""
    member = {"nodes": ["A", "B"], "section": "girder", "material": "steel", "kind": "frame"}
    sides = {"west": {"node": "A", "fixed": left}, "east": {"node": "B", "fixed": right}}
    along = {"kind": "member_load", "member": "AB"}
    return read_model(
        {
            "rga_model": 1,
            "name": "beam",
            "materials": {"steel": {"E": E, "yield_strength": YIELD}},
            "sections": {"girder": {"A": AREA, "Iy": IY, "Iz": IZ, "J": 1e-6, "fibres": FIBRES}},
            "nodes": {"A": [0, 0, 0], "B": [SPAN, 0, 0]},
            "members": {"AB": member},
            "supports": {name: one for name, one in sides.items() if one["fixed"]},
            "effects": {f"load {k}": {**along, **load} for k, load in enumerate(loads)},
            **parts,
        },
        "beam",
    )


def point(size: float, x: float, axis: int = 2) -> dict[str, Any]:
    return {"point": [size * (k == axis) for k in range(3)], "x": x}


def extremes(model: Model, stations: int) -> dict[str, float]:
    (found,) = results(model, stations=stations).members().to_dicts()
    return found


exact = pytest.mark.parametrize("stations", [2, 5, 11, 13])


def near(value: float) -> Any:
    return pytest.approx(value, rel=1e-9)


@exact
class TestClosedForms:
    def test_a_force_between_stations(self, stations: int) -> None:
        found = extremes(beam(PINNED, SLIDING, point(-FORCE, 3.3)), stations)
        moment = FORCE * 3.3 * 2.7 / SPAN
        assert found["M max"] == near(moment)
        assert found["V max"] == near(FORCE * 3.3 / SPAN)
        assert found["stress max"] == near(moment * HALF / IY)
        assert found["stress min"] == near(-moment * HALF / IY)
        assert found["utilisation"] == near(moment * HALF / IY / YIELD)

    def test_two_forces(self, stations: int) -> None:
        found = extremes(
            beam(PINNED, SLIDING, point(-FORCE, 1.1), point(-FORCE / 2, 4.7)), stations
        )
        west = (FORCE * 4.9 + FORCE / 2 * 1.3) / SPAN
        assert found["V max"] == near(west)
        assert found["M max"] == near(max(west * 1.1, (1.5 * FORCE - west) * 1.3))

    def test_a_force_at_an_end_goes_to_the_support(self, stations: int) -> None:
        for x in (0.0, SPAN):
            found = extremes(beam(PINNED, SLIDING, point(-FORCE, x)), stations)
            assert found["M max"] == pytest.approx(0.0, abs=1e-9 * FORCE)

    def test_a_uniform_load_on_a_propped_cantilever(self, stations: int) -> None:
        model = beam(CLAMPED, SLIDING, {"uniform": [0, 0, -LOAD]})
        found = extremes(model, stations)
        assert found["M max"] == near(LOAD * SPAN**2 / 8)
        assert found["V max"] == near(5 / 8 * LOAD * SPAN)
        lowest, highest = results(model, stations=stations).along.limits()[0, 0, 4]
        assert sorted((-lowest, highest)) == [
            near(9 / 128 * LOAD * SPAN**2), near(LOAD * SPAN**2 / 8)
        ]  # fmt: skip

    def test_a_load_that_grows_along_the_beam(self, stations: int) -> None:
        """Without shear at L / sqrt 3 of a triangle: M = w L2 / (9 sqrt 3)."""
        found = extremes(beam(PINNED, SLIDING, {"axis": "z", "trapezoid": [0, SPAN, 0, -LOAD]}),
                         stations)  # fmt: skip
        assert found["M max"] == near(LOAD * SPAN**2 / (9 * np.sqrt(3)))
        assert found["V max"] == near(LOAD * SPAN / 3)

    def test_a_load_that_changes_its_sign_has_its_most_shear_there(self, stations: int) -> None:
        load = {"axis": "z", "trapezoid": [0, SPAN, LOAD, -LOAD]}
        found = extremes(beam(CLAMPED, [], load), stations)
        # Nothing is left of the force at the wall; half of the triangle is at the middle.
        assert found["V max"] == near(LOAD * SPAN / 4)

    def test_a_load_on_a_part_of_the_beam(self, stations: int) -> None:
        load = {"axis": "z", "trapezoid": [1.3, 3.1, -LOAD, -LOAD]}
        west = LOAD * 1.8 * (SPAN - 2.2) / SPAN
        found = extremes(beam(PINNED, SLIDING, load), stations)
        assert found["M max"] == near(west * 1.3 + west**2 / (2 * LOAD))

    def test_a_cantilever(self, stations: int) -> None:
        found = extremes(beam(CLAMPED, [], point(-FORCE, 3.3), point(FORCE, 4.1)), stations)
        assert found["M max"] == near(FORCE * 0.8)
        assert found["V max"] == near(FORCE)

    def test_bent_about_both_axes_a_corner_has_its_own_place(self, stations: int) -> None:
        """Of forces apart the stress of the corner is largest under one of them."""
        model = beam(PINNED, SLIDING, point(-FORCE, 3.3), point(-FORCE / 5, 1.7, axis=1))
        found = extremes(model, stations)

        def moment(force: float, place: float, x: float) -> float:
            return force * min(x * (SPAN - place), place * (SPAN - x)) / SPAN

        corner = [
            moment(FORCE, 3.3, x) * HALF / IY + moment(FORCE / 5, 1.7, x) * 0.05 / IZ
            for x in (1.7, 3.3)
        ]
        assert -found["stress min"] == near(max(corner))
        assert found["M max"] == near(moment(FORCE, 3.3, 3.3))

    def test_stress_of_an_axial_and_a_lateral_load(self, stations: int) -> None:
        """N = p (L - x) and M = w x (L - x) / 2 add up to a parabola with a peak of its own."""
        p, w = 2e5, LOAD
        model = beam(PINNED, SLIDING, {"uniform": [p, 0, -w]})
        found = extremes(model, stations)
        x = SPAN / 2 - p / AREA / (w * HALF / IY)
        expected = p * (SPAN - x) / AREA + w * x * (SPAN - x) / 2 * HALF / IY
        assert found["stress max"] == near(expected)
        assert found["N max"] == near(p * SPAN)


@exact
def test_axles_are_met_where_they_stand_in_each_row(stations: int) -> None:
    axle = {
        "kind": "axle_load", "path": ["A", "B"], "forces": [FORCE], "offsets": [0.0],
        "position": {"context": "place"},
    }  # fmt: skip
    model = beam(
        PINNED, SLIDING, effects={"axle": axle},
        context={"place": {"unit": "m", "range": [0, SPAN]}},
    )  # fmt: skip
    places = np.array([0.7, 2.31, 3.33, 5.9])
    found = results(model, {"place": places}, stations=stations)
    for row, place in enumerate(places, start=1):
        (member,) = found.members(row).to_dicts()
        assert member["M max"] == near(FORCE * place * (SPAN - place) / SPAN)
        assert member["V max"] == near(FORCE * max(place, SPAN - place) / SPAN)
    assert found.members()["M max"].item() == near(FORCE * 3.33 * 2.67 / SPAN)


def test_a_lost_share_of_the_section_counts_between_stations() -> None:
    load = {"kind": "member_load", "member": "AB", **point(-FORCE, 3.3)}
    loss = {"kind": "member_stiffness", "member": "AB", "factor": 0.75}
    found = extremes(beam(PINNED, SLIDING, effects={"load": load, "loss": loss}), 2)
    assert found["stress max"] == near(FORCE * 3.3 * 2.7 / SPAN * HALF / IY / 0.75)


def frame(seed: int, **parts: Any) -> Model:
    """A frame in space: members with forces at places, with loads along parts, some stiff."""
    draw = np.random.default_rng(seed)
    points = {
        f"n{k}": np.add(draw.uniform(-0.6, 0.6, 3), (2.5 * (k % 3), 3.0 * (k // 3), 0)).tolist()
        for k in range(6)
    }
    pairs = [(0, 1), (1, 2), (3, 4), (4, 5), (0, 3), (2, 5), (1, 4)]
    members = {
        f"m{k}": {
            "nodes": [f"n{i}", f"n{j}"], "section": "girder", "material": "steel",
            "kind": "frame", "local_y": draw.normal(size=3).tolist(),
            "groups": ["stiff"] if k > 4 else [],
        }
        for k, (i, j) in enumerate(pairs)
    }  # fmt: skip
    length = {
        name: float(np.linalg.norm(np.subtract(*(points[node] for node in one["nodes"]))))
        for name, one in members.items()
    }
    loads: list[dict[str, Any]] = [
        {"member": "m0", "uniform": (LOAD * draw.normal(size=3)).tolist()}
    ]
    for name in ("m1", "m4", "m6"):
        for share in draw.integers(300, 1700, 2) / 2000:
            force = [0.0, *(FORCE * draw.normal(size=2))]
            loads.append({"member": name, "point": force, "x": share * length[name]})
    for name, axis in (("m2", "y"), ("m3", "z"), ("m3", "y")):
        x1, x2 = np.sort(draw.integers(0, 2001, 2)) / 2000 * length[name]
        sizes = LOAD * draw.normal(size=2)
        loads.append({"member": name, "axis": axis, "trapezoid": [x1, x2, *sizes]})
    supports = {"a": {"node": "n0", "fixed": CLAMPED}, "b": {"node": "n2", "fixed": PINNED[:3]},
                "c": {"node": "n5", "fixed": ["uz", "rx"]}}  # fmt: skip
    return beam([], [], *loads, nodes=points, members=members, supports=supports, **parts)


NUMBERS = ["N min", "N max", "V max", "M max", "stress min", "stress max", "utilisation"]
SIGN = np.array([-1, 1, 1, 1, -1, 1, 1])


@pytest.mark.parametrize("seed", range(8))
@pytest.mark.parametrize("geometry", ["linear", "nonlinear"])
def test_three_stations_tell_as_much_as_thousands(seed: int, geometry: str) -> None:
    model = frame(seed, analysis={"geometry": geometry})
    if geometry == "linear":
        zone = {"kind": "rigid_end_zone", "group": "stiff", "length": 0.2}
        model = model.extended({"zone": read_effect(zone, "zone")})
    few, many = results(model, stations=3), results(model, stations=2001)
    found = few.members().select(NUMBERS).to_numpy()
    forces, fibres = many.section_forces[0], many.stresses.of_members
    stresses = np.array([[v[0] for v in one.values()] for one in fibres.values()])
    flat = stresses.reshape(len(forces), -1)
    expected = np.column_stack(
        [
            forces[..., 0].min(axis=1),
            forces[..., 0].max(axis=1),
            np.abs(forces[..., 1:3]).max(axis=(1, 2)),
            np.abs(forces[..., 4:]).max(axis=(1, 2)),
            flat.min(axis=1),
            flat.max(axis=1),
            np.abs(flat).max(axis=1) / YIELD,
        ]
    )
    size = np.abs(expected).max(axis=0)
    beyond = SIGN * (found - expected) / size
    assert beyond.min() >= -1e-10
    assert beyond.max() <= 1e-6


def test_a_diagram_jumps_where_a_force_stands_and_has_the_peak() -> None:
    found = results(beam(PINNED, SLIDING, point(-FORCE, 3.3)), stations=5)
    ((places, forces),) = found.along.curves(0, found.stations)
    (jump,) = np.flatnonzero(np.diff(places) == 0)
    assert places[jump] == near(0.55)
    assert forces[jump + 1, 2] - forces[jump, 2] == near(FORCE)
    assert np.abs(forces[:, 4]).max() == near(FORCE * 3.3 * 2.7 / SPAN)
    assert set(found.stations) <= set(places)


def test_a_diagram_has_the_place_without_shear() -> None:
    found = results(beam(CLAMPED, SLIDING, {"uniform": [0, 0, -LOAD]}), stations=2)
    ((places, forces),) = found.along.curves(0, found.stations)
    assert places == pytest.approx([0.0, 5 / 8, 1.0], rel=1e-9)
    assert forces[1, 2] == pytest.approx(0.0, abs=1e-9 * LOAD * SPAN)


def test_the_command_names_the_most_used_member(rga: Callable[..., Any], tmp_path: Any) -> None:
    model = beam(PINNED, SLIDING, point(-FORCE, 3.3))
    write_model(model, tmp_path / "beam.json")
    used = FORCE * 3.3 * 2.7 / SPAN * HALF / IY
    for stations in ("2", "11"):
        said = rga("results", tmp_path / "beam.json", "-o", tmp_path / "found.csv",
                   "--stations", stations)  # fmt: skip
        assert f"AB: {used / YIELD:.0%} of its yield strength" in said.out
        assert f"{-used / 1e6:.4g} to {used / 1e6:.4g} MPa" in said.out
