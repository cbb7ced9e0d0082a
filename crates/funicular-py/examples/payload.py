"""Lowest natural frequencies over the mass of the platform, and the mass from which on they stay above a limit."""

import funicular
import numpy as np
from matplotlib import pyplot
from style import save

LIMIT_HZ = 1.0

rows = funicular.Robot.example().sweep(
    {"platform.mass_kg": (5, 90, 41)}, ["frequencies:4", "sag-max"], pose=[0, 0, 0.5]
)
mass, first = rows["platform.mass_kg"], rows["frequency_1_hz"]

figure, ax = pyplot.subplots(figsize=(3.4, 2.6), layout="constrained")
for i in range(4):
    ax.plot(mass, rows[f"frequency_{i + 1}_hz"], color=f"C{i}", label=f"$f_{i + 1}$")
ax.axhline(LIMIT_HZ, color="black", linewidth=0.7, linestyle=":")
above = np.flatnonzero(first >= LIMIT_HZ)
if len(above) and above[0] > 0:
    # Between two rows the frequency is nearly linear.
    i = above[0]
    threshold = np.interp(LIMIT_HZ, first[i - 1 : i + 1], mass[i - 1 : i + 1])
    ax.axvline(threshold, color="black", linewidth=0.7, linestyle=":")
    ax.annotate(f"{threshold:.1f} kg", (threshold, 0), xytext=(3, 3), textcoords="offset points")
    print(f"above {LIMIT_HZ} Hz from {threshold:.2f} kg on")
ax.set(xlabel="platform mass [kg]", ylabel="natural frequency [Hz]", ylim=(0, None))
ax.legend(ncols=2)
save(figure, "payload")
