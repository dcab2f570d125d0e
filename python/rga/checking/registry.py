"""All checks, in the order in which their findings are told. A new check is a file and a line."""

from collections.abc import Callable, Iterable

from rga.checking.finding import Finding
from rga.checking.measured import Measured
from rga.checking.of_model.axles import axles
from rga.checking.of_model.connections import connections
from rga.checking.of_model.context_units import context_units
from rga.checking.of_model.coordinates import coordinates
from rga.checking.of_model.crossings import crossings
from rga.checking.of_model.deformations import deformations
from rga.checking.of_model.duplicates import duplicates
from rga.checking.of_model.gauges import gauges
from rga.checking.of_model.loads import loads
from rga.checking.of_model.masses import masses
from rga.checking.of_model.materials import materials
from rga.checking.of_model.mechanisms import mechanisms
from rga.checking.of_model.sections import sections
from rga.checking.of_model.sensors import sensors
from rga.checking.of_model.simulation import simulation
from rga.checking.of_model.stiffness import stiffness
from rga.checking.of_model.supports import supports
from rga.checking.of_model.temperatures import temperatures
from rga.checking.of_model.unused import unused
from rga.checking.of_modes.looks import looks
from rga.checking.of_record.channels import channels
from rga.checking.of_record.clock import clock
from rga.checking.of_record.codes import codes
from rga.checking.of_record.contexts import contexts
from rga.checking.of_record.missing import missing
from rga.checking.of_record.stuck import stuck
from rga.checking.of_record.units import units
from rga.checking.of_record.zeros import zeros
from rga.checking.over_ranges import OverRanges

#: checks of a model
OF_MODEL: tuple[Callable[[OverRanges], Iterable[Finding]], ...] = (
    connections,
    mechanisms,
    simulation,
    coordinates,
    materials,
    masses,
    looks,
    sections,
    stiffness,
    supports,
    duplicates,
    crossings,
    context_units,
    loads,
    axles,
    temperatures,
    sensors,
    gauges,
    deformations,
    unused,
)
#: checks of a record beside its model
OF_RECORD: tuple[Callable[[Measured], Iterable[Finding]], ...] = (
    channels,
    clock,
    missing,
    codes,
    stuck,
    contexts,
    units,
    zeros,
)
