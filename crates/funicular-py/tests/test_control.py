"""State space for control: SciPy, python-control and MATLAB files agree with the responses of the robot."""

import json
import os
import re
import subprocess
import zipfile
from pathlib import Path

import funicular
import numpy as np
import pytest
from conftest import ROBOTS, ROOT, plain_grid

DOCUMENT = ROOT / "docs/control.md"


@pytest.fixture(scope="module")
def rest() -> funicular.Equilibrium:
    return funicular.Robot.example().equilibrium()


@pytest.fixture(scope="module")
def model(rest: funicular.Equilibrium) -> funicular.StateSpaceModel:
    return rest.state_space(["fz", "mx"], ["z", "vz", "ay"], below_hz=5, tolerance=0.02)


def frequencies(rest: funicular.Equilibrium) -> np.ndarray:
    """Frequencies on every peak and between them."""
    modes = rest.modes(5)
    width = modes.frequency_hz * modes.damping_ratio
    around = [modes.frequency_hz + t * width for t in (-3, -1.2, -0.4, 0, 0.4, 1.2, 3)]
    hz = np.unique(np.concatenate([np.linspace(0.011, 4.99, 400), *around]))
    return hz[(hz > 0) & (hz <= 5)]


@plain_grid
def test_the_responses_in_control_have_the_stated_error(
    rest: funicular.Equilibrium, model: funicular.StateSpaceModel
) -> None:
    assert model.error <= 0.02 and model.order == len(model.A) < 60
    hz = frequencies(rest)
    control = pytest.importorskip("control")
    by_control = control.frequency_response(model.to_control(), 2 * np.pi * hz).complex
    for j, name in enumerate(model.inputs):
        for i, output in enumerate(model.outputs):
            full = rest.frf(hz, name, output)
            assert abs(full).max() <= model.peaks[i, j] * (1 + 1e-4)
            # The maxima are searched for to 1e-4 of themselves.
            assert abs(by_control[i, j] - full).max() <= model.errors[i, j] * model.peaks[i, j] * (1 + 1e-3)
    assert np.isclose(model.errors.max(), model.error)


@plain_grid
def test_scipy_bode_runs_on_one_input_and_one_output(rest: funicular.Equilibrium) -> None:
    # SciPy goes through polynomials, which is accurate for few states only.
    signal = pytest.importorskip("scipy.signal")
    small = rest.state_space(["fz"], ["az"], below_hz=5, order=8)
    hz = np.linspace(0.1, 5, 200)
    _, magnitude, phase = signal.bode(small.to_scipy(), 2 * np.pi * hz)
    full = rest.frf(hz, "fz", "az")
    found = 10 ** (magnitude / 20) * np.exp(1j * np.radians(phase))
    assert abs(found - full).max() <= small.error * small.peaks[0, 0] * (1 + 1e-3)


def test_poles_and_a_regulator_in_control(rest: funicular.Equilibrium) -> None:
    control = pytest.importorskip("control")
    small = rest.state_space(["fz"], ["z", "vz"], below_hz=5, order=10)
    system = small.to_control()
    assert system.input_labels == ["fz"] and system.output_labels == ["z", "vz"]
    poles = system.poles()
    expected = 2 * np.pi * small.frequency_hz
    assert np.allclose(np.sort(abs(poles))[::2], np.sort(expected), rtol=1e-9) and poles.real.max() < 0
    gain, _, closed = control.lqr(system, small.C.T @ np.diag([1e4, 1e2]) @ small.C, [[1e-3]])
    assert gain.shape == (1, small.order)
    damping = -closed.real / abs(closed)
    assert damping.max() > 3 * small.damping_ratio.max() and closed.real.max() < 0


def test_states_names_and_errors_have_their_shapes(model: funicular.StateSpaceModel) -> None:
    assert model.A.shape == (model.order, model.order) and model.D.shape == (3, 2)
    assert model.errors.shape == model.peaks.shape == (3, 2)
    assert np.all(np.diff(model.frequency_hz) >= 0) and len(model.kind) == len(model.first)
    assert set(model.kind) <= {"platform", "cable", "mixed", "residual"}
    # A velocity has no feedthrough.
    assert np.all(model.D[1] == 0)
    assert "states, 2 inputs, 3 outputs" in repr(model)
    assert model.to_dict()["form"] == "state-space" and model.warnings == ()
    same = model.found
    assert np.allclose(model.A, same["a"]) and np.allclose(model.C, same["c"])


def test_files_hold_the_matrices(model: funicular.StateSpaceModel, rest: funicular.Equilibrium, tmp_path: Path) -> None:
    model.save(tmp_path / "m.npz")
    arrays = np.load(tmp_path / "m.npz")
    assert arrays["inputs"].tolist() == ["fz", "mx"] and arrays["outputs"].tolist() == ["z", "vz", "ay"]
    assert json.loads(arrays["description"][0]) == model.found
    io = pytest.importorskip("scipy.io")
    model.save(tmp_path / "m.mat")
    loaded = io.loadmat(tmp_path / "m.mat")
    for name in "ABCD":
        assert np.array_equal(loaded[name], getattr(model, name)) and np.array_equal(arrays[name], loaded[name])
    assert [cell[0] for cell in loaded["inputs"].ravel()] == ["fz", "mx"]
    assert [cell[0] for cell in loaded["outputs"].ravel()] == ["z", "vz", "ay"]

    second = rest.reduce(2, ["fz"], ["z"])
    second.save(tmp_path / "second.mat")
    loaded = io.loadmat(tmp_path / "second.mat")
    assert np.array_equal(loaded["K"], second.stiffness) and np.array_equal(loaded["ss_A"], second.a)
    with pytest.raises(funicular.InputError, match="must end in"):
        model.save(tmp_path / "m.csv")


def test_the_program_writes_a_file_that_loadmat_reads(executable: str, tmp_path: Path) -> None:
    import subprocess

    io = pytest.importorskip("scipy.io")
    path = tmp_path / "m.mat"
    line = ["reduce", str(ROOT / "robots/yuan2014-4mm.toml"), "--below-hz", "3", "--input", "fz", "--output", "az"]
    subprocess.run([executable, *line, "--order", "6", "--matrices", str(path)], check=True, capture_output=True)
    loaded = io.loadmat(path)
    ours = funicular.Robot.from_file(ROOT / "robots/yuan2014-4mm.toml").state_space(["fz"], ["az"], below_hz=3, order=6)
    for name in "ABCD":
        assert np.array_equal(loaded[name], getattr(ours, name))


def test_wrong_arguments_are_refused(rest: funicular.Equilibrium) -> None:
    with pytest.raises(funicular.InputError, match="`order` and `tolerance` both decide"):
        rest.state_space(["fz"], ["z"], below_hz=2, order=4, tolerance=0.1)
    with pytest.raises(funicular.InputError, match="from 2 to 400"):
        rest.state_space(["fz"], ["z"], below_hz=2, order=1)
    with pytest.raises(funicular.NoSolutionError, match="no state space has an error of at most"):
        rest.state_space(["fz"], ["z"], below_hz=2, tolerance=1e-11)
    with pytest.raises(funicular.NoSolutionError, match="has no damping"):
        rest.state_space(["fz"], ["z"], below_hz=20, cable_model="spring")


@plain_grid
def test_the_code_of_the_document_runs(tmp_path: Path, monkeypatch: pytest.MonkeyPatch) -> None:
    pytest.importorskip("control")
    pytest.importorskip("scipy")
    blocks = re.findall(r"```python\n(.*?)```", DOCUMENT.read_text(), re.DOTALL)
    assert len(blocks) >= 3
    os.symlink(ROOT / "robots", tmp_path / "robots")
    monkeypatch.chdir(tmp_path)
    space: dict[str, object] = {}
    for block in blocks:
        exec(compile(block, str(DOCUMENT), "exec"), space)  # noqa: S102


def test_a_unit_is_that_of_the_program(executable: str, tmp_path: Path) -> None:
    rest = funicular.Robot.from_file(ROBOTS / "yuan2014-4mm.toml").equilibrium()
    model = rest.state_space(["fz"], ["z"], below_hz=3, order=6)
    model.save(tmp_path / "ours.fmu")
    line = ["reduce", str(ROBOTS / "yuan2014-4mm.toml"), "--below-hz", "3", "--input", "fz", "--output", "z", "--order", "6"]
    subprocess.run([executable, *line, "--to", "fmu", "-o", str(tmp_path / "theirs.fmu")], check=True, capture_output=True)
    with zipfile.ZipFile(tmp_path / "ours.fmu") as ours, zipfile.ZipFile(tmp_path / "theirs.fmu") as theirs:
        assert sorted(ours.namelist()) == sorted(theirs.namelist())
        for name in ("modelDescription.xml", "sources/funicular_model.c"):
            assert ours.read(name) == theirs.read(name)
        assert funicular.Robot.from_toml(ours.read("resources/robot.toml").decode()).name == rest.robot.name
        assert json.loads(ours.read("resources/description.json"))["error"] == model.error
