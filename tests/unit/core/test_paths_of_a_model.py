"""Which exact path a model is simulated by, and that it agrees with structures built anew."""

from collections.abc import Callable
from typing import Any

import numpy as np
import pytest

import rga
from rga.errors import InputError, UnstableStructureError
from rga.model import read_model
from rga.model.effects.members.member_stiffness import MemberStiffness
from rga.model.schema import EndSprings
from rga.model.structure import Structure, build_structure
from rga.simulation.paths.variation import Variation, variation


def model_with(effects: dict[str, Any], kind: str = "truss") -> rga.Model:
    """A braced cantilever of four bays, its tip loaded."""
    nodes = {f"{row}{k}": [2.0 * k, 0.0, z] for k in range(5) for row, z in (("b", 0), ("t", 2))}
    pairs = [(f"{row}{k}", f"{row}{k + 1}") for row in "bt" for k in range(4)]
    pairs += [(f"b{k}", f"t{k}") for k in range(1, 5)]
    pairs += [(f"b{k}", f"t{k + 1}") for k in range(4)] + [(f"t{k}", f"b{k + 1}") for k in range(4)]
    members = {
        f"{i}-{j}": {
            "nodes": [i, j], "section": "bar", "material": "steel", "kind": kind,
            "groups": ["bottom"] if i[0] == j[0] == "b" else ["rest"],
        }
        for i, j in pairs
    }  # fmt: skip
    return read_model(
        {
            "rga_model": 1,
            "name": "cantilever",
            "plane": "xz",
            "materials": {"steel": {"E": 2e11, "nu": 0.3, "alpha": 1.2e-5, "density": 7850}},
            "sections": {"bar": {"A": 0.002, "Iy": 1e-6, "Iz": 1e-6, "J": 1e-6}},
            "nodes": nodes,
            "members": members,
            "supports": {
                "low": {"node": "b0", "fixed": ["ux", "uz"]},
                "high": {"node": "t0", "fixed": ["ux"]},
            },
            "context": {
                "load": {"unit": "kN", "range": [0, 20]},
                "loss": {"unit": "-", "range": [0.5, 1.0]},
                "bearing": {"unit": "N/m", "range": [1e6, 1e8]},
                "warm": {"unit": "K", "range": [-20, 30]},
            },
            "effects": {
                "tip": {
                    "kind": "nodal_load", "forces": {"b4": [0, 0, -1000]},
                    "factor": {"context": "load"},
                },
                "sun": {
                    "kind": "temperature", "groups": {"bottom": 1.0}, "delta": {"context": "warm"},
                },
                **effects,
            },
            "sensors": {
                "tip": {"kind": "displacement", "node": "b4", "direction": [0, 0, 1], "unit": "mm"},
                "bar": {"kind": "strain", "member": "b0-b1", "unit": "microstrain"},
                "hold": {"kind": "reaction", "node": "t0", "direction": [1, 0, 0], "unit": "kN"},
            },
        },
        "model",
    )  # fmt: skip


LOSS = {"kind": "member_stiffness", "group": "bottom", "factor": {"context": "loss"}}


BEARING = {
    "kind": "support_spring", "support": "high", "dof": "uz", "stiffness": {"context": "bearing"},
}  # fmt: skip


WEIGHT = {
    "kind": "member_load", "member": ["b0-b1", "b2-b3"], "uniform": [300, 0, -500],
    "factor": {"context": "load"},
}  # fmt: skip


ZONE = {"kind": "rigid_end_zone", "group": "bottom", "length": {"context": "loss"}}


RIGIDITY = {"kind": "joint_rigidity", "group": "bottom", "stiffness": {"context": "bearing"}}


def contexts(rows: int, **fixed: Any) -> dict[str, Any]:
    draw = np.random.default_rng(rows)
    drawn = {
        "load": draw.uniform(0, 20, rows),
        "loss": draw.uniform(0.5, 1.0, rows),
        "bearing": draw.uniform(1e6, 1e8, rows),
        "warm": draw.uniform(-20, 30, rows),
    }
    return drawn | {name: np.full(rows, value) for name, value in fixed.items()}


@pytest.mark.parametrize(
    ("effects", "kind", "path", "terms"),
    [
        ({}, "truss", "C1", 0),
        ({"loss": LOSS}, "truss", "C2", 4),
        ({"loss": LOSS, "bearing": BEARING}, "truss", "C2", 5),
        ({"loss": LOSS, "rigidity": RIGIDITY}, "truss", "C3", 0),
        ({"loss": {**LOSS, "group": ["bottom", "rest"]}}, "truss", "C3", 0),
        # three modes a member in the plane, and a gauge
        ({"loss": LOSS, "own weight": WEIGHT}, "frame", "C2", 13),
        ({"loss": LOSS, "bearing": BEARING}, "frame", "C2", 14),
        ({"loss": {**LOSS, "group": ["bottom", "rest"]}}, "frame", "C3", 0),
        ({"loss": LOSS, "zone": ZONE}, "frame", "C3", 0),
    ],
)
def test_the_cheapest_exact_path_is_taken(
    effects: dict[str, Any], kind: str, path: str, terms: int
) -> None:
    simulator = rga.Simulator(model_with(effects, kind))
    given_contexts = contexts(9)
    plan = simulator.plan(given_contexts)
    assert (plan.path, plan.terms, plan.rows) == (path, terms, 9)
    assert str(plan).startswith(f"{path}: ")
    found = simulator.predict(given_contexts)
    for row in range(9):
        one = {name: column[row] for name, column in given_contexts.items()}
        alone = rga.Simulator(simulator.model).predict(one)[0]
        np.testing.assert_allclose(found[row], alone, rtol=1e-9, atol=1e-9 * np.abs(found).max())


@pytest.mark.parametrize(("names", "whole"), [("EG", True), ("E", False), ("EA", False)])
def test_frame_members_vary_as_a_whole_or_not_at_all(names: str, whole: bool) -> None:
    start = build_structure(model_with({}, "frame"))

    def change(state: Any) -> Structure:
        changed = start.copy()
        for name in names:
            changed.arrays[name][[2, 5]] *= state[0]
        return changed

    found = variation(change, np.linspace(0.5, 1.0, 7)[:, None])
    assert (found is not None) == whole
    if found is not None:
        np.testing.assert_array_equal(found.members, [2, 5])
        np.testing.assert_allclose(found.at(np.ones((1, 1)))[0], [2e11, 2e11])


def test_one_state_for_all_rows_is_one_structure() -> None:
    simulator = rga.Simulator(model_with({"loss": LOSS}))
    assert simulator.plan(contexts(5, loss=0.8)).path == "C1"


def test_frame_members_whose_ends_yield_are_assembled_anew() -> None:
    model = model_with({"loss": LOSS}, "frame")
    yielding = model.members["b1-b2"].model_copy(update={"end_springs": EndSprings(i={"ry": 2e6})})
    simulator = rga.Simulator(
        model.model_copy(update={"members": {**model.members, "b1-b2": yielding}})
    )
    given_contexts = contexts(9)
    assert simulator.plan(given_contexts).path == "C3"
    found = simulator.predict(given_contexts)
    one = {name: column[4] for name, column in given_contexts.items()}
    np.testing.assert_allclose(found[4], simulator.predict(one)[0], rtol=1e-12)


@pytest.mark.parametrize(
    ("effects", "kind"),
    [
        ({}, "truss"),
        ({"loss": LOSS, "bearing": BEARING}, "truss"),
        ({"loss": LOSS, "bearing": BEARING, "own weight": WEIGHT}, "frame"),
    ],
)
def test_the_jacobian_is_exact(effects: dict[str, Any], kind: str) -> None:
    simulator = rga.Simulator(model_with(effects, kind))
    at = contexts(6)
    found = simulator.jacobian(at)
    ranges = np.array([np.ptp(variable.range) for variable in simulator.model.context.values()])
    expected = np.zeros_like(found)
    for column, name in enumerate(simulator.model.context):
        sides = []
        for share in (2e-3, 1e-3):
            step = share * ranges[column]
            ahead, behind = (simulator.predict({**at, name: at[name] + s * step}) for s in (1, -1))
            sides.append((ahead - behind) / (2 * step))
        expected[:, :, column] = sides[1] + (sides[1] - sides[0]) / 3  # of fourth order
    off, size = np.abs(found - expected) * ranges, np.abs(expected) * ranges
    assert (off <= 1e-7 * size.max(axis=(0, 2))[:, None]).all()


def test_a_structure_that_loses_its_hold_is_named() -> None:
    model = model_with({"bearing": BEARING})
    loose = model.model_copy(
        update={"supports": {**model.supports, "low": model.supports["low"].model_copy(
            update={"fixed": ("ux",)})}}
    )  # fmt: skip
    with pytest.raises(UnstableStructureError, match="in uz"):
        rga.Simulator(loose).predict(contexts(3) | {"bearing": [1e7, 2e7, 0.0]})


def test_sizes_that_overflow_are_refused() -> None:
    with pytest.raises(InputError, match="finite"):
        rga.Simulator(model_with({})).predict(contexts(2) | {"load": 1e308})


def test_a_settlement_pushes_on_a_spring_that_varies(two_bars: dict[str, Any]) -> None:
    two_bars["context"]["bearing"] = {"unit": "N/m", "range": [1e6, 1e9]}
    two_bars["effects"] |= {
        "soft": {
            "kind": "support_flexibility", "support": "E", "dof": "uz",
            "stiffness": {"context": "bearing"},
        },
        "sunk": {"kind": "support_settlement", "support": "E", "dof": "uz", "displacement": -0.01},
    }  # fmt: skip
    simulator = rga.Simulator(read_model(two_bars, "test"))
    rows = {"temperature": 10.0, "load": 2e4, "bearing": np.linspace(2e7, 9e8, 8)}
    together = simulator.predict(rows)
    apart = [simulator.predict({**rows, "bearing": one})[0] for one in rows["bearing"]]
    np.testing.assert_allclose(together, apart, rtol=1e-10)
    assert simulator.plan(rows).path == "C3"


def test_derivatives_do_not_leave_the_range(two_bars: dict[str, Any]) -> None:
    two_bars["context"] |= {"loss": {"unit": "-", "range": [0, 1.5]}}
    two_bars["context"]["bearing"] = {"unit": "N/m", "range": [0, 1e9]}
    two_bars["supports"]["E"]["fixed"] = ["uz"]
    two_bars["effects"] |= {
        "loss": {"kind": "member_stiffness", "member": "west", "factor": {"context": "loss"}},
        "held": {
            "kind": "support_spring", "support": "E", "dof": "ux",
            "stiffness": {"context": "bearing"},
        },
    }  # fmt: skip
    simulator = rga.Simulator(read_model(two_bars, "test"))
    stiffness, loss = np.array([1e4, 2e5, 1e9, 5e8, 3e7]), np.array([2e-5, 1.5, 0.9, 0.3, 1.0])
    rows = {"temperature": 10.0, "load": 2e4, "bearing": stiffness, "loss": loss}
    found = simulator.jacobian(rows)
    for column, name in ((2, "loss"), (3, "bearing")):
        along = 0.0
        for place, weight in ((-2, 1 / 12), (-1, -8 / 12), (1, 8 / 12), (2, -1 / 12)):
            moved = simulator.predict({**rows, name: rows[name] * (1 + 1e-3 * place)})
            along = along + weight * moved / (1e-3 * rows[name][:, None])
        # The strain does not follow the bearing: its differences would be rounding.
        assert found[:, 0, column] == pytest.approx(along[:, 0], rel=1e-6), name
    none = {**rows, "bearing": np.zeros(5), "loss": 1.0}
    with pytest.raises(UnstableStructureError):
        simulator.jacobian(none)


@pytest.mark.filterwarnings("error")
def test_a_support_that_is_still_rigid_has_derivatives(two_bars: dict[str, Any]) -> None:
    rows = {"time": np.array([1.0, 2.0]), "temperature": 10.0, "load": np.array([1e4, 2e4])}
    sound = rga.Simulator(read_model(two_bars, "test")).jacobian(rows)
    two_bars["effects"]["later"] = {
        "kind": "support_flexibility", "support": "E", "dof": "uz", "stiffness": 1e8, "onset": 9.0,
    }  # fmt: skip
    found = rga.Simulator(read_model(two_bars, "test")).jacobian(rows)
    np.testing.assert_allclose(found, sound, rtol=1e-9, atol=1e-12 * np.abs(sound).max())


@pytest.mark.parametrize("wrong", [None, [1.0], {"load": []}, {"load": "much"}])
def test_contexts_that_are_none_are_refused(two_bars: dict[str, Any], wrong: Any) -> None:
    simulator = rga.Simulator(read_model(two_bars, "test"))
    with pytest.raises(InputError):
        simulator.predict(wrong)
    with pytest.raises(InputError):
        simulator.jacobian(wrong)


def test_what_bends_to_both_sides_alike_is_not_straight() -> None:
    """A cubic about the middle goes through the middle and both ends of a line."""
    start = build_structure(model_with({}))

    def variation_of(law: Callable[[float], float]) -> Variation | None:
        def change(state: Any) -> Structure:
            changed = start.copy()
            changed.arrays["E"][[2, 5]] *= law(float(state[0]))
            return changed

        return variation(change, np.array([[1.0], [0.5], [1.5]]))

    assert variation_of(lambda p: 1.0 + 4.0 * (p - 1.0) ** 3) is None
    assert variation_of(lambda p: p) is not None


def test_a_kind_need_not_know_what_it_is_far_beyond_its_range(
    monkeypatch: pytest.MonkeyPatch,
) -> None:
    """Rows in the range, one or many, and a little beyond are simulated by themselves."""
    plain = MemberStiffness.values

    def values(self: MemberStiffness, contexts: Any, rows: int) -> Any:
        if contexts["loss"].max() > 1.05:
            raise ValueError("not known")
        return plain(self, contexts, rows)

    losses = np.array([0.5, 0.6, 0.7, 0.8, 0.9, 1.0, 1.04])
    wanted = rga.Simulator(model_with({"loss": LOSS})).predict(contexts(7, loss=losses))
    monkeypatch.setattr(MemberStiffness, "values", values)
    simulator = rga.Simulator(model_with({"loss": LOSS}))
    np.testing.assert_allclose(
        simulator.predict(contexts(7, loss=losses)), wanted, rtol=1e-9, atol=1e-12
    )
    for row in range(7):
        one = {name: column[row : row + 1] for name, column in contexts(7, loss=losses).items()}
        np.testing.assert_allclose(simulator.predict(one)[0], wanted[row], rtol=1e-9, atol=1e-12)


def test_derivatives_where_contexts_change_the_structure_alone() -> None:
    """The load is what it is: nothing but a stiffness follows a context."""
    content = model_with({"loss": LOSS})
    effects = {name: one for name, one in content.effects.items() if name != "sun"}
    effects["tip"] = effects["tip"].model_copy(update={"factor": 10.0})
    simulator = rga.Simulator(content.model_copy(update={"effects": effects}))
    loss, step = np.array([0.6, 0.8, 0.9]), 1e-6
    ahead, behind = (simulator.predict({"loss": loss + way * step}) for way in (1, -1))
    found = simulator.jacobian({"loss": loss})
    column = list(content.context).index("loss")
    np.testing.assert_allclose(
        found[:, :, column], (ahead - behind) / (2 * step), rtol=1e-5, atol=1e-8
    )
    assert not np.delete(found, column, axis=2).any()
    along = simulator.pull_back({"loss": loss}, np.ones((3, 3)))[:, column]
    np.testing.assert_allclose(along, found[:, :, column].sum(axis=1), rtol=1e-9)
