"""Python and the program have the same core: their values are equal bit for bit."""

import json
import subprocess
from pathlib import Path
from typing import Any

import funicular
import numpy as np
import pytest
from conftest import ROBOT_FILES, ROBOTS, ROOT, Program, plain_grid

ALL = ROBOT_FILES


@pytest.mark.parametrize("name", ALL)
def test_statics_of_every_robot_are_those_of_the_program(name: str, program: Program) -> None:
    theirs = program("statics", ROBOTS / name)
    ours = funicular.Robot.from_file(ROBOTS / name).equilibrium().to_dict()
    assert theirs["pose"] == ours["pose"]
    assert theirs["warnings"] == ours["warnings"]
    for key in ("static_model", "mass_kg", "residual", "iterations", "stable", "stiffness_min_n_per_m"):
        assert theirs[key] == ours[key], key
    for key in ("tension_rule", "nearest_pose_distance_m"):
        assert theirs.get(key) == ours.get(key), key
    for their, our in zip(theirs["cables"], ours["cables"], strict=True):
        assert {key: their[key] for key in our} == our


def test_a_pose_with_a_rule_and_limits_is_that_of_the_program(cogiro: funicular.Robot, program: Program) -> None:
    options = ["--pose", "1,2,1.5,0,3,0", "--tension-rule", "middle", "--max-tension-n", "2500", "--force-n", "0,0,-50"]
    theirs = program("statics", "robots/cogiro.toml", *options)
    ours = cogiro.equilibrium(
        pose=[1, 2, 1.5, 0, 3, 0], tension_rule="middle", max_tension_n=2500, force_n=[0, 0, -50]
    )
    assert [cable["tension_platform_n"] for cable in theirs["cables"]] == ours.tension_platform_n.tolist()
    assert theirs["tension_rule"] == ours.tension_rule == "middle"


@pytest.mark.parametrize("form", ["state-space", "second-order"])
def test_numpy_reads_every_member_of_the_matrices_of_the_program(form: str, program: Program, tmp_path: Path) -> None:
    path = tmp_path / "m.npz"
    found = program("reduce", "robots/yuan2014-4mm.toml", "--below-hz", 2, "--input", "fz", "--output", "z", "--form", form, "--matrices", path)
    with np.load(path) as model:
        shapes = {name: model[name].shape for name in model}
        assert shapes["inputs"] == shapes["outputs"] == shapes["description"] == (1,)
        assert (model["inputs"][0], model["outputs"][0]) == ("fz", "z")
        assert json.loads(model["description"][0])["below_hz"] == found["below_hz"] == 2


@pytest.mark.parametrize("hz", [0.0, 3.5])
def test_stiffness_is_that_of_the_program(hz: float, robot: funicular.Robot, program: Program) -> None:
    theirs = program("stiffness", "robots/yuan2014-4mm.toml", "--at-hz", hz)
    ours = robot.stiffness(hz)
    assert theirs["real"] == ours.real.tolist() and theirs["imag"] == ours.imag.tolist()
    assert (ours.dtype == float) == (hz == 0.0)
    # A catenary-dynamic cable is resolved as finely as the highest frequency needs.
    assert np.allclose(robot.stiffness([hz, 5.0])[0], ours, rtol=1e-9, atol=1e-6)


@pytest.mark.parametrize("model", ["catenary-dynamic", "shallow-dynamic", "shallow-static", "catenary-static", "spring"])
def test_modes_of_every_cable_model_are_those_of_the_program(model: str, robot: funicular.Robot, program: Program) -> None:
    theirs = program("modes", "robots/yuan2014-4mm.toml", "--below-hz", 8, "--cable-model", model)
    ours = robot.modes(8, cable_model=model).to_dict()
    for key in ours:
        assert theirs[key] == ours[key], key
    for key in theirs:
        assert key in ours or key in ("schema", "command"), key


def test_damping_is_of_first_order_only_where_that_is_asked_for(robot: funicular.Robot) -> None:
    first, exact = robot.modes(5, damped=False), robot.modes(5)
    assert first.eigenvalue_per_s is None and first.damped_certified is None
    assert exact.eigenvalue_per_s is not None and exact.damped_certified
    assert np.allclose(first.damping_ratio, exact.damping_ratio, rtol=0.05)
    assert np.array_equal(first.frequency_hz, exact.frequency_hz)


# Redundantly, fully and under-constrained robots, a planar robot and a point mass, with lengths and with poses; each
# has modes below the limit [Hz].
DEFAULTS = [
    ("yuan2014-4mm", 4),
    ("cogiro", 4),
    ("expo2015-lucia", 2),
    ("stadium-camera", 1),
    ("kntu-planar", 60),
    ("nist-robocrane", 15),
    ("sap2000-8-cable-point-mass", 15),
]


@pytest.mark.parametrize("static_model", [None, "spring"])
@pytest.mark.parametrize(("name", "below_hz"), DEFAULTS)
def test_what_is_not_given_is_as_in_the_program(name: str, below_hz: float, static_model: str | None, program: Program) -> None:
    """A call without keywords has the state and the models of the program's command without options."""
    path = f"robots/{name}.toml"
    options = [] if static_model is None else ["--static-model", static_model]
    robot = funicular.Robot.from_file(ROBOTS / f"{name}.toml")
    rest = robot.equilibrium() if static_model is None else robot.equilibrium(static_model=static_model)

    theirs, ours = program("statics", path, *options), rest.to_dict()
    assert theirs["pose"] == ours["pose"] and theirs["warnings"] == ours["warnings"]
    assert theirs["static_model"] == ours["static_model"] and theirs.get("tension_rule") == ours.get("tension_rule")
    for their, our in zip(theirs["cables"], ours["cables"], strict=True):
        assert {key: their[key] for key in our} == our

    theirs = program("modes", path, *options, "--below-hz", below_hz)
    found = rest.modes(below_hz)
    ours = found.to_dict()
    assert len(found) > 0 and {key: theirs[key] for key in ours} == ours
    assert set(theirs) - set(ours) <= {"schema", "command"}

    for at in ([], ["--at-hz", 1.5]):
        theirs = program("stiffness", path, *options, *at)
        matrix = rest.stiffness(*at[1:])
        assert matrix.real.tolist() == theirs["real"] and matrix.imag.tolist() == theirs["imag"]

    theirs = program("frf", path, *options, *"--from-hz 0.5 --to-hz 3 --points 9 --input fx --output ax".split())
    response = rest.frf(theirs["frequency_hz"], "fx", "ax")
    assert response.real.tolist() == theirs["real"] and response.imag.tolist() == theirs["imag"]
    peaks = [[peak[key] for peak in theirs["peaks"]] for key in ("frequency_hz", "prominence_db", "magnitude")]
    assert [column.tolist() for column in funicular.peaks(theirs["frequency_hz"], response)] == peaks

    # Methods of the robot give the results of its equilibrium in the state of the file.
    if static_model is None:
        assert robot.modes(below_hz) == found
        assert np.array_equal(robot.stiffness(), rest.stiffness())
        assert np.array_equal(robot.frf(theirs["frequency_hz"], "fx", "ax"), response)


@pytest.mark.parametrize("quantities", [None, "first-frequency,frequencies:2,stiffness-min,tension-margin"])
@pytest.mark.parametrize("name", [name for name, _ in DEFAULTS])
def test_so_is_it_in_maps_and_sweeps(name: str, quantities: str | None, executable: str, tmp_path: Path) -> None:
    robot = funicular.Robot.from_file(ROBOTS / f"{name}.toml")
    at, mass = float(robot.equilibrium().pose.position_m[0]), robot.mass_kg
    options = [] if quantities is None else ["--quantity", quantities]
    keywords: dict[str, Any] = {} if quantities is None else {"quantities": quantities.split(",")}
    for command, axis, path, values in [
        ("map", "--grid", "x", [at, at + 0.125]),
        ("sweep", "--vary", "platform.mass_kg", [mass, 1.25 * mass]),
    ]:
        file = tmp_path / f"{command}.parquet"
        line = [executable, command, f"robots/{name}.toml", axis, f"{path}={','.join(map(repr, values))}", *options]
        subprocess.run([*line, "-o", str(file)], check=True, capture_output=True, cwd=ROOT)
        rows = getattr(robot, command)({path: values}, **keywords)
        assert rows.feasible[0] and rows.plan == funicular.Sweep.read(file).plan
        rows.to_parquet(tmp_path / "ours.parquet")
        assert (tmp_path / "ours.parquet").read_bytes() == file.read_bytes()


@plain_grid
@pytest.mark.parametrize(
    ("options", "keywords"),
    [
        (["--input", "fz", "--output", "az"], {}),
        (["--input", "f:1,0,1", "--output", "ry", "--input-point-m", "0.1,0,-0.2"], {"input_point_m": [0.1, 0, -0.2]}),
        (["--input", "cable:3@0.5:fz", "--output", "cable:3@0.25:vx"], {}),
        (["--input", "mx", "--output", "z", "--cable-model", "shallow-dynamic"], {"cable_model": "shallow-dynamic"}),
    ],
)
def test_responses_and_their_peaks_are_those_of_the_program(
    options: list[str], keywords: dict[str, Any], robot: funicular.Robot, program: Program
) -> None:
    grid = ["--from-hz", 0.1, "--to-hz", 10, "--points", 777]
    theirs = program("frf", "robots/yuan2014-4mm.toml", *grid, *options)
    hz = np.array(theirs["frequency_hz"])
    ours = robot.frf(hz, options[1], options[3], **keywords)
    assert np.array_equal(ours.real, theirs["real"]) and np.array_equal(ours.imag, theirs["imag"])
    found, prominence, magnitude = funicular.peaks(hz, ours)
    assert [peak["frequency_hz"] for peak in theirs["peaks"]] == found.tolist()
    assert [peak["prominence_db"] for peak in theirs["peaks"]] == prominence.tolist()
    assert [peak["magnitude"] for peak in theirs["peaks"]] == magnitude.tolist()


@plain_grid
def test_a_receptance_holds_every_response(rest: funicular.Equilibrium) -> None:
    hz = np.linspace(0.2, 9, 50)
    receptance = rest.receptance(hz)
    assert receptance.shape == (50, 6, 6)
    for i, motion in enumerate(["x", "y", "z", "rx", "ry", "rz"]):
        for j, wrench in enumerate(["fx", "fy", "fz", "mx", "my", "mz"]):
            assert np.allclose(receptance[:, i, j], rest.frf(hz, wrench, motion), rtol=1e-9, atol=1e-18), (motion, wrench)


def test_a_broken_robot_file_is_explained_as_the_program_explains_it(executable: str, tmp_path: Path) -> None:
    path = tmp_path / "broken.toml"
    path.write_text((ROBOTS / "yuan2014-4mm.toml").read_text().replace("mass_kg = 10.55", "mas_kg = -1").replace("20e9", "'stiff'"))
    with pytest.raises(funicular.RobotFileError) as error:
        funicular.Robot.from_file(path)
    told = subprocess.run([executable, "check", str(path)], capture_output=True, text=True, cwd=ROOT, check=False)
    assert told.returncode == 2 and told.stderr.strip() == str(error.value).strip()
    assert "^" in str(error.value) and len(error.value.issues) >= 2 and error.value.issues[0].line > 0


def test_no_equilibrium_is_explained_as_the_program_explains_it(executable: str, robot: funicular.Robot) -> None:
    with pytest.raises(funicular.StaticsError) as error:
        robot.equilibrium(pose=[0, 0, 5])
    line = [executable, "statics", "robots/yuan2014-4mm.toml", "--pose", "0,0,5"]
    told = subprocess.run(line, capture_output=True, text=True, cwd=ROOT, check=False)
    assert told.returncode == 1 and told.stderr.strip() == f"error: {error.value}"
    assert error.value.code == "negative-tension"


def test_a_value_by_its_path_is_that_of_set(robot: funicular.Robot, program: Program) -> None:
    changed = robot.with_({"materials.rope-4mm.diameter_m": np.float64(0.008), "cables.3.anchor_m": (5.3, 2.2, 4.2)}, mass_kg=20)
    options = ["--set", "materials.rope-4mm.diameter_m=0.008", "--set", "cables.3.anchor_m=[5.3, 2.2, 4.2]"]
    theirs = program("statics", "robots/yuan2014-4mm.toml", *options, "--set", "platform.mass_kg=20")
    assert theirs["pose"]["position_m"] == changed.equilibrium().pose.position_m.tolist()
    assert (robot.mass_kg, changed.mass_kg) == (10.55, 20)


def test_universal_files_are_those_of_the_program(executable: str, program: Program, tmp_path: Path) -> None:
    robot = ROBOTS / "yuan2014-4mm.toml"
    rest = funicular.Robot.from_file(robot).equilibrium()
    line = ["frf", robot, "--from-hz", 0.1, "--to-hz", 5, "--points", 200, "--input", "fz", "--output", "az"]
    for name, arguments in (("frf", line), ("modes", ["modes", robot, "--below-hz", 3])):
        subprocess.run([executable, *map(str, arguments), "-o", tmp_path / f"{name}.uff"], check=True)

    frequencies = program(*line)["frequency_hz"]
    caveats = rest.write_frf(tmp_path / "own-frf.uff", frequencies, "fz", "az")
    assert len(caveats) == 1 and "are read more than 5 % too low" in caveats[0]
    assert rest.write_modes(tmp_path / "own-modes.uff", 3) == []
    for name in ("frf", "modes"):
        assert (tmp_path / f"own-{name}.uff").read_bytes() == (tmp_path / f"{name}.uff").read_bytes(), name
    with pytest.raises(funicular.InputError, match="is not on the platform"):
        rest.write_frf(tmp_path / "a.uff", [1, 2], "fz", "tension:1")
    with pytest.raises(funicular.FileError, match=r"a\.json"):
        rest.write_modes(tmp_path / "a.json", 3)
    assert not (tmp_path / "a.uff").exists() and not (tmp_path / "a.json").exists()
