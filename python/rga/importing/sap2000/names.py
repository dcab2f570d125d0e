"""Tables of SAP2000 by name: those that are read, those that matter, those that do not."""

READ = frozenset((
    "ACTIVE DEGREES OF FREEDOM",
    "CONNECTIVITY - FRAME", "FRAME AUTO MESH ASSIGNMENTS", "FRAME LOADS - DISTRIBUTED",
    "FRAME LOADS - POINT",
    "FRAME LOCAL AXES ASSIGNMENTS 1 - TYPICAL", "FRAME RELEASE ASSIGNMENTS 1 - GENERAL",
    "FRAME SECTION ASSIGNMENTS", "FRAME SECTION PROPERTIES 01 - GENERAL", "JOINT COORDINATES",
    "JOINT LOADS - FORCE", "JOINT RESTRAINT ASSIGNMENTS",
    "JOINT SPRING ASSIGNMENTS 1 - UNCOUPLED", "LOAD PATTERN DEFINITIONS",
    "MATERIAL PROPERTIES 02 - BASIC MECHANICAL PROPERTIES", "PROGRAM CONTROL",
    "JOINT LOADS - GROUND DISPLACEMENT",
))  # fmt: skip
#: tables without which the model would be another, by the beginning of their names
MATTERS = {
    "CONNECTIVITY - AREA": "areas are no members",
    "CONNECTIVITY - SOLID": "solids are no members",
    "CONNECTIVITY - LINK": "links are no members",
    "CONNECTIVITY - CABLE": "cables are no straight members",
    "CONNECTIVITY - TENDON": "tendons are no members",
    "CONSTRAINT DEFINITIONS": "constraints between joints",
    "JOINT CONSTRAINT ASSIGNMENTS": "constraints between joints",
    "JOINT LOCAL AXES": "restraints and loads in axes of a joint's own",
    "JOINT SPRING ASSIGNMENTS 2": "coupled springs",
    "FRAME RELEASE ASSIGNMENTS 2": "partial releases",
    "FRAME OFFSET": "frames that are stiff or shortened at their ends",
    "FRAME INSERTION POINT": "frames off the line between their joints",
    "FRAME LOCAL AXES ASSIGNMENTS 2": "local axes by other joints",
    "FRAME PROPERTY MODIFIERS": "modified properties of frames",
    "FRAME TENSION AND COMPRESSION LIMITS": "frames that only bear tension or compression",
    "FRAME SPRING": "springs along frames",
    "FRAME LOADS - ": "loads that are not read",
    "JOINT LOADS - ": "loads that are not read",
    "AREA LOADS": "loads on areas",
}
#: tables that say nothing of the structure, by the beginning of their names
QUIET = (
    "ANALYSIS OPTIONS", "AUTO WAVE", "CASE - ", "COORDINATE SYSTEMS", "DATABASE",
    "FRAME DESIGN", "FRAME LOAD TRANSFER", "FRAME OUTPUT STATION",
    "FRAME SECTION PROPERTIES 13", "FUNCTION - ", "GRID LINES", "GROUPS", "JOINT PATTERN",
    "LOAD CASE DEFINITIONS", "MASS SOURCE", "MATERIAL PROPERTIES", "OPTIONS", "OVERWRITES",
    "PREFERENCES", "PROJECT INFORMATION", "REBAR SIZES", "COMBINATION", "NAMED SETS",
)  # fmt: skip
