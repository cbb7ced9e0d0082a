"""Figures for papers: what they show, that nothing leaves the page, and what their files contain."""

import re
import xml.etree.ElementTree as ElementTree
from pathlib import Path
from typing import Any

import funicular
import funicular.plot
import numpy as np
import pytest
from conftest import plain_grid

pytest.importorskip("matplotlib").use("Agg")

INCHES = 25.4


def check_inside(figure: Any) -> None:
    """Checks that all texts and lines lie on the page; the tolerance is a pixel."""
    figure.canvas.draw()
    box = figure.get_tightbbox()
    width, height = figure.get_size_inches()
    pixel = 1 / figure.dpi
    assert box.x0 > -pixel and box.y0 > -pixel and box.x1 < width + pixel and box.y1 < height + pixel, (box.extents, width, height)


@pytest.fixture(scope="module")
def modes(rest: funicular.Equilibrium) -> funicular.Modes:
    return rest.modes(6, stations=33)


@pytest.fixture(scope="module")
def rows(cogiro: funicular.Robot) -> funicular.Sweep:
    grid: Any = {"x": (-9, 9, 13), "y": (-7, 7, 9), "z": [2.5, 1]}
    return cogiro.map(grid, quantities=["tension-max", "first-kind"])


@plain_grid
@pytest.mark.parametrize("width", ["ieee-single", "springer-single", 181])
def test_a_bode_figure_has_magnitude_phase_and_modes(
    rest: funicular.Equilibrium, modes: funicular.Modes, width: Any
) -> None:
    hz = np.linspace(0.1, 6, 400)
    response = rest.frf(hz, "fz", "az")
    figure = funicular.plot.bode(hz, [response, -response], labels=["a", "b"], unit="(m/s²)/N", modes=modes, width=width)
    magnitude, phase, marks = figure.axes
    assert np.array_equal(magnitude.lines[0].get_ydata(), abs(response)) and magnitude.get_yscale() == "log"
    drawn = phase.lines[0].get_ydata()
    expected = np.degrees(np.angle(response))
    assert np.allclose(drawn[np.isfinite(drawn)], np.where(expected <= -179.99, 180, expected), atol=1e-12)
    ticks = sum(len(lines.get_segments()) for lines in marks.collections)
    assert ticks == int((modes.frequency_hz >= 0.1).sum())
    assert magnitude.lines[0].get_linestyle() != magnitude.lines[1].get_linestyle(), "distinct in grey"
    millimetres = funicular.plot.WIDTHS_MM[width] if isinstance(width, str) else width
    assert figure.get_size_inches()[0] * INCHES == pytest.approx(millimetres)
    check_inside(figure)


@plain_grid
def test_a_bode_figure_of_an_equilibrium_has_every_peak(rest: funicular.Equilibrium) -> None:
    figure = funicular.plot.bode([0.5, 4], rest, "fz", "az", cable_model="shallow-dynamic")
    hz, magnitude = figure.axes[0].lines[0].get_data()
    fine = np.linspace(0.5, 4, 20_000)
    highest = abs(rest.frf(fine, "fz", "az", cable_model="shallow-dynamic")).max()
    # A grid of 20,000 frequencies misses the top of a peak of relative half width 1e-4 by a few per cent.
    assert magnitude.max() >= highest * (1 - 1e-9) and magnitude.max() < 1.1 * highest
    assert (hz[0], hz[-1]) == (0.5, 4)


def test_a_map_has_the_slice_its_contours_and_the_infeasible_cells(rows: funicular.Sweep) -> None:
    figure = funicular.plot.map(rows, "tension_max_n", at={"z": 2.5})
    ax, bar = figure.axes
    shown = ax.collections[0].get_array()
    # Axis z has its values in the order 2.5, 1: the first layer of the rows.
    expected = rows.on_grid("tension_max_n")[0]
    assert np.array_equal(np.ma.getmaskarray(shown), np.isnan(expected))
    assert np.array_equal(shown.compressed(), expected[np.isfinite(expected)])
    hatched = [one for one in ax.collections if one.get_hatch()]
    areas = [np.ptp(path.vertices[:, 0]) * np.ptp(path.vertices[:, 1]) for path in hatched[0].get_paths()]
    assert sum(areas) == pytest.approx((~rows.on_grid("feasible")[0]).sum() * 1.5 * 1.75)
    assert (ax.get_xlabel(), ax.get_ylabel(), bar.get_ylabel()) == ("x [m]", "y [m]", "tension max [N]")
    check_inside(figure)
    other = funicular.plot.map(rows, "tension_max_n", plane=("z", "y"), label="T [N]", width="ieee-double")
    assert (other.axes[0].get_xlabel(), other.axes[1].get_ylabel()) == ("z [m]", "T [N]")
    # Values in descending order are drawn ascending.
    column = rows.on_grid("tension_max_n")[::-1, :, 6].T
    assert np.array_equal(np.ma.filled(other.axes[0].collections[0].get_array(), np.nan), column, equal_nan=True)
    check_inside(other)


def test_a_sweep_of_two_values_is_a_map_too(robot: funicular.Robot) -> None:
    sweep = robot.sweep(
        {"platform.mass_kg": (20, 40, 3), "materials.rope-4mm.diameter_m": [0.004, 0.005]}, ["tension-max"], pose=[0, 0, 0.5]
    )
    figure = funicular.plot.map(sweep, "tension_max_n")
    assert figure.axes[0].get_xlabel() == "platform mass [kg]"
    check_inside(figure)


def test_a_mode_shape_moves_cables_and_platform(rest: funicular.Equilibrium, modes: funicular.Modes) -> None:
    figure = funicular.plot.shape(rest, modes, 1, amplitude=0.5)
    lines = {line.get_label(): np.array(line.get_data_3d()).T for line in figure.axes[0].lines}
    assert modes.cable_shapes is not None and modes.cable_axes is not None
    moved = modes.cable_shapes[1, 0] @ modes.cable_axes[0]
    assert np.allclose(lines["cables"] - lines["equilibrium"], 0.5 * moved, atol=1e-12)
    # The end of a cable moves with the platform.
    motion, corner = modes.shape[1], lines["equilibrium"][0]
    rigid = motion[:3] + np.cross(motion[3:], corner - rest.pose.position_m)
    assert np.allclose(moved[0], rigid, atol=1e-9)
    check_inside(figure)
    check_inside(funicular.plot.shape(rest, modes, 0, width="elsevier-double", font_size_pt=10))


@plain_grid
def test_files_have_embedded_fonts_and_texts_and_do_not_depend_on_the_time(
    rest: funicular.Equilibrium, tmp_path: Path
) -> None:
    hz = np.linspace(0.1, 2, 50)
    written: dict[str, list[bytes]] = {}
    for _ in range(2):
        figure = funicular.plot.bode(hz, rest.frf(hz, "fz", "az"))
        for ending in ("svg", "pdf", "png"):
            funicular.plot.save(figure, tmp_path / f"a.{ending}")
            written.setdefault(ending, []).append((tmp_path / f"a.{ending}").read_bytes())
    assert written["svg"][0] == written["svg"][1] and written["pdf"][0] == written["pdf"][1]
    texts = [element.text for element in ElementTree.fromstring(written["svg"][0]).iter() if element.tag.endswith("}text")]
    assert "frequency [Hz]" in texts and "phase [°]" in texts
    pdf = written["pdf"][0]
    assert b"/FontFile2" in pdf and b"/Type3" not in pdf, "TrueType, as publishers ask for"
    width = float(re.search(rb"/MediaBox \[ *0 0 ([0-9.]+)", pdf)[1])  # type: ignore[index]
    assert width == pytest.approx(88.9 / INCHES * 72, abs=0.01)


def test_what_cannot_be_drawn_is_refused(
    rest: funicular.Equilibrium, modes: funicular.Modes, rows: funicular.Sweep, cogiro: funicular.Robot, tmp_path: Path
) -> None:
    hz = np.linspace(1, 2, 5)
    response = np.ones(5, dtype=complex)
    line = cogiro.map({"x": (-1, 1, 3), "y": 0, "z": 1.5}, quantities=["tension-max"])
    for call, says in (
        (lambda: funicular.plot.bode(hz, response, width="nature"), "ieee-single"),
        (lambda: funicular.plot.bode(hz, response, width=3.5), "40 to 1000 mm"),
        (lambda: funicular.plot.bode(hz, response, font_size_pt=2), "4 to 40 pt"),
        (lambda: funicular.plot.bode(hz, response[:3]), "a row of frequencies"),
        (lambda: funicular.plot.map(rows, "tension_min_n"), 'no column "tension_min_n"'),
        (lambda: funicular.plot.map(rows, "first_kind"), "no numbers"),
        (lambda: funicular.plot.map(rows, "tension_max_n", at={"yaw": 0}), 'no axis of these rows: they have x, y, z'),
        (lambda: funicular.plot.map(rows, "tension_max_n", at={"z": 2}), "nearest value"),
        (lambda: funicular.plot.map(rows, "tension_max_n", at={"x": 0}), "shown completely"),
        (lambda: funicular.plot.map(rows, "tension_max_n", plane=("x", "x")), "twice"),
        (lambda: funicular.plot.map(line, "tension_max_n"), "a map needs two"),
        (lambda: funicular.plot.shape(rest, rest.modes(2), 0), "stations=65"),
        (lambda: funicular.plot.shape(rest, modes, len(modes)), "modes, from 0"),
        (lambda: funicular.plot.shape(rest, modes, -1), "it must be zero or more"),
        (lambda: funicular.plot.shape(rest.robot.equilibrium([0, 0, 0.5]), modes, 0), "another equilibrium"),
        (lambda: funicular.plot.shape(cogiro.equilibrium([0, 0, 1.5]), modes, 0), "or of another robot"),
        (lambda: funicular.plot.bode([0.5, 2], cogiro, "fz", "z", modes=modes), "or of another robot"),
        (lambda: funicular.plot.bode([], []), "at least two frequencies"),
        (lambda: funicular.plot.bode([2, 1], [1, 1]), "has to ascend"),
        (lambda: funicular.plot.map(rows, "tension_max_n", at={"z": np.nan}), "finite"),
        (lambda: funicular.plot.map(rows, "tension_max_n", at={"z": "a"}), "`at["),  # type: ignore[dict-item]
        (lambda: funicular.plot.save(funicular.plot.bode(hz, response), tmp_path / "a.eps"), ".svg, .pdf or .png"),
    ):
        with pytest.raises(funicular.InputError) as caught:
            call()
        assert says in str(caught.value)
