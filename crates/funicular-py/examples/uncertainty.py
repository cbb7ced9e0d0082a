"""Map with error bars: minimum stiffness and lowest tension of CoGiRo along x, with what tolerances leave of them."""

import funicular
import numpy as np
from matplotlib import pyplot
from style import ROBOTS, save

robot = funicular.Robot.from_file(ROBOTS / "cogiro.toml")
x = np.linspace(-4, 4, 17)
poses = np.column_stack((x, np.zeros_like(x), np.full_like(x, 1.5)))
# The controller holds the pose and distributes the tensions by the rule; what deviates is the robot.
found = robot.uncertainty(
    {"platform.mass_kg": "2%", "cables.*.attachment_m": 0.003},
    {"cables.*.anchor_m": 0.005, "materials.*.youngs_modulus_pa": "20%"},
    of=["tensions", "stiffness-min"],
    hold="rule",
    target_tension_n=700,
    poses=poses,
    samples=100,
)

figure, (top, bottom) = pyplot.subplots(2, figsize=(3.4, 3.6), sharex=True, layout="constrained")


def draw(ax: pyplot.Axes, at: int, name: str, colour: str) -> None:
    low, high = np.moveaxis(found.interval_95[:, at], -1, 0)
    value = found.value[:, at]
    # Rounding may put an end of a narrow interval beyond the value.
    ax.errorbar(x, value, (np.maximum(value - low, 0), np.maximum(high - value, 0)), fmt="o-", markersize=2.5, capsize=2, color=colour, label=name)


draw(top, found.names.index("minimum stiffness"), "minimum stiffness", "C0")
top.set(ylabel="stiffness [N/m]", ylim=(0, None))
for colour, cable in enumerate(("1", "5")):
    draw(bottom, found.names.index(f'tension of cable "{cable}" at the platform'), f"cable {cable}", f"C{colour + 1}")
bottom.set(xlabel="x [m]", ylabel="tension [N]")
bottom.legend(ncols=2)
share = dict(zip(found.group_names, np.nanmean(found.group_shares[:, found.names.index("minimum stiffness")], axis=0), strict=True))
print({name: round(float(value), 2) for name, value in share.items()}, int(found.is_sampled.sum()), "results sampled")
save(figure, "uncertainty")
