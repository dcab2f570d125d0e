"""Effects on masses: what they weigh, which frequencies follow, and what is refused."""

from typing import Any

import numpy as np
import pytest

import rga
from rga.model import Model, read_model
from rga.model.effects.masses.added_mass import AddedMass
from rga.model.schema import read_effect
from rga.model.structure import build_structure


def mast() -> Model:
    """A column with a density of its own, a mass along it and one on its head."""
    build = rga.ModelBuilder("mast")
    build.add_material("steel", E=210e9, nu=0.3, density=8000)
    build.add_section("tube", A=1e-2, Iy=1e-4, Iz=1e-4, J=2e-4)
    build.add_node("foot").add_node("head", z=5)
    build.add_member("foot", "head", "tube", kind="frame", groups="shaft")
    build.support("foot", "fixed").mass("head", 300).mass_along("shaft", 20, name="cables")
    return build.build()


def with_effect(**keys: Any) -> Model:
    return mast().extended({"more": read_effect(keys, "more")})


@pytest.mark.parametrize(
    ("given", "place", "spread"),
    [
        ({"node": "head", "mass": 300.0}, {"node": "head"}, 1000.0),
        ({"node": "head", "mass": 40_000.0}, {"node": ["foot", "head"]}, 10_000.0),
        ({"group": "shaft", "per_length": 20.0}, {"group": "shaft"}, 100.0),
        ({"group": ["shaft"], "per_length": 2000.0}, {"group": "shaft"}, 500.0),
    ],
)
def test_what_may_be_added_goes_with_what_stands_there(
    given: dict[str, Any], place: dict[str, Any], spread: float
) -> None:
    content = mast().model_dump(mode="json", exclude_none=True) | {"masses": {"deck": given}}
    (prior,) = AddedMass.priors(read_model(content, "mast"), place).values()
    assert prior.value(1.0) == spread


def test_something_heavy_may_stand_on_any_node() -> None:
    places = list(AddedMass.places(mast()))
    assert {"node": "foot"} in places
    assert {"node": "head"} in places
    (prior,) = AddedMass.priors(mast(), {"node": "foot"}).values()
    # A vehicle of five tonnes is unusual and possible.
    assert 3.0 < prior.z(5000.0) < 4.0


def weighed(model: Model) -> tuple[float, float]:
    """Mass along the member [kg/m] and on the head [kg], effects put on."""
    structure = build_structure(model).copy()
    for effect in model.effects.values():
        values = {name: getattr(effect, name) for name in effect.parameters()}
        effect.change_structure(structure, values)
    return structure.masses["line"][0], structure.masses["nodal"][1, 0]


def test_density_and_stated_masses_add_up() -> None:
    structure = build_structure(mast())
    assert structure.masses["line"].tolist() == [100.0]
    assert structure.masses["nodal"][1].tolist() == [300.0] * 3 + [0.0] * 3
    np.testing.assert_allclose(structure.masses["section"], [[8000 * 2e-4, 0, 0]])


@pytest.mark.parametrize(
    ("effect", "expected"),
    [
        ({"kind": "added_mass", "group": "shaft", "per_length": 5.0}, (105.0, 300.0)),
        ({"kind": "added_mass", "node": "head", "mass": -100.0}, (100.0, 200.0)),
        ({"kind": "mass_factor", "material": "steel", "factor": 1.1}, (108.0, 300.0)),
        ({"kind": "mass_factor", "mass": "cables", "factor": 0.5}, (90.0, 300.0)),
        ({"kind": "mass_factor", "mass": ["cables", "head"], "factor": 2.0}, (120.0, 600.0)),
    ],
)
def test_an_effect_weighs_what_it_says(
    effect: dict[str, Any], expected: tuple[float, float]
) -> None:
    assert weighed(with_effect(**effect)) == pytest.approx(expected)


def test_all_masses_twice_are_frequencies_by_the_root_of_two() -> None:
    twice = mast().extended(
        {
            "own": read_effect({"kind": "mass_factor", "material": "steel", "factor": 2.0}, "own"),
            "stated": read_effect(
                {"kind": "mass_factor", "mass": ["head", "cables"], "factor": 2.0}, "stated"
            ),
        }
    )
    ratio = rga.modes(mast(), 4).frequencies / rga.modes(twice, 4).frequencies
    np.testing.assert_allclose(ratio, np.sqrt(2), rtol=1e-9)


def test_statics_knows_no_mass() -> None:
    model = with_effect(kind="added_mass", node="head", mass=500.0)
    push = {"push": read_effect({"kind": "nodal_load", "forces": {"head": [1e3, 0, 0]}}, "push")}
    one, other = rga.results(mast().extended(push)), rga.results(model.extended(push))
    assert one.displacements.tolist() == other.displacements.tolist()


@pytest.mark.parametrize(
    "effect",
    [
        {"kind": "added_mass", "per_length": 5.0},
        {"kind": "added_mass", "group": "shaft", "mass": 5.0},
        {"kind": "added_mass", "node": "head", "per_length": 5.0},
        {"kind": "added_mass", "node": "nowhere", "mass": 5.0},
        {"kind": "mass_factor", "factor": 2.0},
        {"kind": "mass_factor", "mass": "asphalt", "factor": 2.0},
        {"kind": "mass_factor", "mass": "head", "material": "steel", "factor": 2.0},
        {"kind": "mass_factor", "mass": "head", "factor": -0.1},
    ],
)
def test_places_that_are_none_are_refused(effect: dict[str, Any]) -> None:
    with pytest.raises((ValueError, rga.InputError)):
        with_effect(**effect)


def test_more_is_taken_off_than_there_is() -> None:
    """Of what members weigh half is at each end, or a third of all by itself."""
    assert rga.modes(with_effect(kind="added_mass", node="head", mass=-400.0), 1).frequencies[0] > 0
    with pytest.raises(rga.InputError, match="more mass is taken off node 'head' than there is"):
        rga.modes(with_effect(kind="added_mass", node="head", mass=-600.0))


@pytest.mark.parametrize(
    "mass",
    [
        {"node": "head"},
        {"mass": 3.0},
        {"group": "shaft"},
        {"node": "head", "mass": 3.0, "group": "shaft"},
        {"group": "shaft", "per_length": 3.0, "inertia": [1, 1, 1]},
        {"group": "shaft", "per_length": -3.0},
        {"node": "nowhere", "mass": 3.0},
        {"group": "nowhere", "per_length": 3.0},
    ],
)
def test_masses_that_are_none_are_refused(mass: dict[str, Any]) -> None:
    content = mast().model_dump(mode="json")
    content["masses"] = {"odd": mass}
    with pytest.raises(ValueError, match=r"mass|nowhere|per_length"):
        Model.model_validate(content)
