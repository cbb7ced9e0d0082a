"""Attachments of CoGiRo moved by up to 5 cm, so that the platform resonates as high as possible at its worst pose (docs/design.md)."""

import funicular
import numpy as np
from matplotlib import pyplot
from style import ROBOTS, save

robot = funicular.Robot.from_file(ROBOTS / "cogiro.toml")
poses = [[x, y, 1] for x in (-3.5, 0, 3.5) for y in (-2.5, 0, 2.5)]
found = robot.design({"cables.*.attachment_m": 0.05}, goal="platform", poses=poses, target_tension_n=350)
print(found)
for limit in found.limits:
    print(limit)

figure, (left, right) = pyplot.subplots(1, 2, figsize=(7, 2.6), layout="constrained")
number = np.arange(1, len(found.poses) + 1)
left.plot(number, found.before, "o", markerfacecolor="none", label="before")
left.plot(number, found.after, "o", label="after")
left.axhline(found.fun, color="black", linewidth=0.7, linestyle=":")
left.set(xlabel="pose", ylabel=f"first frequency of the platform [{found.unit}]", xticks=number)
left.legend()

start, value = found.start.reshape(-1, 3), found.x.reshape(-1, 3)
right.plot([start[:, 0], value[:, 0]], [start[:, 1], value[:, 1]], color="0.7", linewidth=0.8)
right.plot(start[:, 0], start[:, 1], "o", markerfacecolor="none", markersize=3, label="before")
right.plot(value[:, 0], value[:, 1], "o", markersize=3, label="after")
right.set(xlabel="x on the platform [m]", ylabel="y [m]", aspect="equal")
right.legend()
save(figure, "design")
