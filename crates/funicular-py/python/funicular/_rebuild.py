"""What pickles are made of: results are computed again from what they were asked with, which is less and exact."""

import json
import tempfile
from pathlib import Path

import numpy as np
from numpy.typing import NDArray

from funicular._funicular import Catenary, Equilibrium, Pose, Robot, SweepTable
from funicular._sweeps import Sweep


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


def sweep(parquet: bytes) -> Sweep:
    with tempfile.TemporaryDirectory() as folder:
        path = Path(folder) / "sweep.parquet"
        path.write_bytes(parquet)
        return Sweep(SweepTable.read(path))
