"""Script of a user: it runs, and `mypy --strict` accepts it."""

from concurrent.futures import ThreadPoolExecutor
from pathlib import Path

import funicular
import numpy as np
from numpy.typing import NDArray


def first_frequency(robot: funicular.Robot, height_m: float) -> float:
    try:
        rest: funicular.Equilibrium = robot.equilibrium(pose=[0.0, 0.0, height_m], static_model="catenary")
    except funicular.StaticsError as error:
        code: str = error.code
        print(code, error)
        return float("nan")
    modes: funicular.Modes = rest.modes(below_hz=20)
    kinds: NDArray[np.str_] = modes.kind
    assert modes.certified and kinds.size == len(modes)
    return float(modes.frequency_hz[0])


def main() -> None:
    robot = funicular.Robot.example().with_({"materials.rope-4mm.diameter_m": 0.008}, mass_kg=20)
    robot = funicular.Robot.from_dict(robot.to_dict())
    Path("/dev/null").write_text(robot.to_toml())
    heights = np.linspace(0.2, 1.0, 3)
    print([first_frequency(robot, float(height)) for height in heights])

    rest = robot.equilibrium(funicular.Pose([0, 0, 0.5], [0, 2, 0]), tension_rule=None)
    tensions: NDArray[np.float64] = rest.tension_platform_n
    pose: funicular.Pose = rest.pose
    stable: bool | None = rest.stable
    warnings: list[str] = rest.warnings
    print(tensions.max(), pose.matrix @ [0, 0, 0, 1], stable, warnings)

    hz, curve = rest.frf((0.1, 20), input="fz", output="az", output_point_m=(0, 0, -0.1), adaptive=True)
    response: NDArray[np.complex128] = rest.frf(hz, input="fz", output="az", output_point_m=(0, 0, -0.1))
    several: NDArray[np.complex128] = rest.frf(hz, ["fx", "fz"], ["az"])
    print(np.array_equal(curve, response), several.shape)
    frequencies, prominences, magnitudes = funicular.peaks(hz, response)
    print(frequencies, prominences, magnitudes, rest.receptance(hz).shape, rest.stiffness(hz).shape)

    states: funicular.Equilibria = robot.equilibria(poses=np.c_[np.zeros((3, 2)), heights])
    feasible: NDArray[np.bool_] = states.ok
    print(states.tension_platform_n[feasible], states.reason)

    with ThreadPoolExecutor(2) as executor:
        rows: funicular.Sweep = robot.map(
            {"x": (-1, 1, 5), "z": [0.5, 0.6]}, quantities=["tension-max"], executor=executor, progress=lambda done, rows: None
        )
    tension: NDArray[np.float64] = rows["tension_max_n"]
    print(tension.shape, rows.on_grid("tension_max_n").shape, rows.units["tension_max_n"], rows.plan["quantities"])
    loads = robot.sweep({"platform.mass_kg": (10, 40, 4)}, ["pose", "first-frequency"], up_to_hz=50)
    print(loads.to_arrow(), len(loads))


if __name__ == "__main__":
    main()
