"""Style and folder of the figures of the gallery; one column of a paper is 3.4 inches wide."""

import sys
from pathlib import Path

from matplotlib import pyplot
from matplotlib.figure import Figure

ROBOTS = Path(__file__).parents[3] / "robots"

pyplot.rcParams.update(
    {
        "font.size": 8,
        "axes.labelsize": 8,
        "axes.titlesize": 8,
        "legend.fontsize": 7,
        "legend.frameon": False,
        "lines.linewidth": 1.1,
        "axes.spines.top": False,
        "axes.spines.right": False,
        "savefig.dpi": 120,
    }
)


def save(figure: Figure, name: str) -> None:
    """Writes a figure to the folder of the command line, or to the current folder."""
    folder = Path(sys.argv[1] if len(sys.argv) > 1 else ".")
    figure.savefig(folder / f"{name}.png")
    print(folder / f"{name}.png")
