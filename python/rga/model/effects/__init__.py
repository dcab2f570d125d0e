"""The vocabulary of effects: one file a kind, in folders by what the kinds act on."""

from importlib import import_module
from pkgutil import walk_packages

#: The order in which a diagnosis looks at kinds: findings list what they could not have shown in
#: it, and the last digits of sums follow it. A kind that is not here comes after these. The folders
#: in the order of their names would be simpler, and change both in findings that are on file.
_FIRST = (
    *("supports.support_spring", "supports.support_flexibility", "supports.bearing_friction"),
    *("contexts.context_bias", "contexts.context_gain"),
    *("loads.load_scale", "loads.load_position", "loads.load_eccentricity"),
    *("loads.unmodelled_load", "loads.dead_load", "loads.creep"),
    *("members.added_axial_area", "members.floor_participation", "members.elastic_modulus"),
    *("members.member_stiffness", "members.bending_stiffness", "members.stiffness_temperature"),
    *("joints.joint_rigidity", "joints.end_flexibility", "joints.rigid_end_zone"),
    *("sensors.sensor_bias", "sensors.sensor_gain", "sensors.sensor_drift"),
    *("sensors.sensor_swap", "sensors.sensor_temperature", "sensors.gauge_position"),
    *("supports.support_settlement", "joints.joint_slip", "supports.support_gap"),
)

for _name in _FIRST:
    import_module(f"{__name__}.{_name}")
for _module in walk_packages(__path__, f"{__name__}."):
    import_module(_module.name)
