"""Commands by name: those that are passed over, and those that no model of members can have."""

#: commands that say nothing of a model: they analyse it, or show what came out
PASSED_OVER = frozenset((
    "algorithm", "analysis", "analyze", "barrier", "basicDeformation", "basicForce",
    "computeGradients", "constraints", "convergenceTest", "database", "defaultUnits", "display",
    "domainChange", "eigen", "eleDynamicalForce", "eleForce", "eleNodes", "eleResponse", "eleType",
    "fill", "getCTestIter", "getCTestNorms", "getEleTags", "getLoadFactor", "getNP", "getNodeTags",
    "getNodes", "getNumElements", "getNumThreads", "getPID", "getTime", "initialize", "integrator",
    "loadConst", "logFile", "modalDamping", "modalProperties", "nodeAccel", "nodeBounds",
    "nodeCoord", "nodeDOFs", "nodeDisp", "nodeEigenvector", "nodeMass", "nodePressure",
    "nodeReaction", "nodeResponse", "nodeUnbalance", "nodeVel", "numFact", "numIter", "numberer",
    "partition", "plane", "port", "print", "printA", "printB", "printGID", "printModel",
    "projection", "prp", "puts", "rayleigh", "reactions", "record", "recorder", "region", "reset",
    "responseSpectrumAnalysis", "restore", "save", "sectionDeformation", "sectionForce",
    "sensNodeDisp", "sensitivityAlgorithm", "setElementRayleighDampingFactors",
    "setMaxOpenFiles", "setNumThread", "setPrecision", "setTime", "start", "stop", "system",
    "systemSize", "test", "testIter", "testNorm", "testUniaxialMaterial", "timer",
    "updateElementDomain", "version", "viewWindow", "vpn", "vrp", "vup", "wipeAnalysis",
))  # fmt: skip
#: commands that a file system or another program would obey, and a reader does not
NOT_DONE = frozenset((
    "after", "auto_load", "cd", "clock", "close", "eof", "exec", "fconfigure", "file",
    "fileevent", "flush", "gets", "glob", "interp", "load_package", "open", "package", "pwd",
    "read", "rename", "seek", "socket", "trace", "unknown", "vwait",
))  # fmt: skip
#: definitions that only elements use which are refused themselves
UNUSED = (
    "damping", "fiber", "frictionModel", "groundMotion", "imposedMotion", "imposedSupportMotion",
    "layer", "nDMaterial", "patch",
)  # fmt: skip
#: ties that are not of equal degrees of freedom
TIES = ("equalDOF_Mixed", "mp", "pressureConstraint", "rigidDiaphragm", "rigidLink")
#: meshes of other elements
MESHES = ("beam3d", "block2D", "block3D", "brick", "mesh", "quadr", "remesh")
#: changes of a model under analysis
CHANGES = (
    "InitialStateAnalysis", "addElementRayleigh", "addToParameter", "parameter",
    "setElementValue", "setNodeCoord", "setNodeDisp", "setStrain", "updateMaterialStage",
    "updateParameter",
)  # fmt: skip
