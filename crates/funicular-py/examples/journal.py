"""Figures at the width of a journal's column: a response with its natural frequencies, a map, a mode shape."""

import sys
from pathlib import Path

import funicular
import funicular.plot

ROBOTS = Path(__file__).parents[3] / "robots"
folder = Path(sys.argv[1] if len(sys.argv) > 1 else ".")

rest = funicular.Robot.example().equilibrium()
figures = {"bode": funicular.plot.bode([0.1, 10], rest, "fz", "az", unit="(m/s²)/N", modes=rest.modes(10))}

cogiro = funicular.Robot.from_file(ROBOTS / "cogiro.toml")
rows = cogiro.map({"x": (-9, 9, 37), "y": (-7, 7, 29)}, quantities=["tension-max"], pose=[0, 0, 1.5])
figures["map"] = funicular.plot.map(rows, "tension_max_n", label="maximum tension [N]")

modes = rest.modes(3, stations=65)
figures["shape"] = funicular.plot.shape(rest, modes, 1)

for name, figure in figures.items():
    # A paper takes the PDF; a page on the web shows the PNG.
    funicular.plot.save(figure, folder / f"{name}.pdf")
    figure.savefig(folder / f"{name}.png", dpi=150)
    print(folder / f"{name}.png")
