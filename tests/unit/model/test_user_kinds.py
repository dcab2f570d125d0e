"""A kind of effect that a user defines takes part in models, simulation and diagnosis."""

from collections.abc import Iterator, Mapping
from typing import Annotated, Any, Literal

import numpy as np
import pytest

from rga import Effect, Simulator
from rga.diagnosis.search.hypothesis import hypotheses
from rga.model import Model, read_model
from rga.model.parameter import Factor, Parameter, Place, Prior, Value
from rga.model.structure import Structure


class PaintedShut(Effect):
    """A factor on the thermal expansion of one member."""

    kind: Literal["painted_shut"] = "painted_shut"
    structural = True
    member: Annotated[str, Place("member")]
    factor: Annotated[Value, Parameter("-", 1.0)] = 1.0

    @classmethod
    def places(cls, model: Model) -> Iterator[dict[str, Any]]:
        yield from ({"member": name} for name in model.members)

    @classmethod
    def priors(cls, model: Model, place: Mapping[str, Any]) -> dict[str, Prior]:
        return {"factor": Factor(0.2)}

    def change_structure(self, structure: Structure, value: Mapping[str, float]) -> None:
        structure.alpha[structure.members[self.member]] *= value["factor"]


# Other tests must not meet a kind of this one.
del Effect.vocabulary["painted_shut"]


def test_it_is_read_simulated_and_proposed(
    two_bars: dict[str, Any], monkeypatch: pytest.MonkeyPatch
) -> None:
    monkeypatch.setitem(Effect.vocabulary, "painted_shut", PaintedShut)
    plain = read_model(two_bars, "test")
    effect = {"kind": "painted_shut", "member": "west", "factor": 0.5}
    two_bars["effects"]["paint"] = effect
    painted = read_model(two_bars, "test")
    warm = {"temperature": 30.0, "load": 0.0}
    assert not np.allclose(Simulator(plain).predict(warm), Simulator(painted).predict(warm))
    proposed = [
        h.place for h in hypotheses(plain, list(plain.sensors), ()) if h.kind is PaintedShut
    ]
    assert proposed == [{"member": "west"}, {"member": "east"}]
