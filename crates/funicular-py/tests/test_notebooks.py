"""Figures and results in a notebook, which is run as a user runs it."""

from typing import Any

import funicular
import pytest

nbformat = pytest.importorskip("nbformat")
nbclient = pytest.importorskip("nbclient")
pytest.importorskip("ipykernel")

START = """
import funicular, funicular.plot, numpy
rest = funicular.Robot.from_file("robots/cogiro.toml").equilibrium(pose=[1, 2, 1.5])
hz = numpy.array([1.0, 2.0, 3.0])
response = numpy.array([1, 2j, 1])
"""


def pictures(cells: list[str], root: str) -> list[int]:
    """Number of pictures that each cell after the first shows in a new kernel."""
    notebook = nbformat.v4.new_notebook(cells=[nbformat.v4.new_code_cell(cell) for cell in [START, *cells]])
    nbclient.NotebookClient(notebook, timeout=300, resources={"metadata": {"path": root}}).execute()

    def count(outputs: list[Any]) -> int:
        return sum("image/png" in output.get("data", {}) for output in outputs)

    return [count(cell.outputs) for cell in notebook.cells[1:]]


def test_every_figure_is_shown_once_whatever_comes_first() -> None:
    from conftest import ROOT

    figures = [
        "funicular.plot.bode(hz, response)",
        "figure = funicular.plot.bode(hz, response); figure",
        "rows = rest.robot.map({'x': (0, 1, 2), 'y': (0, 1, 2), 'z': 1.5})\nfunicular.plot.map(rows, 'tension_max_n')",
        "funicular.plot.shape(rest, rest.modes(3, stations=5), 0)",
        "funicular.plot.robot(rest);",
        "funicular.plot.frf(hz, response);",
        "import matplotlib.pyplot as plt\nplt.plot([1, 2]);",
        "fig, ax = plt.subplots()\nax.plot([1, 2]);",
    ]
    assert pictures(figures, str(ROOT)) == [1] * len(figures)
    # Another first figure, and the choice of the backend by hand.
    assert pictures([figures[2], figures[6]], str(ROOT)) == [1, 1]
    assert pictures(["%matplotlib inline", figures[3], figures[0], figures[6]], str(ROOT)) == [0, 1, 1, 1]


def test_results_are_tables_and_short_texts(rest: funicular.Equilibrium) -> None:
    for result in (rest.compare(2), rest.gradient(below_hz=2), rest.all_equilibria(), rest.robot.payload(pose=[0, 0, 0.5])):
        assert isinstance(result, dict) and isinstance(result, funicular.Results)
        assert len(repr(result)) < 300 and result.to_dict() == dict(result)
        shown = result._repr_html_()
        assert "<table>" in shown and shown.count("<") == shown.count(">")
