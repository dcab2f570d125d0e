"""A kind that a user defines is diagnosed, reported and planned for like those of rga."""

from collections.abc import Callable, Iterator, Mapping
from pathlib import Path
from typing import Annotated, Any, Literal

import pytest

from rga import Effect, diagnose, plan
from rga.model import Model, read_model
from rga.model.action import Action
from rga.model.effect import Values
from rga.model.parameter import Normal, Parameter, Place, Prior, Value
from rga.model.readings import Readings
from rga.records import Record

GAUGE = "S L2-L3"
CURVED = {"kind": "curved_gauge", "sensor": GAUGE, "curve": 0.003}


@pytest.fixture
def curved_gauge() -> Iterator[type[Effect]]:
    """A gauge whose reading is no straight line over the strain, which no kind of rga says."""

    class CurvedGauge(Effect):
        """A reading that grows by curve times its square [1/unit]."""

        kind: Literal["curved_gauge"] = "curved_gauge"
        title = "nonlinear gauge"
        action = Action(inspect="the amplifier of {place}")
        usual = "curve -0.016 to 0.016 per unit: for this test"
        on_sensors = True
        sensor: Annotated[str, Place("sensor")]
        curve: Annotated[Value, Parameter("1/unit", 0.0)] = 0.0

        @classmethod
        def places(cls, model: Model) -> Iterator[dict[str, Any]]:
            yield from ({"sensor": sensor} for sensor in model.sensors)

        @classmethod
        def priors(cls, model: Model, place: Mapping[str, Any]) -> dict[str, Prior]:
            return {"curve": Normal(0.0, 0.01)}

        def change_readings(self, readings: Readings, values: Values) -> None:
            column = readings.values[:, readings.columns[self.sensor]]
            column += values["curve"] * column**2

    yield CurvedGauge
    del Effect.vocabulary["curved_gauge"]


@pytest.mark.usefixtures("curved_gauge")
def test_it_is_found_reported_and_planned_for(
    measured_bridge: dict[str, Any], measured_record: Callable[..., Record], tmp_path: Path
) -> None:
    model = read_model(measured_bridge, "bridge")
    findings = diagnose(model, measured_record(model, CURVED))
    (cause,) = findings.causes
    assert (cause.effect["kind"], cause.effect["sensor"]) == ("curved_gauge", GAUGE)
    low, high = cause.effect["curve"]["ci90"]
    assert low < CURVED["curve"] < high
    assert f"nonlinear gauge of {GAUGE}" in findings.sentence()
    html = findings.write(tmp_path).read_text(encoding="utf-8")
    assert "could not be drawn" not in html
    assert f"the amplifier of {GAUGE}" in html
    separations = plan(model, findings).separations
    assert separations
    assert all("nonlinear gauge" in one.one for one in separations)


@pytest.mark.usefixtures("curved_gauge")
def test_it_is_not_found_where_it_is_not(
    measured_bridge: dict[str, Any], measured_record: Callable[..., Record]
) -> None:
    model = read_model(measured_bridge, "bridge")
    findings = diagnose(model, measured_record(model))
    assert (findings.verdict, findings.causes) == ("nothing_wrong", [])
