"""The physical twin of the full case study: independent physics, one difference at a time."""

import numpy as np
import pytest

from rga.arrays import FloatArray
from rga.model import Model, read_model
from rga.simulation import Simulator
from rga_bench.synthetic.bridges.full_case_study import WEAKENED, full_case_study
from rga_bench.synthetic.physical_twin import GAPS, PhysicalTwin
from rga_bench.synthetic.physics.frame import Frame, FrameSpring
from rga_bench.synthetic.physics.world import World


@pytest.fixture(scope="module")
def model() -> Model:
    return read_model(full_case_study(), "full case study")


@pytest.fixture(scope="module")
def contexts(model: Model) -> FloatArray:
    low, high = np.array([one.range for one in model.context.values()]).T
    return np.asarray(low + (high - low) * np.random.default_rng(4).random((60, 8)))


def simulated(model: Model, contexts: FloatArray) -> FloatArray:
    return Simulator(model).predict(dict(zip(model.context, contexts.T, strict=True)))


def test_without_a_gap_both_codes_agree(model: Model, contexts: FloatArray) -> None:
    real = PhysicalTwin.draw(3, "noise only").read(contexts)
    assert len(model.sensors) == 84
    np.testing.assert_allclose(real, simulated(model, contexts), atol=0.02)


@pytest.mark.parametrize("gap", GAPS[1:])
def test_each_gap_moves_the_readings(model: Model, contexts: FloatArray, gap: str) -> None:
    off = PhysicalTwin.draw(3, gap).read(contexts) - simulated(model, contexts)
    # A wrong torsional stiffness hardly shows on an open section.
    assert np.sqrt((off**2).mean()) > (0.005 if gap == "torsional stiffness" else 0.2)


def test_condensed_rows_are_those_of_the_whole_frame(contexts: FloatArray) -> None:
    twin = PhysicalTwin.draw(5, "joint rigidity")
    world = World.of(twin.model)
    world.join(["bottom chord", "top chord", "end posts", "diagonals"], twin.difference.joint)
    row = contexts[:1].copy()
    row[0, :5] = 12.0, 0.0, 0.3, 20.0, 0.0
    warm = row.copy()
    warm[0, 0] = 0.0
    worn = np.where(world.members_of(group=WEAKENED), 1.0 - row[0, 6], 1.0)
    world.scale_stiffness(worn)
    springs = [
        FrameSpring(world.support_dof(f"east {side}", "ux"), None, 10.0 ** (row[0, 5] + 3.0))
        for side in ("north", "south")
    ]
    frame = Frame.build(world.geometry, world.section, world.held, springs)
    strain = 12.0 * world.alpha[:, None]
    u = frame.solve(np.zeros((world.size, 1)), strain).u[:, 0]
    expected = [
        1e3 * u[world.dof(one["node"], "ux") :][:3] @ one["direction"]
        for one in twin.model["sensors"].values()
    ]
    # Two rows that differ in the temperature alone differ by what the frame says of it.
    np.testing.assert_allclose((twin.read(row) - twin.read(warm))[0], expected, atol=1e-9)


def test_damage_shows_and_seeds_repeat(contexts: FloatArray) -> None:
    twin = PhysicalTwin.draw(7, "all")
    again = PhysicalTwin.draw(7, "all")
    np.testing.assert_array_equal(twin.read(contexts), again.read(contexts))
    np.testing.assert_allclose(twin.read(contexts)[:9], twin.read(contexts[:9]), rtol=1e-12)
    moved = twin.damaged(1).read(contexts) - twin.read(contexts)
    assert np.sqrt((moved**2).mean()) > 0.3
    noise = twin.noise(np.random.default_rng(1), 4000)
    np.testing.assert_allclose(noise.std(axis=0), twin.sd, rtol=0.15)


def test_an_unknown_gap_is_refused() -> None:
    with pytest.raises(ValueError, match="no gap 'rust'"):
        PhysicalTwin.draw(1, "rust")
