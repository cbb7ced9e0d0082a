"""Statics and vibration of cable-driven parallel robots whose cables sag.

A `Robot` is read from a file, and `Robot.equilibrium` computes its static equilibrium. Stiffness, natural frequencies
and frequency responses are methods of the equilibrium. Values are in SI units, and the unit stands in the name of a
value. Angles are in degrees, R = Rz(yaw) Ry(pitch) Rx(roll). Forces, motion and 6×6 matrices are about the platform
origin, in world axes.

>>> import funicular
>>> rest = funicular.Robot.example().equilibrium()
>>> rest.tension_platform_n.round(3)
array([17.685, 36.926, 39.89 , 15.636, 50.443, 52.549])
>>> rest.modes(below_hz=2).frequency_hz.round(4)
array([1.0207, 1.1876, 1.2231, 1.2662, 1.3571, 1.8184, 1.8413, 1.8794])
"""

from funicular import _datasets as _datasets
from funicular import _earlier_names as _earlier_names
from funicular import _equilibrium_methods as _equilibrium_methods
from funicular import _hints as _hints
from funicular import _html as _html
from funicular import _robot_methods as _robot_methods
from funicular import _tables as _tables
from funicular._design import Designed
from funicular._errors import (
    DynamicsError,
    Error,
    FileError,
    InputError,
    MeasurementWarning,
    NoSolutionError,
    ResponseError,
    ResponseWarning,
    RobotFileError,
    RobotWarning,
    StaticsError,
)
from funicular._executors import ExecutorError
from funicular._funicular import Analyses, Catenary, Equilibrium, Estimator, Pose, Robot, Simulation, __version__, peaks
from funicular._identify import Identified, read_measurements
from funicular._live import Live
from funicular._pages import Page
from funicular._results import Equilibria, ModeGradients, Modes, ReducedModel, Results, StateSpaceModel
from funicular._study import (
    Exported,
    Imported,
    NewRobot,
    import_robot,
    import_trajectory,
    merge,
    new_robot,
    paper,
    run,
    schema,
    validate,
)
from funicular._sweeps import Sweep
from funicular._uncertainty import Uncertainty

__all__ = [
    "Analyses",
    "Catenary",
    "Designed",
    "DynamicsError",
    "Equilibria",
    "Equilibrium",
    "Error",
    "Estimator",
    "ExecutorError",
    "Exported",
    "FileError",
    "Identified",
    "Imported",
    "InputError",
    "Live",
    "ModeGradients",
    "Modes",
    "NewRobot",
    "MeasurementWarning",
    "NoSolutionError",
    "Page",
    "Pose",
    "ReducedModel",
    "ResponseError",
    "ResponseWarning",
    "Results",
    "Robot",
    "RobotFileError",
    "RobotWarning",
    "Simulation",
    "StateSpaceModel",
    "StaticsError",
    "Sweep",
    "Uncertainty",
    "__version__",
    "import_robot",
    "import_trajectory",
    "merge",
    "new_robot",
    "paper",
    "peaks",
    "read_measurements",
    "run",
    "schema",
    "validate",
]
