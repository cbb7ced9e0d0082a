"""Words of arguments as types, for type checkers and completion; a test compares them with those of the program."""

from typing import Literal

StaticModel = Literal["ideal", "spring", "catenary"]
TensionRule = Literal["lowest", "closest", "middle", "centre", "stiffest"]
CableModel = Literal["catenary-dynamic", "shallow-dynamic", "shallow-static", "catenary-static", "spring"]
Assembly = Literal["consistent", "without-geometric-stiffness"]
Winches = Literal["as-given", "clamped", "torque", "stuck"]
Hold = Literal["lengths", "pose", "rule"]
Per = Literal["unit", "percent", "tolerance"]
Method = Literal["automatic", "linear", "sampled"]
Goal = Literal["first-frequency", "platform", "stiffness-min", "rope-length", "rope-mass", "load-factor", "clearance", "winch-tension", "winch-speed", "winch-torque", "winch-power", "workspace"]
ExportFormat = Literal["opensees", "moordyn", "mujoco", "sdf", "urdf", "vtk", "c", "json", "fmu", "fmu3"]
Result = Literal[
    "pose",
    "lengths",
    "tensions",
    "rope-length",
    "rope-mass",
    "stiffness-min",
    "load-factor",
    "frequencies",
    "damping",
    "response",
]
