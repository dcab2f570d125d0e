"""Measurements of modes that could be made are those of a dense solution, and no better known."""

from dataclasses import replace
from typing import Any

import numpy as np
import pytest

from independent.dense_modes import dense_mode_shapes
from independent.modal_bridge import bridge
from rga.diagnosis.modal.likelihood import CHANGE_ERROR, MODEL_ERROR, STANDING_ERROR, WEATHER
from rga.errors import InputError
from rga.experiments.candidates import LoadTest
from rga.experiments.truck import Truck, lane_of_masses
from rga.findings.schema import FoundMode, Windows
from rga.model import Effect, Model, read_effect, read_model
from rga.model.schema import ContextVariable, ExpectedMode
from rga.planning.modal.candidates import accelerometers, more_windows, parked, seasons
from rga.planning.modal.site import ModalSite

MODES, COUNT, SCATTER, MEMORY = 4, 40, 0.002, 0.3
TRUCK = Truck((20.0,), ())
SOFT = {"kind": "elastic_modulus", "material": "steel", "factor": 0.9}
WARM: dict[str, Any] = {"kind": "stiffness_temperature", "group": ["top n", "top s"], "rate": -1e-3}


@pytest.fixture(scope="module")
def model() -> Model:
    content = bridge()
    content["context"] = {"air": {"unit": "degC", "range": [-20.0, 40.0]}}
    plain = read_model(content, "bridge")
    warm = {
        "kind": "temperature", "groups": {"top n": 1.0, "top s": 1.0},
        "delta": {"context": "air", "minus": 10.0},
    }  # fmt: skip
    frequencies, _ = dense_mode_shapes(plain, MODES)
    modes = {f"m{k}": ExpectedMode(near=float(f), within=0.15) for k, f in enumerate(frequencies)}
    return plain.extended({"warm": read_effect(warm, "warm")}).model_copy(update={"modes": modes})


@pytest.fixture(scope="module")
def windows(model: Model) -> Windows:
    """With the shapes of the model itself, at its points."""
    frequencies, shapes = dense_mode_shapes(model, MODES)
    nodes = list(model.nodes)
    modes = {}
    for k, (frequency, shape) in enumerate(
        zip(frequencies, shapes.reshape(MODES, len(nodes), 6), strict=True)
    ):
        at = np.array(
            [shape[nodes.index(one.node), :3] @ one.direction for one in model.points.values()]
        )
        modes[f"m{k}"] = FoundMode(
            frequency=frequency,
            scatter=SCATTER,
            memory=MEMORY,
            found=0.9,
            shape=dict(zip(model.points, (at / np.linalg.norm(at)).tolist(), strict=True)),
        )
    return Windows(count=COUNT, contexts={"air": (5.0, 15.0)}, modes=modes)


def site(model: Model, windows: Windows, *tests: LoadTest, late: bool = False) -> ModalSite:
    lane = lane_of_masses(model)
    return ModalSite(model, windows, accelerometers(model), tests, lane, TRUCK, late)


def test_a_parked_mass_moves_modes_as_a_dense_solution_has_it(
    model: Model, windows: Windows
) -> None:
    lane = lane_of_masses(model)
    assert lane is not None
    test = next(one for one in parked(lane, TRUCK) if one.position == 12.0)
    shown = site(model, windows, test).measurements({})[MODES, :MODES]
    content = bridge()
    for node in ("b3n", "b3s"):
        content["masses"][node] = {"node": node, "mass": 10_000.0 / 9.80665}
    before, after = (
        dense_mode_shapes(read_model(one, "bridge"), MODES)[0] for one in (bridge(), content)
    )
    np.testing.assert_allclose(np.sort(shown), np.sort(100 * np.log(after / before)), rtol=1e-6)


def test_so_far_no_truck_stands_though_one_did_in_some_windows(
    model: Model, windows: Windows
) -> None:
    content = {"truck": {"unit": "-", "range": [0.0, 1.0]}}
    load = {
        "kind": "nodal_load", "forces": {"b3n": [0, 0, -20e3]}, "factor": {"context": "truck"},
        "inertia": True,
    }  # fmt: skip
    variables = {name: ContextVariable.model_validate(one) for name, one in content.items()}
    parking = model.model_copy(update={"context": {**model.context, **variables}})
    parking = parking.extended({"truck": read_effect(load, "truck")})
    ranges = {**windows.contexts, "truck": (0.0, 1.0)}
    both = windows.model_copy(update={"contexts": ranges})
    shown, plain = (
        site(one, of, more_windows(of)).measurements({})
        for one, of in ((parking, both), (model, windows))
    )
    np.testing.assert_allclose(shown, plain, atol=1e-9)


def test_what_a_clock_does_no_parked_mass_shows(model: Model, windows: Windows) -> None:
    lane = lane_of_masses(model)
    assert lane is not None
    place = site(model, windows, parked(lane, TRUCK)[3])
    effects: list[dict[str, Effect]] = [
        {"one": read_effect({"kind": "clock_rate", "factor": 0.9**0.5}, "one")},
        {
            "one": read_effect(
                {"kind": "elastic_modulus", "material": "steel", "factor": 0.9}, "one"
            )
        },
    ]
    clock, modulus = (place.measurements(one)[MODES, :MODES] for one in effects)
    np.testing.assert_allclose(clock, modulus, atol=1e-6)
    heavier = {"kind": "mass_factor", "mass": list(model.masses), "factor": 1.1}
    mass = place.measurements({"one": read_effect(heavier, "one")})[MODES, :MODES]
    assert np.abs(mass / modulus - 1.0).max() > 0.05


def test_how_well_they_would_be_known(model: Model, windows: Windows) -> None:
    lane = lane_of_masses(model)
    assert lane is not None
    tests = [parked(lane, TRUCK)[3], more_windows(windows), *seasons(model, windows, {"air"})]
    planned = site(model, windows, *tests)
    errors = planned.errors({})
    noise = errors.noise[MODES:, :MODES] / 100
    so_far, ten = (
        SCATTER / np.sqrt(count * 0.9 * (1 - MEMORY) / (1 + MEMORY)) for count in (COUNT, 10)
    )
    moved = np.abs(planned.measurements({})[MODES, :MODES]) / 100
    off = STANDING_ERROR * np.sqrt(moved * moved.max())
    np.testing.assert_allclose(noise[0], np.hypot(so_far, ten))
    shared = errors.shared[:, MODES, :MODES] / 100
    np.testing.assert_allclose(np.abs(shared), np.diag(off))
    assert not errors.shared[:, MODES + 1 :].any()
    # Together with the windows so far, as many again know what they do to the model's error.
    both = 1.0 / (noise[1] ** -2 + 1.0 / (MODEL_ERROR**2 + so_far**2))
    np.testing.assert_allclose(both, MODEL_ERROR**2 + so_far**2 / 2)
    np.testing.assert_allclose(noise[2], np.hypot(np.sqrt(2) * so_far, WEATHER))


def test_what_the_model_makes_of_a_mass_is_off_alike_in_all_places(
    model: Model, windows: Windows
) -> None:
    lane = lane_of_masses(model)
    assert lane is not None
    planned = site(model, windows, *parked(lane, TRUCK)[2:4])
    moved = planned.measurements({})[MODES:, :MODES]
    shared = planned.errors({}).shared
    for mode in range(MODES):
        assert np.count_nonzero(shared[mode]) == 2
        # Either place tells of the other how far it is off.
        own = shared[mode, MODES:, mode]
        size = np.sqrt(np.abs(moved[:, mode]) * np.abs(moved).max(1))
        np.testing.assert_allclose(own, -STANDING_ERROR * size)


def test_of_what_came_late_the_model_errs_by_a_share(model: Model, windows: Windows) -> None:
    again = more_windows(windows)
    softer: dict[str, Effect] = {"one": read_effect(SOFT, "one")}
    always, late = (
        site(model, windows, again, late=one).errors(softer).noise[MODES, :MODES] / 100
        for one in (False, True)
    )
    so_far = SCATTER / np.sqrt(COUNT * 0.9 * (1 - MEMORY) / (1 + MEMORY))
    stays = CHANGE_ERROR * abs(np.log(0.9)) / 2
    both = 1.0 / (late**-2 + 1.0 / (stays**2 + so_far**2))
    np.testing.assert_allclose(both, stays**2 + so_far**2 / 2, rtol=1e-4)
    assert (always > late).all()


def test_a_season_shows_what_follows_the_air(model: Model, windows: Windows) -> None:
    (season,) = seasons(model, windows, {"air"})
    assert (season.against, season.at) == ({"air": -14.0}, {"air": 34.0})
    planned = site(model, windows, season)
    np.testing.assert_allclose(planned.measurements({})[MODES, :MODES], 0.0, atol=1e-9)
    shown = planned.measurements({"one": read_effect(WARM, "one")})[MODES, :MODES]
    assert shown.max() < 0.0
    assert seasons(model, windows, ()) == []
    wide = windows.model_copy(update={"contexts": {"air": (-14.0, 34.0)}})
    assert seasons(model, wide, {"air"}) == []


def test_an_accelerometer_reads_the_shape_to_the_scale_of_the_points(
    model: Model, windows: Windows
) -> None:
    planned = site(model, windows)
    shown = planned.measurements({})[:, MODES:]
    _, shapes = dense_mode_shapes(model, MODES)
    nodes = list(model.nodes)
    shapes = shapes.reshape(MODES, len(nodes), 6)
    for mode, found in enumerate(windows.modes.values()):
        motion = [
            shapes[mode, nodes.index(p.node), :3] @ p.direction for p in model.points.values()
        ]
        at = np.array(motion)
        scale = np.array(list(found.shape.values())) @ at / (at @ at)
        for column, one in enumerate(planned.added):
            assert one.point is not None
            own = shapes[mode, nodes.index(one.point.node), :3] @ one.point.direction
            assert shown[mode, column] == pytest.approx(scale * own, abs=1e-6)
    errors = planned.errors({}).noise[:MODES, MODES:]
    assert (errors >= np.sqrt(0.025)).all()


def test_a_mass_that_makes_it_doubtful_which_mode_is_which_is_told(
    model: Model, windows: Windows
) -> None:
    lane = lane_of_masses(model)
    assert lane is not None

    def doubtful(load: float) -> list[int]:
        truck = Truck((load,), ())
        tests = parked(lane, truck)
        return ModalSite(model, windows, [], tests, lane, truck, False).doubtful({})

    assert doubtful(20.0) == []
    # A third of what the bridge weighs lets modes trade places.
    assert doubtful(120.0) != []


def test_a_mass_that_seems_to_raise_a_frequency_has_made_modes_trade_names(
    model: Model, windows: Windows, monkeypatch: pytest.MonkeyPatch
) -> None:
    lane = lane_of_masses(model)
    assert lane is not None
    planned = ModalSite(model, windows, [], parked(lane, TRUCK), lane, TRUCK, False)
    assert planned.doubtful({}) == []
    state = planned._states[0][0]
    then = state.predict({})
    traded = replace(then, log_f=then.log_f[:, [1, 0, 2, 3]])
    monkeypatch.setattr(state, "predict", lambda effects: traded)
    assert planned.doubtful({}) == [0]


def test_play_leaves_no_mode_of_its_own_and_shows_in_none(model: Model, windows: Windows) -> None:
    loose = {"kind": "joint_slip", "member": "b0n-t1n", "slip": 0.001}
    plain, slack = SOFT, [SOFT, loose]
    planned = site(model, windows, more_windows(windows))
    effects = {f"{k}": read_effect(one, "one") for k, one in enumerate(slack)}
    alone = planned.measurements({"0": read_effect(plain, "one")})
    np.testing.assert_array_equal(planned.measurements(effects), alone)
    assert planned.doubtful(effects) == planned.doubtful({})


def test_accelerometers_go_where_none_is_and_something_moves(model: Model) -> None:
    places = {(one.point.node, one.point.direction) for one in accelerometers(model) if one.point}
    assert ("b3n", (0.0, 1.0, 0.0)) not in places
    assert ("b3n", (1.0, 0.0, 0.0)) in places
    assert ("b2n", (0.0, 1.0, 0.0)) in places
    assert ("b0n", (0.0, 0.0, 1.0)) not in places


def test_modes_without_a_shape_give_accelerometers_nothing_to_say(
    model: Model, windows: Windows
) -> None:
    blind = {name: one.model_copy(update={"shape": {}}) for name, one in windows.modes.items()}
    planned = site(model, windows.model_copy(update={"modes": blind}))
    assert not planned.measurements({}).any()


def test_windows_of_another_model_are_refused(model: Model, windows: Windows) -> None:
    other = {"sway": windows.modes["m0"]}
    with pytest.raises(InputError, match="mode 'sway', which the model lacks"):
        site(model, windows.model_copy(update={"modes": other}))
    moved = windows.modes["m0"].model_copy(update={"shape": {"roof": 1.0}})
    with pytest.raises(InputError, match="point 'roof', which the model lacks"):
        site(model, windows.model_copy(update={"modes": {"m0": moved}}))
