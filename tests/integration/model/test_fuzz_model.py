"""The reader of model files on damaged models: a model that can be used, or one clear refusal."""

import copy
import json
from collections.abc import Callable, Iterator
from pathlib import Path
from typing import Any

import numpy as np
import pytest
import yaml
from hypothesis import given, settings
from hypothesis import strategies as st
from numpy.typing import NDArray

from rga.errors import InputError, SeveralMistakes
from rga.model import Model, load_model, read_model
from rga.simulation import Simulator

Place = tuple[str | int, ...]
pytestmark = pytest.mark.filterwarnings("ignore::RuntimeWarning")  # numbers that overflow


def small_model() -> dict[str, Any]:
    """A frame with a truss on it, loads and temperatures."""
    post = {"section": "post", "material": "steel", "kind": "frame"}
    bar = {"section": "bar", "material": "steel", "groups": ["bars"]}
    return {
        "rga_model": 1,
        "name": "small",
        "plane": "xz",
        "materials": {"steel": {"E": 2e11, "nu": 0.3, "alpha": 1.2e-5, "density": 7850.0}},
        "sections": {
            "post": {"A": 0.01, "Iy": 2e-4, "Iz": 1e-4, "J": 1e-5, "Asz": 0.004},
            "bar": {"A": 0.002},
        },
        "nodes": {"A": [0, 0, 0], "B": [0, 0, 4], "C": [5, 0, 4], "D": [5, 0, 0], "E": [2.5, 0, 6]},
        "members": {
            "left": {"nodes": ["A", "B"], **post, "groups": ["posts"]},
            "beam": {
                "nodes": ["B", "C"],
                **post,
                "groups": ["deck"],
                "local_y": [0, 1, 0],
                "releases": {"i": [], "j": ["ry"]},
            },
            "right": {"nodes": ["D", "C"], **post, "end_springs": {"i": {"ry": 1e7}, "j": {}}},
            "rafter": {"nodes": ["B", "E"], **bar},
            "brace": {"nodes": ["C", "E"], **bar},
        },
        "supports": {
            "west": {"node": "A", "fixed": ["ux", "uz", "ry"]},
            "east": {"node": "D", "fixed": ["uz"]},
            "side": {"node": "D", "along": [1, 0, 0.2]},
        },
        "springs": [{"node": "D", "dof": "ry", "stiffness": 1e6}],
        "ties": [{"nodes": ["B", "C"], "dofs": ["ux"]}],
        "context": {
            "temperature": {"unit": "degC", "range": [-20, 40], "noise": 0.3},
            "wagon": {"unit": "m", "range": [-2, 8], "law": "linear", "rate": [-5, 5]},
        },
        "effects": {
            "warmth": {
                "kind": "temperature",
                "groups": {"bars": 1.0, "deck": 0.5},
                "delta": {"context": "temperature", "minus": 10.0},
            },
            "axles": {
                "kind": "axle_load",
                "path": ["B", "C"],
                "forces": [5e4, 3e4],
                "offsets": [0.0, 1.5],
                "position": {"context": "wagon"},
            },
            "snow": {"kind": "member_load", "member": "beam", "uniform": [0, 0, -2e3]},
            "crane": {"kind": "nodal_load", "forces": {"E": [1e3, 0, -5e3]}, "factor": 0.8},
        },
        "sensors": {
            "D1": {
                "kind": "displacement",
                "node": "E",
                "direction": [0, 0, 1],
                "relative_to": "A",
                "unit": "mm",
                "zero": [0.0, 600.0],
            },
            "S1": {
                "kind": "strain",
                "member": "beam",
                "unit": "microstrain",
                "at": 0.3,
                "z": 0.1,
                "noise": 0.5,
            },
            "F1": {"kind": "force", "member": "rafter", "unit": "kN"},
            "R1": {"kind": "reaction", "node": "A", "direction": [0, 0, 1], "unit": "kN"},
            "T1": {"kind": "rotation", "node": "C", "direction": [0, 1, 0], "unit": "mrad"},
        },
    }


OTHER_EFFECTS: list[dict[str, Any]] = [
    {"kind": "added_axial_area", "group": "bars", "area": 1e-3},
    {"kind": "clock_lag", "sensor": "D1", "time": 60.0},
    {"kind": "clock_lag", "time": 60.0},
    {"kind": "context_bias", "context": "temperature", "offset": 1.0},
    {"kind": "context_gain", "context": "temperature", "factor": 1.1},
    {"kind": "creep", "amplitude": 0.2},
    {"kind": "dead_load", "group": "deck", "force_per_length": 100.0, "onset": "1970-01-01T00:30"},
    {"kind": "elastic_modulus", "material": "steel", "factor": 0.95},
    {"kind": "floor_participation", "group": "deck", "area": 1e-3, "connector_stiffness": 1e7},
    {"kind": "gauge_position", "sensor": "S1", "y": 0.0, "z": 0.05},
    {"kind": "joint_rigidity", "group": "posts", "stiffness": 1e6},
    {"kind": "load_eccentricity", "effect": "axles", "share": 0.1},
    {"kind": "load_position", "effect": "axles", "offset": 0.1},
    {"kind": "load_scale", "effect": ["axles", "snow"], "factor": 1.1},
    {"kind": "member_load", "member": ["beam"], "trapezoid": [0.5, 3.0, 1e3, 2e3], "axis": "z"},
    {"kind": "member_load", "member": "left", "point": [0, 1e3, 2e3], "x": 1.0},
    {"kind": "member_stiffness", "group": "bars", "factor": 0.9},
    {"kind": "bending_stiffness", "group": "deck", "factor": 0.9},
    {"kind": "end_flexibility", "group": "deck", "at_end": "j", "stiffness": 1e7},
    {"kind": "rigid_end_zone", "group": "deck", "length": 0.2},
    {"kind": "sensor_bias", "sensor": "D1", "offset": 0.1},
    {"kind": "sensor_drift", "sensor": "D1", "rate": 0.1, "onset": 600.0},
    {"kind": "sensor_gain", "sensor": "D1", "factor": 1.02},
    {"kind": "sensor_swap", "sensors": ["F1", "R1"]},
    {"kind": "sensor_temperature", "sensor": "D1", "rate": 0.1},
    {"kind": "stiffness_temperature", "group": "bars", "rate": -0.001, "kink": 5.0},
    {"kind": "support_flexibility", "support": "west", "dof": "uz", "stiffness": 1e8},
    {
        "kind": "support_settlement",
        "support": ["east"],
        "dof": "uz",
        "displacement": {"value": -2e-3, "ci90": [-3e-3, -1e-3]},
        "onset": 1800.0,
        "profile": "ramp",
    },
    {"kind": "support_spring", "support": "east", "dof": "ux", "stiffness": 1e6},
    {"kind": "thermal_expansion", "material": "steel", "factor": 1.1},
    {"kind": "thermal_gradient", "axis": "vertical", "ratio": 0.1},
    {"kind": "thermal_lag", "time_constant": 2.0},
    {
        "kind": "unmodelled_load",
        "group": "deck",
        "direction": [0, 0, 1],
        "context": "temperature",
        "rate": 10.0,
    },
]

JUNK: list[Any] = [
    None, True, False, 0, -1, 1, 2, 0.5, -0.0, 1e308, -1e308, 1e-308, 5e-324, 1e30, 1e-30,
    float("nan"), float("inf"), float("-inf"), 10**400, "", " ", "x", "A", "ux", "beam", "bars",
    "warmth", "temperature", "nan", "1e5", "2024-01-01", "\ud800", "\0", [], {}, [[]], [None],
    [0, 0, 0], [1e200, 0, 0], ["A", "A"], ["A", "Q"], {"": {}}, {"context": "wagon"},
    {"context": "Q"}, {"value": 1.0, "ci90": [0, 0]}, {"kind": "truss"},
]  # fmt: skip
FACTORS = [-1.0, 0.0, 1e-300, 1e-12, 1e-6, 1e6, 1e12, 1e300]
TOKENS = [
    "{", "}", "[", "]", '"', ",", ":", "\n", "- ", "? ", "&a ", "*a", "= ", "#", "\t", "\0", "null",
    "NaN", "-Infinity", "1e999", "9" * 5000, "[" * 5000, '{"a":' * 5000, "\\ud800", "\ufeff",
    ".nan", "!!python/object:os.system x", "!!binary x", "2024-01-01", "0x1F", "1_000", '"A"',
]  # fmt: skip


def places(part: Any, here: Place = ()) -> Iterator[Place]:
    """Every place in a tree of tables and lists, the root left out."""
    for key, value in part.items() if isinstance(part, dict) else enumerate(part):
        yield (*here, key)
        if isinstance(value, dict | list):
            yield from places(value, (*here, key))


def at(part: Any, place: Place) -> Any:
    for key in place:
        part = part[key]
    return part


@st.composite
def damaged_models(draw: st.DrawFn) -> dict[str, Any]:
    """The small model with one more effect, damaged in one to three places."""
    model = small_model()
    model["effects"]["other"] = copy.deepcopy(draw(st.sampled_from(OTHER_EFFECTS)))
    for _ in range(draw(st.integers(1, 3))):
        known = list(places(model))
        place = draw(st.sampled_from(known))
        part, key = at(model, place[:-1]), place[-1]
        match draw(st.sampled_from(["junk", "junk", "scale", "copy", "drop", "rename", "wrap"])):
            case "junk":
                part[key] = copy.deepcopy(draw(st.sampled_from(JUNK)))
            case "scale" if isinstance(part[key], float):
                part[key] *= draw(st.sampled_from(FACTORS))
            case "copy":
                part[key] = copy.deepcopy(at(model, draw(st.sampled_from(known))))
            case "drop":
                del part[key]
            case "rename" if isinstance(part, dict):
                part[draw(st.sampled_from(known))[-1]] = part.pop(key)
            case "wrap":
                for _ in range(draw(st.sampled_from([1, 50]))):
                    part[key] = [part[key]]
    return model


@st.composite
def damaged_texts(draw: st.DrawFn) -> tuple[str, bytes]:
    """A suffix, and the small model as such a file, cut or with something in its way."""
    suffix = draw(st.sampled_from(sorted(TEXTS)))
    text = TEXTS[suffix]
    for _ in range(draw(st.integers(1, 2))):
        first = draw(st.integers(0, len(text)))
        last = draw(st.sampled_from([first, first + 1, first + 9, len(text)]))
        text = text[:first] + draw(st.sampled_from(["", *TOKENS])) + text[last:]
    raw = text.encode()
    return suffix, raw[: draw(st.sampled_from([len(raw), 40]))] + draw(
        st.sampled_from([b"", b"\xff"])
    )


def toml(value: Any) -> str:
    """A value of a TOML file, tables inline."""
    if isinstance(value, dict):
        return "{" + ", ".join(f'"{key}" = {toml(one)}' for key, one in value.items()) + "}"
    if isinstance(value, list):
        return "[" + ", ".join(map(toml, value)) + "]"
    return json.dumps(value) if isinstance(value, str) else repr(value)


TEXTS = {
    ".json": json.dumps(small_model()),
    ".toml": "\n".join(f'"{key}" = {toml(value)}' for key, value in small_model().items()),
    ".yaml": yaml.safe_dump(small_model()),
}


def predict(model: Model) -> NDArray[np.float64]:
    """Through the ranges of the contexts, over two hours."""
    contexts = {name: np.linspace(*each.range, 3) for name, each in model.context.items()}
    return Simulator(model).predict({**contexts, "time": np.array([0.0, 1800.0, 3600.0])})


def refusal(read: Callable[[], Model]) -> str:
    """What the refusal of a model says, or nothing where it predicts; other errors come through."""
    try:
        model = read()
        values = predict(model)
    except InputError as error:
        return str(error)
    assert values.shape == (3, len(model.sensors))
    assert np.isfinite(values).all()
    return ""


@pytest.mark.parametrize("other", OTHER_EFFECTS, ids=lambda effect: str(effect["kind"]))
def test_the_sound_model_is_used(other: dict[str, Any]) -> None:
    model = small_model()
    model["effects"]["other"] = other
    assert refusal(lambda: read_model(model, "model")) == ""


def check_each_junk(model: dict[str, Any], chosen: list[Place]) -> None:
    """Damages one place after the other with every piece of junk, and without the place."""
    for place in chosen:
        for junk in JUNK:
            damaged = copy.deepcopy(model)
            at(damaged, place[:-1])[place[-1]] = copy.deepcopy(junk)
            check(damaged)
        damaged = copy.deepcopy(model)
        del at(damaged, place[:-1])[place[-1]]
        check(damaged)


def check(damaged: dict[str, Any]) -> None:
    assert_short(refusal(lambda: read_model(damaged, "model")))


def assert_short(refused: str) -> None:
    """One line, or a list of mistakes with a line each."""
    first, *mistakes = refused.split("\n")
    assert len(mistakes) <= SeveralMistakes.MOST + 1
    assert len(set(mistakes)) == len(mistakes)
    if mistakes:
        assert f"{len(mistakes)} mistakes" in first or "... and " in mistakes[-1]


@pytest.mark.parametrize(
    "first", [0, *(pytest.param(first, marks=pytest.mark.thorough) for first in (1, 2))]
)
def test_junk_anywhere_in_the_model(first: int) -> None:
    """In every third place, from one of the first three on."""
    model = small_model()
    check_each_junk(model, list(places(model))[first::3])


@pytest.mark.parametrize("other", OTHER_EFFECTS, ids=lambda effect: str(effect["kind"]))
def test_junk_in_an_effect(other: dict[str, Any]) -> None:
    model = small_model()
    model["effects"]["other"] = other
    check_each_junk(model, [("effects", "other", *place) for place in places(other)])


@settings(max_examples=250, derandomize=True, deadline=None)
@given(damaged_models())
def test_several_damages(model: dict[str, Any]) -> None:
    check(model)


@settings(max_examples=120, derandomize=True, deadline=None)
@given(damaged_texts())
def test_damaged_texts(
    tmp_path_factory: pytest.TempPathFactory, damaged: tuple[str, bytes]
) -> None:
    suffix, raw = damaged
    path = tmp_path_factory.getbasetemp() / f"model{suffix}"
    path.write_bytes(raw)
    assert_short(refusal(lambda: load_model(path)))


@pytest.mark.parametrize("suffix", TEXTS)
def test_the_sound_text_is_used(suffix: str, tmp_path: Path) -> None:
    path = tmp_path / f"model{suffix}"
    path.write_text(TEXTS[suffix], encoding="utf-8")
    assert refusal(lambda: load_model(path)) == ""
