"""Building models in Python: parts, sections and whole structures, in units as people write them.

>>> from rga.building import howe_truss
>>> truss = howe_truss("roof", "20 m", "2.4 m", 7, chords="SHS 120x6.3", diagonals="SHS 80x5")
>>> truss = truss.context("snow", "kPa", (0, 2.5), noise=0.05)
>>> truss = truss.context("air", "degC", (-20, 40), noise=0.3).temperature("air", "10 degC")
>>> snow = dict.fromkeys(truss.nodes_in("top chord"), "17 kN")
>>> truss = truss.load_case("snow load", down=snow, context="snow")
>>> truss = truss.sensors("strain", "bottom chord", noise=1.0)
>>> truss = truss.sensors("displacement", ["L2", "L3", "L4"], direction="z", noise="0.1 mm")
>>> model = truss.build()
>>> len(model.members), len(model.sensors), model.effects["snow load"].forces["U1"]
(26, 10, [0.0, 0.0, -17000.0])
"""

from rga.building.builder import ModelBuilder
from rga.building.materials import steel
from rga.building.sections.hollow import circular_hollow, rectangular_hollow
from rga.building.sections.profiles import angle, channel, i_section
from rga.building.sections.rolled import rolled_section, rolled_sections
from rga.building.sections.solid import rectangle, rod
from rga.building.structures.bowstring import bowstring_truss
from rga.building.structures.howe import howe_truss
from rga.building.structures.k_truss import k_truss
from rga.building.structures.lattice_mast import lattice_mast
from rga.building.structures.portal import portal_frame
from rga.building.structures.pratt import pratt_truss
from rga.building.structures.space_roof import space_truss_roof
from rga.building.structures.storey_frame import storey_frame
from rga.building.structures.warren import warren_truss

__all__ = [
    "ModelBuilder",
    "angle",
    "bowstring_truss",
    "channel",
    "circular_hollow",
    "howe_truss",
    "i_section",
    "k_truss",
    "lattice_mast",
    "portal_frame",
    "pratt_truss",
    "rectangle",
    "rectangular_hollow",
    "rod",
    "rolled_section",
    "rolled_sections",
    "space_truss_roof",
    "steel",
    "storey_frame",
    "warren_truss",
]
