"""Frequency responses of several signals, at frequencies that are chosen, and warnings about peaks that a grid misses."""

import inspect
import re
import warnings

import funicular
import numpy as np
import pytest

COARSE = np.linspace(0.1, 5, 100)


def test_several_signals_make_an_array_of_outputs_and_inputs(rest: funicular.Equilibrium) -> None:
    hz = [0.5, 1.25, 2.0]
    inputs, outputs = ["fz", "cable:2@0.3:fx"], ["az", "x", "cable:2@0.5:vy"]
    several = rest.frf(hz, inputs, outputs, output_point_m=None)
    assert several.shape == (3, 2, 3) and several.dtype == np.complex128
    for i, output in enumerate(outputs):
        for j, signal in enumerate(inputs):
            one = rest.frf(hz, signal, output)
            # All points of one cable share its discretisation, which differs from that of a single point.
            on_cable = "cable" in signal + output
            assert np.allclose(several[i, j], one, rtol=1e-7 if on_cable else 0, atol=0), (output, signal)
    # A list of one keeps its axis; text has none.
    assert rest.frf(hz, ["fz"], "az").shape == rest.frf(hz, "fz", ("az",)).shape == (1, 1, 3)
    assert rest.frf(hz, "fz", "az").shape == (3,)


def test_signals_that_are_no_names_are_refused(rest: funicular.Equilibrium) -> None:
    with pytest.raises(funicular.InputError, match="type int: give text, or a list of texts"):
        rest.frf([1], 5, "az")  # type: ignore[call-overload]
    with pytest.raises(funicular.InputError, match="`input` is an empty list"):
        rest.frf([1], [], "az")
    with pytest.raises(funicular.InputError, match="not an output"):
        rest.frf([1], ["fz"], ["az", "fz"])


def test_adaptive_frequencies_hold_the_grid_and_every_peak(rest: funicular.Equilibrium) -> None:
    with warnings.catch_warnings():
        warnings.simplefilter("error")
        hz, response = rest.frf(COARSE, "fz", "az", adaptive=True)
        assert np.array_equal(rest.frf(hz, "fz", "az"), response), "no warning, equal values"
    assert np.isin(COARSE, hz).all() and (np.diff(hz) > 0).all() and len(hz) < 700
    places, _, heights = funicular.peaks(hz, response)
    for place, height in zip(places, heights, strict=True):
        near = rest.frf(np.linspace(place * 0.999, place * 1.001, 20_001), "fz", "az")
        assert abs(near).max() == pytest.approx(height, rel=1e-3), place
    # Several responses have common frequencies.
    hz, several = rest.frf([0.1, 5], ["fz", "fx"], ["az"], adaptive=True)
    assert several.shape == (1, 2, len(hz))
    for wrong in ([1.0], [2.0, 1.0], [1.0, 1.0, 2.0]):
        with pytest.raises(funicular.InputError, match="`adaptive=True` needs at least two frequencies in ascending order"):
            rest.frf(wrong, "fz", "az", adaptive=True)


def test_a_grid_that_misses_peaks_warns_with_the_worst(rest: funicular.Equilibrium) -> None:
    with pytest.warns(funicular.ResponseWarning) as caught:
        response = rest.frf(COARSE, "fz", "az")
    assert len(caught) == 1 and caught[0].filename == __file__
    text = str(caught[0].message)
    found = re.fullmatch(
        r"(\d+) peaks between the frequencies are read more than 5 % too low; the worst has (\S+) \(m/s²\)/N at (\S+) Hz, "
        r"but (\S+) \(m/s²\)/N at (\S+) Hz is read: give `adaptive=True`, or more frequencies",
        text,
    )
    assert found, text
    height, place, read, at = map(float, found.groups()[1:])
    near = rest.frf(np.linspace(place * 0.999, place * 1.001, 20_001), "fz", "az")
    assert abs(near).max() == pytest.approx(height, rel=1e-3)
    nearest = np.argmin(abs(COARSE - at))
    assert abs(response[nearest]) == pytest.approx(read, rel=1e-3) and abs(at - place) < COARSE[1] - COARSE[0]


def test_fine_grids_and_single_frequencies_do_not_warn(rest: funicular.Equilibrium) -> None:
    with warnings.catch_warnings():
        warnings.simplefilter("error")
        rest.frf(np.linspace(0.1, 5, 200_000), "fz", "az")
        rest.frf([0.5, 1.0, 2.0, 3.0], "fz", "az")
        rest.frf(COARSE[::-1], "fz", "az")  # no curve


def test_a_figure_of_an_equilibrium_has_every_peak(rest: funicular.Equilibrium, robot: funicular.Robot) -> None:
    pytest.importorskip("matplotlib").use("Agg")
    hz, response = rest.frf([0.1, 5], "fz", "az", adaptive=True)
    axes = funicular.plot.frf([0.1, 5], rest, "fz", "az")
    assert np.array_equal(axes.lines[0].get_ydata(), abs(response)) and np.array_equal(axes.lines[0].get_xdata(), hz)
    axes = funicular.plot.frf([0.1, 5], robot, ["fz", "fx"], "az", cable_model="shallow-dynamic")
    assert [text.get_text() for text in axes.get_legend().get_texts()] == ["az / fz", "az / fx"]
    with pytest.raises(funicular.InputError, match="give `input` and `output` too"):
        funicular.plot.frf([0.1, 5], rest)
    with pytest.raises(funicular.InputError, match="belong to an equilibrium"):
        funicular.plot.frf(hz, response, "fz", "az")


def test_no_default_is_unreadable() -> None:
    for of in (funicular.Analyses, funicular.Robot, funicular.Equilibrium, funicular.Pose, funicular.Catenary):
        for name, member in vars(of).items():
            if name.startswith("_") or not callable(member):
                continue
            for parameter in inspect.signature(member).parameters.values():
                assert parameter.default is not Ellipsis, f"{of.__name__}.{name}({parameter.name})"
    assert all(parameter.default is not Ellipsis for parameter in inspect.signature(funicular.peaks).parameters.values())
