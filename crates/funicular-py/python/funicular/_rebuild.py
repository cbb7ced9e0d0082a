"""Functions that pickles of compiled classes call.

A pickle contains the request of a result, which is small and exact; the result is computed again from it.
"""

import json

import numpy as np
from numpy.typing import NDArray

from funicular._funicular import Catenary, Equilibrium, Pose, Robot


def pose(position_m: NDArray[np.float64], quaternion_wxyz: NDArray[np.float64]) -> Pose:
    return Pose(position_m, quaternion_wxyz=quaternion_wxyz)


def equilibrium(robot: Robot, keywords: str) -> Equilibrium:
    given = json.loads(keywords)
    match given.get("pose"):
        case {"position_m": position, "quaternion_wxyz": quaternion}:
            given["pose"] = [*position, *quaternion]
    return robot.equilibrium(**given)


def catenary(span: float, rise: float, length: float, weight: float, stiffness: float) -> Catenary:
    return Catenary(
        span, rise, unstrained_length_m=length, weight_n_per_m=weight, axial_stiffness_n=stiffness
    )
