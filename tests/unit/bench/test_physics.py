"""The independent physics against closed forms, equilibrium and its own limits."""

from __future__ import annotations

import numpy as np
import pytest

from rga_bench.synthetic import BRIDGES, draw_case
from rga_bench.synthetic.gauges import observe
from rga_bench.synthetic.hidden.score import d_prime
from rga_bench.synthetic.noise import autoregressive, stream
from rga_bench.synthetic.physics.frame import Frame, FrameSpring, Geometry, Solution, Stiffness
from rga_bench.synthetic.physics.friction import slide
from rga_bench.synthetic.physics.response import respond
from rga_bench.synthetic.physics.world import Friction, World

E, A, INERTIA, J = 2.0e11, 0.01, 4.0e-5, 1.0e-6


def stiffness(count: int, end_spring: float) -> Stiffness:
    ones = np.ones(count)
    return Stiffness(
        E * A * ones, E * INERTIA * ones, 2 * E * INERTIA * ones, 8e10 * J * ones, end_spring * ones
    )


def one_load(size: int, dof: int, force: float) -> np.ndarray:
    load = np.zeros((size, 1))
    load[dof] = force
    return load


def cantilever(tip: np.ndarray, end_spring: float = np.inf, pieces: int = 3) -> Frame:
    xyz = np.linspace(0.0, 1.0, pieces + 1)[:, None] * tip
    ends = np.array([[i, i + 1] for i in range(pieces)])
    return Frame.build(Geometry.of(xyz, ends), stiffness(pieces, end_spring), set(range(6)))


def test_bar_stretches_under_force_and_heat() -> None:
    geometry = Geometry.of(np.array([[0.0, 0, 0], [3.0, 0, 0]]), np.array([[0, 1]]))
    frame = Frame.build(geometry, stiffness(1, 0.0), {0, 1, 2, 7, 8})
    answer = frame.solve(one_load(12, 6, 1e5), np.array([[1.2e-5 * 20]]))
    assert answer.u[6, 0] == pytest.approx(1e5 * 3 / (E * A) + 1.2e-5 * 20 * 3)
    assert answer.elongation[0, 0] == pytest.approx(answer.u[6, 0])
    assert answer.reaction[0, 0] == pytest.approx(-1e5)


def test_held_bar_is_compressed_by_heat() -> None:
    geometry = Geometry.of(np.array([[0.0, 0, 0], [3.0, 0, 0]]), np.array([[0, 1]]))
    frame = Frame.build(geometry, stiffness(1, 0.0), {0, 1, 2, 7, 8}, [FrameSpring(6, None, 1e8)])
    answer = frame.solve(np.zeros((12, 1)), np.array([[2e-4]]))
    k = E * A / 3.0
    assert answer.u[6, 0] == pytest.approx(k * 3.0 * 2e-4 / (k + 1e8))


@pytest.mark.parametrize("direction", [(1.0, 0, 0), (0, 1.0, 0), (0.6, 0, 0.8), (0, 0, 1.0)])
def test_cantilever_bends_about_both_axes(direction: tuple[float, float, float]) -> None:
    length = 4.0
    tip = length * np.array(direction)
    frame = cantilever(tip)
    ex = np.array(direction)
    side = np.cross([0.0, 0, 1], ex) if abs(ex[2]) < 0.9 else np.array([0.0, 1, 0])
    side /= np.linalg.norm(side)
    up = np.cross(ex, side)
    for way, inertia in ((side, 2 * INERTIA), (up, INERTIA)):
        load = np.zeros((24, 1))
        load[18:21, 0] = 1e3 * way
        u = frame.solve(load, np.zeros((3, 1))).u[:, 0]
        assert way @ u[18:21] == pytest.approx(1e3 * length**3 / (3 * E * inertia))
        assert np.linalg.norm(u[21:24]) == pytest.approx(1e3 * length**2 / (2 * E * inertia))


def test_cantilever_twists() -> None:
    u = cantilever(np.array([4.0, 0, 0])).solve(one_load(24, 21, 50.0), np.zeros((3, 1))).u
    assert u[21, 0] == pytest.approx(50.0 * 4 / (8e10 * J))


def test_end_springs_add_their_flexibility() -> None:
    length, spring, force = 4.0, 3e6, 1e3
    geometry = Geometry.of(np.array([[0.0, 0, 0], [length, 0, 0]]), np.array([[0, 1]]))
    section = stiffness(1, spring)
    frame = Frame.build(geometry, section, set(range(6)))
    u = frame.solve(one_load(12, 8, force), np.zeros((1, 1))).u
    free = force * length**3 / (3 * E * INERTIA) + force * length**2 / spring
    assert u[8, 0] == pytest.approx(free)


def test_hand_truss() -> None:
    """Two bars at 3-4-5 under a vertical force at the apex: N = -P / (2 sin)."""
    xyz = np.array([[-3.0, 0, 0], [3.0, 0, 0], [0.0, 0, 4.0]])
    geometry = Geometry.of(xyz, np.array([[0, 2], [1, 2]]))
    held = {6 * n + d for n in (0, 1) for d in range(3)} | {13}
    frame = Frame.build(geometry, stiffness(2, 0.0), held)
    answer = frame.solve(one_load(18, 14, -1e5), np.zeros((2, 1)))
    force = E * A * answer.elongation[:, 0] / geometry.length
    assert force == pytest.approx([-62500.0, -62500.0])
    assert answer.reaction[[0, 2, 6, 8], 0] == pytest.approx([37500.0, 5e4, -37500.0, 5e4])


def test_settlement_of_a_determinate_beam_strains_nothing() -> None:
    world = World.of(draw_case(1, bridge="footbridge", kind="null").model)
    frame = Frame.build(world.geometry, world.section, world.held)
    settled = np.zeros((world.size, 1))
    settled[world.support_dof("rocker", "uz")] = -0.01
    answer = frame.solve(np.zeros((world.size, 1)), np.zeros((len(world.alpha), 1)), settled)
    assert np.abs(answer.elongation).max() < 1e-12
    middle = world.dof("t4", "uz")
    assert answer.u[middle, 0] == pytest.approx(-0.005)


def test_mechanism_is_refused() -> None:
    xyz = np.array([[0.0, 0, 0], [1.0, 0, 0], [2.0, 0, 0]])
    geometry = Geometry.of(xyz, np.array([[0, 1], [1, 2]]))
    frame = Frame.build(geometry, stiffness(2, 0.0), {0, 1, 2, 12, 13, 14})
    with pytest.raises((ValueError, np.linalg.LinAlgError)):
        frame.solve(one_load(18, 8, -1.0), np.zeros((2, 1)))


@pytest.mark.parametrize("bridge", list(BRIDGES))
@pytest.mark.parametrize("joints", [0.0, 1e7])
def test_reactions_balance_loads(bridge: str, joints: float) -> None:
    place = BRIDGES[bridge](stream(3, "bridge"))
    world = World.of(place.model)
    if joints:
        world.join(place.jointed, joints)
    frame = Frame.build(world.geometry, world.section, world.held)
    rng = np.random.default_rng(1)
    load = np.zeros((world.size, 2))
    for node in range(len(world.geometry.xyz)):
        load[6 * node + 2] = rng.normal(0, 1e4, 2)
        load[6 * node] = rng.normal(0, 1e3, 2)
    answer = frame.solve(load, rng.normal(0, 1e-4, (len(world.alpha), 2)))
    total = (load + answer.reaction).reshape(-1, 6, 2)
    balance = total[:, :3].sum(axis=0)
    xyz = world.geometry.xyz
    moment = np.cross(xyz[:, :, None], total[:, :3], axis=1) + total[:, 3:]
    assert np.abs(balance).max() < 1e-3
    assert np.abs(moment.sum(axis=0)).max() < 1e-2


def test_bearing_sticks_then_slips() -> None:
    """One spring-like bearing of flexibility f: the grip is capped, reversal sticks again."""
    f, normal, mu = 1e-8, 1e5, 0.1
    answer = Solution(np.array([[1.0, f], [0, 0]]), np.zeros((0, 2)), np.zeros((2, 2)))
    course = np.array([[0.0], [5e-5], [2e-4], [1.5e-4], [-2e-4]])
    grip = slide(Friction([0], [1], mu, normal), answer, course, 1)[:, 0]
    cap = mu * normal
    assert grip == pytest.approx([0.0, -5e-5 / f, -cap, -cap + 5e-5 / f, cap])


def test_noise_has_the_sd_and_memory_that_are_set() -> None:
    noise = autoregressive(np.random.default_rng(0), 40000, np.array([2.0]), np.array([0.6]))[:, 0]
    assert noise.std() == pytest.approx(2.0, rel=0.03)
    assert np.corrcoef(noise[1:], noise[:-1])[0, 1] == pytest.approx(0.6, abs=0.02)


def test_d_prime_of_white_noise_and_of_a_gain() -> None:
    rng = np.random.default_rng(0)
    shape = rng.standard_normal((500, 1))
    free = d_prime(shape, [np.zeros((500, 1))], np.array([4.0]))
    assert free == pytest.approx(np.sqrt((shape**2).sum() / 4.0))
    assert d_prime(0.3 * 100 * shape, [100 * shape], np.array([1e-4])) == pytest.approx(
        10, rel=0.01
    )


def test_cart_between_nodes_is_shared_and_off_the_path_is_nothing() -> None:
    model = draw_case(2, bridge="pratt", kind="null").model
    world = World.of(model)
    zero = {name: np.zeros(4) for name in model["context"]}
    zero["temperature"] += 12.0
    zero["cart_w"] += 1e5
    zero["cart_x"] = np.array([4.8, 9.6, 7.2, -0.5])
    y = respond(world, zero, np.arange(4.0))[0]
    assert y[2] == pytest.approx((y[0] + y[1]) / 2)
    assert np.abs(y[3]).max() == 0.0
    assert y[0, 0] < 0.0


def test_frame_with_soft_joints_is_a_truss_and_with_stiff_ones_stiffer() -> None:
    case = draw_case(2, bridge="warren", kind="null", reality="truss")
    place = BRIDGES["warren"](stream(2, "bridge"))
    contexts = {name: case.channels[name] for name in case.model["context"]}
    pinned = World.of(place.model)
    soft, stiff = pinned.copy(), pinned.copy()
    soft.join(place.jointed, 1.0)
    stiff.join(place.jointed, 1e9)
    readings = [observe(w, contexts, case.time)[:, 1].std() for w in (pinned, soft, stiff)]
    assert readings[1] == pytest.approx(readings[0], rel=1e-4)
    assert readings[2] < 0.999 * readings[0]
