"""Modes: against a dense solver, the NAFEMS benchmarks, and what is refused."""

import math

import numpy as np
import pytest

import rga
from independent.dense_modes import dense_modes
from rga.model import Model, read_effect
from rga.model.schema import ContextVariable

TIGHT = 1e-9


def random_frame(seed: int, levels: int = 4) -> Model:
    """A tower of bars and beams with masses along members and on nodes."""
    draw = np.random.default_rng(seed)
    build = rga.ModelBuilder("tower")
    build.add_material("steel", E=210e9, nu=0.3, density=7850)
    build.add_section("leg", A=8e-3, Iy=3e-5, Iz=5e-5, J=4e-5).add_section("bar", A=1e-3)
    corners = [(0.0, 0.0), (4.0, 0.0), (4.0, 3.0), (0.0, 3.0)]
    for level in range(levels):
        for at, (x, y) in enumerate(corners):
            build.add_node(f"{level}{at}", *draw.normal([x, y, 3.5 * level], 0.1))
    for at in range(4):
        build.support(f"0{at}", "pinned" if at else "fixed")
        for level in range(levels - 1):
            foot, head, beside = f"{level}{at}", f"{level + 1}{at}", f"{level + 1}{(at + 1) % 4}"
            build.add_member(foot, head, "leg", kind="frame", groups="legs")
            build.add_member(foot, beside, "bar", groups="bracing")
            build.add_member(head, beside, "leg", kind="frame", groups="floor")
    build.mass("31", float(draw.uniform(500, 2000)), inertia=(40.0, 50.0, 60.0))
    build.mass_along("floor", float(draw.uniform(100, 400)), name="deck")
    build.spring("20", "uy", float(10 ** draw.uniform(4, 7)))
    return build.build()


@pytest.mark.parametrize("seed", range(4))
def test_frequencies_are_those_of_a_dense_solver(seed: int) -> None:
    model = random_frame(seed)
    found, expected = rga.modes(model, 30).frequencies, dense_modes(model)
    np.testing.assert_allclose(found, expected[:30], rtol=TIGHT)


@pytest.mark.parametrize("levels", [4, 10, 16])
def test_all_modes_are_found_where_more_are_asked_for(levels: int) -> None:
    model = random_frame(0, levels)
    found, expected = rga.modes(model, 500).frequencies, dense_modes(model)
    assert len(found) == len(expected)
    np.testing.assert_allclose(found, expected, rtol=TIGHT)


def test_effective_masses_add_up() -> None:
    """All modes together carry the mass that is not held (Chopra, 2012, section 13.2)."""
    found = rga.modes(random_frame(1), 500)
    shares = found.participating.sum(axis=0)
    assert (shares < 1).all()
    assert (shares > 0.9).all()
    assert found.mass[0] == pytest.approx(found.mass[2])


def test_the_same_bits_come_again() -> None:
    one, other = rga.modes(random_frame(2), 12), rga.modes(random_frame(2), 12)
    assert one.frequencies.tobytes() == other.frequencies.tobytes()
    assert one.shapes.tobytes() == other.shapes.tobytes()


def double_cross(elements: int = 4) -> Model:
    """NAFEMS FV2: eight arms with pinned ends, in their plane."""
    build = rga.ModelBuilder("double cross", plane="xy")
    side = 0.125
    build.add_material("steel", E=200e9, nu=0.3, density=8000)
    inertia = side**4 / 12
    build.add_section("square", A=side**2, Iy=inertia, Iz=inertia, J=2 * inertia)
    build.add_node("middle")
    for arm in range(8):
        way = np.array([math.cos(arm * math.pi / 4), math.sin(arm * math.pi / 4), 0.0])
        before = "middle"
        for at in range(1, elements + 1):
            build.add_node(f"{arm}-{at}", *(5.0 * at / elements * way))
            build.add_member(before, f"{arm}-{at}", "square", kind="frame")
            before = f"{arm}-{at}"
        build.support(before, "ux", "uy")
    return build.build()


def test_clusters_of_the_double_cross() -> None:
    """NAFEMS FV2: 11.336, seven near 17.7 and eight from 45.3 on [Hz]."""
    found = rga.modes(double_cross(), 16).frequencies
    assert found[0] == pytest.approx(11.336, rel=1e-3)
    np.testing.assert_allclose(found[1:8], 17.709, rtol=2e-3)
    assert found[8] == pytest.approx(45.345, rel=6e-3)
    assert found[8] > 40
    np.testing.assert_allclose(found, dense_modes(double_cross())[:16], rtol=TIGHT)


def off_centre() -> Model:
    """NAFEMS FV4: a cantilever with masses on rigid links to both sides of its end."""
    build = rga.ModelBuilder("cantilever with off-centre masses")
    build.add_material("steel", E=200e9, nu=0.3, density=8000)
    build.add_material("rigid", E=200e15, nu=0.3)
    radius = 0.25
    area, inertia = math.pi * radius**2, math.pi * radius**4 / 4
    build.add_section("round", A=area, Iy=inertia, Iz=inertia, J=2 * inertia)
    build.add_section("link", A=area, Iy=inertia, Iz=inertia, J=2 * inertia)
    build.add_node("0").support("0", "fixed")
    for at in range(1, 6):
        build.add_node(str(at), 2.0 * at)
        build.add_member(str(at - 1), str(at), "round", "steel", kind="frame")
    for name, y, mass in (("heavy", 2.0, 10_000), ("light", -2.0, 1_000)):
        build.add_node(name, 10.0, y).add_member("5", name, "link", "rigid", kind="frame")
        build.mass(name, mass)
    return build.build()


def test_a_close_pair_is_told_apart() -> None:
    """NAFEMS FV4: 1.723, 1.727, 7.413, 9.972, 18.155 and 26.957 [Hz]."""
    found = rga.modes(off_centre(), 6).frequencies
    np.testing.assert_allclose(found[:4], [1.723, 1.727, 7.413, 9.972], rtol=2e-3)
    np.testing.assert_allclose(found[4:], [18.155, 26.957], rtol=1e-2)


def test_weightless_members_and_massless_nodes_make_no_mode() -> None:
    build = rga.ModelBuilder("frame", plane="xz").add_material("steel", E=210e9)
    build.add_section("beam", A=1e-2, Iy=1e-5).add_node("a").add_node("b", 2).add_node("c", 4)
    build.add_member("a", "b", "beam", kind="frame").add_member("b", "c", "beam", kind="frame")
    build.support("a", "pinned").support("c", "uz").mass("b", 100)
    found = rga.modes(build.build(), 10)
    assert len(found.frequencies) == 2
    stiffness = 48 * 210e9 * 1e-5 / 4**3
    assert found.frequencies[0] == pytest.approx(math.sqrt(stiffness / 100) / (2 * math.pi))


@pytest.mark.parametrize("count", [0, -1, 1001, True, 2.5])
def test_numbers_of_modes_that_are_none(count: object) -> None:
    with pytest.raises(rga.InputError, match="give 1 to 1000"):
        rga.modes(random_frame(0), count)  # type: ignore[arg-type]


def test_without_mass_nothing_swings() -> None:
    build = rga.ModelBuilder("bar", plane="xz").add_material("steel", E=210e9)
    build.add_section("bar", A=1e-2).add_node("a").add_node("b", 1)
    build.add_member("a", "b", "bar").support("a", "pinned").support("b", "uz")
    with pytest.raises(rga.InputError, match="nothing that can move has a mass"):
        rga.modes(build.build())


def test_loads_whose_size_is_measured_are_no_part_of_what_swings() -> None:
    model = random_frame(0)
    loaded = model.model_copy(
        update={"context": {"crane": ContextVariable(unit="kN", range=(0, 9))}}
    )
    crane = {"kind": "nodal_load", "forces": {"30": [0, 0, -1]}, "factor": {"context": "crane"}}
    loaded = loaded.extended({"crane": read_effect(crane, "crane")})
    assert rga.modes(loaded, 4).frequencies.tolist() == rga.modes(model, 4).frequencies.tolist()


def test_where_members_move_between_nodes_no_node_moves_most() -> None:
    """A pinned beam of one member bends in a wave between its ends, which only turn."""
    build = rga.ModelBuilder("beam").add_material("steel", E=210e9, density=7850)
    build.add_section("box", A=0.02, Iy=4e-4, Iz=6e-4, J=5e-4).add_node("a").add_node("b", 8.0)
    build.add_member("a", "b", "box", kind="frame").support("a", "ux", "uy", "uz", "rx", "rz")
    build.support("b", "uy", "uz", "rx", "rz")
    lines = rga.modes(build.build(), 3).to_frame().rows(named=True)
    most = [(one["most at"], one["most along"]) for one in lines]
    assert most == [(None, None), (None, None), ("b", "x")]
