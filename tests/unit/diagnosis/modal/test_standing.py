"""Which contexts are weather, and which say where a load of known mass stands."""

import numpy as np
import pytest

from independent.modal_bridge import bridge
from rga.diagnosis.modal.standing import brings_mass, weather, without_standing
from rga.model import Model, read_effect, read_model


@pytest.fixture
def model() -> Model:
    content = bridge()
    content["context"] = {
        name: {"unit": "-", "range": [0, 1]} for name in ("truck", "crowd", "wind", "air")
    }
    plain = read_model(content, "bridge")

    def load(driver: str, inertia: bool) -> dict[str, object]:
        force = {"b3n": [0, 0, -1000]}
        return {
            "kind": "nodal_load", "forces": force, "factor": {"context": driver},
            "inertia": inertia,
        }  # fmt: skip

    effects = {
        "truck": load("truck", True),
        "crowd": load("crowd", True),
        "wind": load("wind", False),
        "crowded": {
            "kind": "member_stiffness", "group": "top n",
            "factor": {"context": "crowd", "kink": 0, "above": -0.1},
        },
    }  # fmt: skip
    return plain.extended({name: read_effect(one, name) for name, one in effects.items()})


def test_what_drives_loads_of_known_mass_alone_is_no_weather(model: Model) -> None:
    columns = {name: np.zeros(3) for name in model.context}
    assert list(weather(model, columns)) == ["crowd", "wind", "air"]


def test_without_what_stands_the_rest_is_kept(model: Model) -> None:
    assert [name for name, one in model.effects.items() if brings_mass(one)] == ["truck", "crowd"]
    bare = without_standing(model)
    assert list(bare.effects) == ["wind", "crowded"]
    assert without_standing(bare) is bare
