"""What a model weighs, as a check tells it."""

import json

import pytest

from rga import ModelBuilder
from rga.checking import check
from rga.model import Model, read_model
from rga.samples import sample_files


def portal(density: float = 7850.0, light: bool = False, box: float | None = None) -> Model:
    """Two columns and a beam, of which one column may be of a material without density."""
    build = ModelBuilder("portal").add_material("steel", E=2.1e11, density=density)
    build.add_material("light", E=2.1e11)
    build.add_section("I", A=5e-3, Iy=2e-5, Iz=2e-5, J=1e-6)
    for name, x, z in (("A", 0, 0), ("B", 0, 4), ("C", 5, 4), ("D", 5, 0)):
        build.add_node(name, x=float(x), z=float(z))
    material = {"material": "light"} if light else {"material": "steel"}
    build.add_member("A", "B", "I", kind="frame", groups="columns", **material)
    build.add_member("D", "C", "I", kind="frame", groups="columns", material="steel")
    build.add_member("B", "C", "I", kind="frame", groups="beam", material="steel")
    build.support("A", "fixed").support("D", "fixed")
    if box is not None:
        build.mass("C", box)
    return build.build()


def told(model: Model) -> list[str]:
    return [str(one) for one in check(model).findings if "mass" in str(one) or "weighs" in str(one)]


def test_a_model_without_masses_or_modes_is_not_weighed() -> None:
    assert told(portal()) == []


def test_what_it_weighs_part_by_part() -> None:
    (note,) = told(portal(box=2500.0))
    assert note.startswith("note: it weighs 3.01 t: on nodes 2.5, columns 0.314, beam 0.196")


def test_members_without_density_beside_others() -> None:
    warning, note = (str(one) for one in check(portal(light=True, box=10.0)).findings[:2])
    assert "material 'light' has no density" in warning
    assert note.startswith("note")


def test_nothing_that_weighs() -> None:
    (note,) = told(portal(density=0.0, box=0.0))
    assert note.startswith("warning")
    assert "nothing has a mass" in note


@pytest.mark.parametrize(("box", "mistaken"), [(0.25, True), (250.0, False), (2.5e6, True)])
def test_masses_in_another_unit_than_kilograms(box: float, mistaken: bool) -> None:
    assert any("masses beside the members" in one for one in told(portal(box=box))) == mistaken


def test_a_structure_that_is_known_by_its_modes_needs_no_other_sensor() -> None:
    crane = read_model(json.loads(sample_files("crane")["model.json"]), "crane")
    for model, missing in ((crane, False), (portal(), True)):
        notes = [str(one) for one in check(model).findings]
        assert any("it has no sensor" in note for note in notes) is missing
