"""What a cause calls for: where to inspect, which gauge to check, how to test by loading."""

from collections.abc import Mapping
from dataclasses import dataclass
from typing import Any

from rga.report.drawing.places import place_names


@dataclass(frozen=True)
class Action:
    """What to do about a cause, `{place}` standing for its place; empty where there is nothing.

    Attributes:
        inspect: what to look at on the bridge.
        check: which gauge, figure or drawing to check.
        test: which loading or measurement would confirm it.
    """

    inspect: str = ""
    check: str = ""
    test: str = ""


_SLOW = "a heavy vehicle of known weight, at rest at several places"
ACTIONS = {
    "elastic_modulus": Action(
        "nothing on the bridge: all members of {place} answer alike",
        "the modulus and the sections in the drawings, the weights of the loads, and the "
        "calibration of all gauges together: a common factor is in one of them",
        "{slow}: known weights tell the stiffness from the load",
    ),
    "member_stiffness": Action(
        "{place}: section loss, cracks, loose rivets or bolts, buckled plates, and its "
        "connections; measure the remaining thickness",
        "the section of {place} in the drawings against the bridge, and the gauge on it if there "
        "is one",
        "{slow}, near {place}, with a gauge on it: where area is lost its force hardly changes and "
        "its strain grows",
    ),
    "bending_stiffness": Action(
        "{place}: flanges that are corroded, cracked or added, a slab that acts with it or has "
        "cracked",
        "the second moment of area of {place} in the drawings, and which way its section lies",
        "{slow}, across {place}, with gauges on both of its flanges: their difference over the "
        "bending moment is 1/EI",
    ),
    "stiffness_temperature": Action(
        "joints and surfacing of {place} when it is cold and when it is warm",
        "the temperature sensor, and whether the deck or its surfacing bears a share",
        "the same vehicle on a cold and on a warm day",
    ),
    "added_axial_area": Action(
        "what lies along {place} and could share its force: deck, stringers, rails, pipes, and "
        "what ties them to it",
        "whether the drawings show a deck or floor tied to {place}",
        "{slow}, with gauges on {place} and on what may share its force",
    ),
    "floor_participation": Action(
        "stringers and cross girders along {place} and their connections: a share of the chord's "
        "force runs through them, and they were seldom designed for it",
        "whether the drawings show expansion joints in the floor, and whether these still move",
        "{slow}, with gauges on the stringers beside {place} and on the end panels of the chord",
    ),
    "joint_rigidity": Action(
        "gusset plates and end connections of {place}: stiff joints bend the members, look for "
        "cracks at their ends",
        "gauges off the axis of their member: they read this bending",
        "{slow}, with gauges on both faces at the ends of a member of {place}",
    ),
    "end_flexibility": Action(
        "the joints at the ends of {place}: bolts, end plates, welds and web of what it is joined "
        "to",
        "whether these joints were designed as rigid, as semi-rigid or as pins, and their details "
        "in the drawings",
        "{slow}, on {place}, with tilt sensors on both sides of the joint: their difference is "
        "how far it turns",
    ),
    "rigid_end_zone": Action(
        "size and thickness of the gusset plates of {place}",
        "the lengths between gussets in the drawings",
        "{slow}, with gauges in the middle of a member of {place} and beside its gusset",
    ),
    "joint_slip": Action(
        "bolts and rivets at the ends of {place}: loose heads, rust that bleeds, worn paint",
        "the tightening of its bolts",
        "a vehicle driven slowly forth and back, with a gauge on {place}: the readings make a loop",
    ),
    "tension_only": Action(
        "{place}: slack rods or cables, turnbuckles, pins",
        "its tension (by its frequency)",
        "{slow}, with a gauge on {place}: it stays idle until the slack is taken up",
    ),
    "support_spring": Action(
        "the bearing {place}: rust, dirt, seized rollers, a worn sliding face, ballast against its "
        "plate",
        "movement marks of the bearing over a day of changing temperature",
        "measure the movement of the bearing and the strain of the chord beside it over a warm "
        "day, or jack it free and repeat",
    ),
    "support_flexibility": Action(
        "bearing, bedding and masonry at {place}: loose anchor bolts, cracked mortar, soft ground",
        "any displacement sensor whose reference stands on the same pier",
        "{slow}, over the support {place}, with its movement measured against firm ground",
    ),
    "support_settlement": Action(
        "pier or abutment at {place}: scour, cracks, tilt, and the ground about it",
        "levels of the bearings against a bench mark away from the bridge",
        "level the bearings again after some weeks: has it stopped?",
    ),
    "support_gap": Action(
        "the bearing {place}: the play at its stop, packing, uplift, a plate that no longer bears",
        "the gap with a feeler gauge, unloaded and cold",
        "{slow}, near {place}, with its movement measured: the answer changes when the gap closes",
    ),
    "bearing_friction": Action(
        "the bearing {place}: lubrication, rust, dirt, worn sliding faces",
        "movement marks of the bearing over a day of changing temperature",
        "record movement and temperature of the bearing over some days: it sticks, then "
        "slips, in a loop",
    ),
    "thermal_expansion": Action(
        "",
        "the expansion coefficient of {place} in the model, and the temperature sensor: too small "
        "a reading looks alike",
        "a night with steady temperature and a clear day, without load",
    ),
    "thermal_gradient": Action(
        "which parts stand in the sun",
        "where the temperature sensor sits, and add one on the opposite side",
        "a clear day and an overcast one, without load",
    ),
    "thermal_lag": Action(
        "",
        "where the temperature sensor sits: air and steel warm at different rates",
        "a temperature sensor on the steel beside the one there is",
    ),
    "load_scale": Action(
        "",
        "the weights that are assumed for {place}, by a weighbridge, and the dynamic increment",
        "a vehicle of known weight at a crawl",
    ),
    "load_position": Action(
        "",
        "the position that is assumed for {place}: path, first axle, lane, and the clock",
        "a vehicle at rest at marked places",
    ),
    "load_eccentricity": Action(
        "which lane or side the traffic or crowd keeps to",
        "the place of {place} across the bridge",
        "the same vehicle on either side",
    ),
    "unmodelled_load": Action(
        "what loads {place}: wind, snow, water, stored goods",
        "a record of that load (wind, snow depth) beside this one",
        "compare days with it and days without it",
    ),
    "dead_load": Action(
        "what was put on or taken off {place}: surfacing, ballast, pipes, stored goods",
        "works on the bridge about the onset",
        "level the span against earlier levels",
    ),
    "creep": Action(
        "cracks and sag of concrete parts",
        "drift of the gauges without load",
        "level the span without load after some weeks",
    ),
    "sensor_bias": Action(
        "the fixing of sensor {place}",
        "its zero: read it without load and set it again",
        "",
    ),
    "sensor_gain": Action(
        "the fixing of sensor {place}",
        "its calibration factor, sign, bridge circuit and cable length; shunt calibration",
        "read it beside a second sensor at the same place",
    ),
    "sensor_drift": Action(
        "sensor {place}: moisture, adhesive, cable",
        "its zero now and after some days, without load; replace it if it goes on",
        "",
    ),
    "sensor_fault": Action(
        "sensor {place}: cable, connector, amplifier",
        "replace it, or leave the channel out",
        "",
    ),
    "sensor_swap": Action(
        "",
        "the channels {place} at the logger: their plugs or names are exchanged",
        "touch or warm one sensor and see which channel moves",
    ),
    "sensor_temperature": Action(
        "whether sensor {place} stands in the sun",
        "its temperature compensation (dummy gauge, half bridge)",
        "a clear day without load",
    ),
    "gauge_position": Action(
        "where on the section gauge {place} sits",
        "its place in the drawing: off the axis it reads bending too",
        "a second gauge on the opposite face",
    ),
    "context_bias": Action(
        "",
        "the zero of the sensor that measures {place}",
        "read it beside a second instrument",
    ),
    "context_gain": Action(
        "",
        "the calibration of the sensor that measures {place}",
        "read it beside a second instrument at two levels",
    ),
    "clock_lag": Action(
        "",
        "the clocks of the loggers: {place} is recorded late",
        "one sharp event that all loggers see",
    ),
}
#: what a verdict calls for, beside what its causes call for
BY_VERDICT = {
    "nothing_wrong": "Nothing needs doing: the model as it is predicts this record. What these "
    "data could not have shown stands below.",
    "named": "What each cause calls for stands with it.",
    "ambiguous": "First tell the causes from their rivals: what would separate them stands with "
    "each. Until then act on the one that is worse for the bridge.",
    "partial": "What each cause calls for stands with it. Something is left that no kind explains: "
    "what it follows stands below, and the log-odds are less sure than they look.",
    "unknown": "Do not use the model for what it gets wrong here until the reason is known. Where "
    "it shows, when, and what it goes with stand below: look at the bridge, the sensors and the "
    "log book there and then.",
    "unidentifiable": "Measure more: what was asked cannot show in these data.",
}
#: what a place is a part of, and what stands before its name
PARTS = ("member", "group", "support", "sensor", "context", "effect", "material")
OF = {"member": "member ", "group": "the group ", "effect": "the load "}
#: for kinds that users add
OTHERWISE = Action("{place}", "what the model says of {place}", "{slow}, near {place}")


def actions(effect: Mapping[str, Any]) -> list[tuple[str, str]]:
    """What an effect calls for: what sort of action, and in words.

    >>> actions({"kind": "sensor_bias", "sensor": "S1"})[0]
    ('inspect', 'the fixing of sensor S1')
    """
    action = ACTIONS.get(str(effect.get("kind")), OTHERWISE)
    where = _where(effect)
    return [
        (word, said.format(place=where, slow=_SLOW))
        for word, said in (
            ("inspect", action.inspect),
            ("check", action.check),
            ("test", action.test),
        )
        if said
    ]


def _where(effect: Mapping[str, Any]) -> str:
    """The place in a sentence."""
    names: dict[str, list[str]] = {}
    for of, name in place_names(dict(effect)):
        names.setdefault(of, []).append(name)
    said = [
        f"{OF.get(of, '')}{' and '.join(some)}" if of in PARTS else f"({', '.join(some)})"
        for of, some in names.items()
    ]
    return " ".join(said) or "all channels"
