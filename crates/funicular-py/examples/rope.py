"""Choice of a rope: steel ropes from 1 to 12 mm. A thicker rope is stiffer and heavier, and sags more."""

import funicular
import numpy as np
from matplotlib import pyplot
from style import save

KG_PER_M_AND_MM2 = 0.067 / 4**2  # mass of the 4 mm rope of the robot

diameters = np.linspace(1, 12, 23)
names = ["first-frequency", "stiffness-min", "sag-max", "model-error:spring"]
rows = [
    funicular.Robot.example()
    .with_(
        {
            "materials.rope-4mm.diameter_m": diameter / 1000,
            "materials.rope-4mm.mass_kg_per_m": KG_PER_M_AND_MM2 * diameter**2,
        }
    )
    .map(poses=[[0, 0, 0.5]], quantities=names)
    for diameter in diameters
]


def of(column: str) -> list[float]:
    return [float(row[column][0]) for row in rows]


figure, (top, middle, bottom) = pyplot.subplots(3, 1, figsize=(3.4, 4.2), layout="constrained", sharex=True)
top.plot(diameters, of("first_frequency_hz"), label="cables with mass")
springs = np.array(of("first_frequency_hz")) * (1 + np.array(of("model_error_spring")))
top.plot(diameters, springs, "--", label="massless springs")
top.set(ylabel="first frequency [Hz]", ylim=(0, None))
top.legend()
middle.plot(diameters, 1e-3 * np.array(of("stiffness_min_n_per_m")), color="C2")
middle.set(ylabel="minimum stiffness [kN/m]", ylim=(0, None))
bottom.plot(diameters, 100 * np.array(of("sag_ratio_max")), color="C3")
bottom.set(xlabel="rope diameter [mm]", ylabel="sag over chord [%]", ylim=(0, None))
save(figure, "rope")
