"""Workspace of CoGiRo 1.5 m above the ground: wrench-feasible poses, maximum tension and minimum stiffness."""

import funicular
import numpy as np
from matplotlib import pyplot
from style import ROBOTS, save

robot = funicular.Robot.from_file(ROBOTS / "cogiro.toml")
grid = {"x": (-7, 7, 57), "y": (-5.5, 5.5, 45)}
rows = robot.map(grid, quantities=["tension-max", "stiffness-min"], pose=[0, 0, 1.5])
x, y = rows.axes["x"], rows.axes["y"]
infeasible = np.ma.masked_where(rows.on_grid("feasible"), np.ones((len(y), len(x))))

figure, axes = pyplot.subplots(1, 2, figsize=(6.9, 2.7), layout="constrained", sharey=True)
for ax, (column, scale, label) in zip(
    axes,
    {
        "tension_max_n": ("tension_max_n", 1e-3, "maximum tension [kN]"),
        "stiffness_min_n_per_m": ("stiffness_min_n_per_m", 1e-3, "minimum stiffness [kN/m]"),
    }.values(),
    strict=True,
):
    values = scale * rows.on_grid(column)
    drawn = ax.contourf(x, y, values, levels=12, cmap="viridis")
    ax.contourf(x, y, infeasible, levels=[0.5, 1.5], colors="none", hatches=["////"])
    anchors = robot.anchor_m
    ax.plot(anchors[:, 0], anchors[:, 1], "k^", markersize=4, clip_on=False)
    ax.set(xlabel="x [m]", aspect="equal")
    figure.colorbar(drawn, ax=ax, label=label, shrink=0.8)
axes[0].set_ylabel("y [m]")
save(figure, "workspace")
