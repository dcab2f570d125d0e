"""A kind of effect that a user defines takes part in all that rga does, from its class alone."""

import json
from collections.abc import Iterator, Mapping
from pathlib import Path
from typing import Annotated, Any, Literal

import jsonschema
import numpy as np
import pytest

from rga import Effect, Simulator
from rga.diagnosis.search.hypothesis import hypotheses
from rga.errors import InputError
from rga.experiments.defaults import strain_share, usual_truck
from rga.experiments.explanation import explanation
from rga.experiments.truck import lane_of
from rga.findings.phrases import effect_words
from rga.findings.schema import Cause
from rga.model import Model, model_schema, read_effect, read_model
from rga.model.action import VEHICLE, Action
from rga.model.effects.loads.nodal_load import NodalLoad
from rga.model.parameter import Factor, Parameter, Place, Prior, Value
from rga.model.structure import Structure
from rga.model.vocabulary import entries, entry, updated
from rga.report.pages.cards import card
from rga.report.text.actions import actions

USUAL = Factor(0.2)
PAGE = Path(__file__).parents[3] / "docs" / "reference" / "vocabulary.md"
PAINT = {
    "kind": "painted_joint",
    "member": "west",
    "factor": {"value": 0.5, "ci90": [0.4, 0.6]},
}


@pytest.fixture
def painted_joint() -> Iterator[type[Effect]]:
    """A kind of a user's own, for a while."""

    class PaintedJoint(Effect):
        """A factor on the thermal expansion of one member.

        Attributes:
            factor: over what the material has [-].
        """

        kind: Literal["painted_joint"] = "painted_joint"
        title = "paint in the joint"
        action = Action(inspect="the expansion joint beside {place}", test="{load}, on a warm day")
        usual = f"factor {USUAL}: seen on three bridges"
        structural = True
        member: Annotated[str, Place("member")]
        factor: Annotated[Value, Parameter("-", 1.0)] = 1.0

        @classmethod
        def places(cls, model: Model) -> Iterator[dict[str, Any]]:
            yield from ({"member": name} for name in model.members)

        @classmethod
        def priors(cls, model: Model, place: Mapping[str, Any]) -> dict[str, Prior]:
            return {"factor": USUAL}

        def change_structure(self, structure: Structure, value: Mapping[str, float]) -> None:
            structure.alpha[structure.members[self.member]] *= value["factor"]

    yield PaintedJoint
    del Effect.vocabulary["painted_joint"]


def test_it_is_read_simulated_and_proposed(
    two_bars: dict[str, Any], painted_joint: type[Effect]
) -> None:
    plain = read_model(two_bars, "test")
    two_bars["effects"]["paint"] = PAINT
    painted = read_model(two_bars, "test")
    warm = {"temperature": 30.0, "load": 0.0}
    assert not np.allclose(Simulator(plain).predict(warm), Simulator(painted).predict(warm))
    proposed = [
        h.place for h in hypotheses(plain, list(plain.sensors), ()) if h.kind is painted_joint
    ]
    assert proposed == [{"member": "west"}, {"member": "east"}]


@pytest.mark.usefixtures("painted_joint")
def test_it_is_named_and_advised_on_in_its_own_words(two_bars: dict[str, Any]) -> None:
    words = effect_words(PAINT)
    assert words == "paint in the joint of west: factor 0.5 [0.4, 0.6]"
    assert actions(PAINT) == [
        ("inspect", "the expansion joint beside member west"),
        ("test", f"{VEHICLE}, on a warm day"),
    ]
    cause = Cause(effect=PAINT, status="named", log_odds=9.0, d_prime=8.0, d_perp=7.0)
    shown = card(cause, read_model(two_bars, "test"), words, [])
    assert (shown.title, shown.place) == ("paint in the joint", "member west")
    assert dict(shown.values)["factor"].startswith("0.50")


@pytest.mark.usefixtures("painted_joint")
def test_plans_know_how_sure_its_size_is(two_bars: dict[str, Any]) -> None:
    model = read_model(two_bars, "test")
    (unknown,) = explanation("paint", model, [read_effect(PAINT, "paint")]).unknowns
    assert unknown.prior is USUAL
    assert unknown.prior.value(unknown.centre) == pytest.approx(0.5)


def test_a_load_of_a_users_own_measures_the_truck(small_bridge: dict[str, Any]) -> None:
    class Crowd(NodalLoad):
        """People."""

        kind: Literal["crowd"] = "crowd"  # type: ignore[assignment]

    try:
        crowded = json.loads(json.dumps(small_bridge))
        for name in ("west", "east"):
            crowded["effects"][name]["kind"] = "crowd"
        trucks, shares = [], []
        for content in (small_bridge, crowded):
            model = read_model(content, "test")
            lane = lane_of(read_model(small_bridge, "test"))
            assert lane is not None
            trucks.append(usual_truck(model, lane))
            shares.append(strain_share(model, lane, trucks[-1]))
    finally:
        del Effect.vocabulary["crowd"]
    assert trucks[0] == trucks[1]
    assert shares[0] == shares[1] > 0


@pytest.mark.usefixtures("painted_joint")
def test_it_stands_in_the_schema(two_bars: dict[str, Any]) -> None:
    own = model_schema()["$defs"]["PaintedJoint"]
    assert own["description"] == "A factor on the thermal expansion of one member."
    assert own["properties"]["member"]["description"] == "place, member"
    factor = own["properties"]["factor"]["description"]
    assert factor == "over what the material has [-]; 1 does nothing"
    valid = jsonschema.Draft202012Validator(model_schema()).is_valid
    two_bars["effects"]["paint"] = PAINT
    assert valid(two_bars)
    two_bars["effects"]["paint"] = PAINT | {"colour": "red"}
    assert not valid(two_bars)


def test_it_stands_on_the_page(painted_joint: type[Effect]) -> None:
    page = entries(Effect.vocabulary.values())
    assert "## Kinds of your own\n### `painted_joint`\n" in page
    written = entry(painted_joint)
    assert written in page
    for words in (
        "A factor on the thermal expansion of one member.",
        "- `member`: place, member\n",
        "- `factor`: over what the material has [-]; 1 does nothing\n",
        "- usual size: factor 0.72 to 1.4: seen on three bridges\n",
        "*inspect* the expansion joint beside *place*; *test* a heavy vehicle",
    ):
        assert words in written


@pytest.mark.usefixtures("painted_joint")
def test_the_page_of_the_repository_is_that_of_the_classes() -> None:
    page = PAGE.read_text(encoding="utf-8")
    assert updated(page) == page, "run: python tools/vocabulary.py"
    for kind in Effect.vocabulary.values():
        assert (entry(kind) in page) == kind.__module__.startswith("rga.")


def test_a_kind_without_words_has_those_of_its_name(two_bars: dict[str, Any]) -> None:
    try:

        class Plain(Effect):
            kind: Literal["of_my_own"] = "of_my_own"
            member: Annotated[str, Place("member")]
            factor: Annotated[Value, Parameter("-", 1.0)] = 1.0

        effect = {"kind": "of_my_own", "member": "west", "factor": 2.0}
        assert effect_words(effect) == "of my own of west: factor 2"
        assert dict(actions(effect)) == {
            "inspect": "member west",
            "check": "what the model says of member west",
            "test": f"{VEHICLE}, near member west",
        }
        assert list(Plain.places(read_model(two_bars, "test"))) == []
        assert entry(Plain).splitlines() == [
            "### `of_my_own`",
            "",
            "- `member`: place, member",
            "- `factor`: [-]; 1 does nothing",
        ]
    finally:
        del Effect.vocabulary["of_my_own"]


def test_a_kind_that_exists_is_refused() -> None:
    known = Effect.vocabulary["nodal_load"]
    with pytest.raises(InputError, match="nodal_load") as refused:

        class Other(Effect):
            """Another nodal load."""

            kind: Literal["nodal_load"] = "nodal_load"

    assert "rga.model.effects.loads.nodal_load.NodalLoad" in refused.value.what
    assert "Other" in refused.value.where
    # One that inherits the kind of another is no kind of its own either.
    with pytest.raises(InputError, match="kind of its own"):

        class Heavier(NodalLoad):
            """A nodal load under the name of all others."""

    assert Effect.vocabulary["nodal_load"] is known is NodalLoad
