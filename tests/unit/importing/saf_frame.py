"""A frame in the sheets of an SAF workbook."""

from typing import Any

Sheets = dict[str, list[list[Any]]]
STATES = ["ux", "uy", "uz", "fix", "fiy", "fiz"]


def frame() -> Sheets:
    """A column and a beam with a node on it, hinged at the column; loads of all sorts."""
    return {
        "Model": [
            ["Name", "corner"], ["System of units", "Metric"], ["LCS of cross-section", "ZYX"],
        ],
        "StructuralMaterial": [
            ["Name", "Type", "Unit mass [kg/m3]", "E modulus [MPa]", "G modulus [MPa]",
             "Poisson coefficient", "Thermal expansion [1/K]"],
            ["S", "Steel", 7850, 210000, 80000, 0.3, 1.2e-5],
        ],
        "StructuralCrossSection": [
            ["Name", "Material", "Cross-section Type", "Shape", "Parameters [mm]", "A [m2]",
             "Iy [m4]", "Iz [m4]", "It [m4]"],
            ["R", "S", "Parametric", "Rectangle", "300;200"],
            ["P", "S", "Manufactured", None, None, 0.004, 2e-5, 1e-5, 3e-5],
        ],
        "StructuralPointConnection": [
            ["Name", "Coordinate X [m]", "Coordinate Y [m]", "Coordinate Z [m]"],
            ["A", 0, 0, 0], ["B", 0, 0, 3], ["C", 4, 0, 3], ["D", 1, 0, 3],
        ],
        "StructuralCurveMember": [
            ["Name", "Cross section", "Nodes", "Segments", "Internal nodes", "LCS",
             "LCS Rotation [deg]",
             "Coordinate X [m]", "Coordinate Y [m]", "Coordinate Z [m]", "Behaviour in analysis"],
            ["col", "R", "A;B", "Line", None, "Y by vector", 30, 0, 1, 0, "Standard"],
            ["beam", "P", "B; C", "Line", "D", "z by vector", 0, 0, 0, 1, "Standard"],
        ],
        "StructuralPointSupport": [
            ["Name", "Node", *STATES, "Stiffness Z [MN/m]"],
            ["s1", "A", *["Rigid"] * 6],
            ["s2", "C", "Free", "Rigid", "Flexible", "Rigid", "Free", "Free", 2.0],
        ],
        "RelConnectsStructuralMember": [
            ["Name", "Member", "Position", *STATES, "Stiffness Fiz [MNm/rad]"],
            ["h", "beam", "Begin", "Rigid", "Rigid", "Rigid", "Rigid", "Free", "Flexible", 5.0],
        ],
        "StructuralLoadCase": [["Name", "Load type"], ["LC1", "Others"], ["G", "Self weight"]],
        "StructuralPointAction": [
            ["Name", "Direction", "Force action", "Reference node", "Reference member",
             "Value [kN]", "Load case", "Coordinate system", "Origin", "Coordinate definition",
             "Position x [m]"],
            ["F1", "X", "In node", "B", None, 5, "LC1", "Global"],
            ["F2", "Z", "On beam", None, "beam", -3, "LC1", "Global", "From end", "Relative", 0.25],
        ],
        "StructuralPointMoment": [
            ["Name", "Direction", "Force action", "Reference node", "Value [kNm]", "Load case",
             "Coordinate system"],
            ["M1", "My", "In node", "C", 2, "LC1", "Global"],
        ],
        "StructuralCurveAction": [
            ["Name", "Force action", "Distribution", "Direction", "Value 1 [kN/m]",
             "Value 2 [kN/m]", "Member", "Load case", "Coordinate system", "Location",
             "Coordinate definition", "Origin", "Extent", "Start point [m]", "End point [m]"],
            ["L1", "On beam", "Trapez", "Z", -2, -4, "beam", "LC1", "Local", "Length", "Absolute",
             "From start", "Span", 0.5, 3.5],
            ["L2", "On beam", "Uniform", "Y", 1, None, "col", "LC1", "Global", "Length", "Relative",
             "From start", "Full", 0, 1],
        ],
    }  # fmt: skip
