"""Maps and sweeps have the bytes of the program's files, and their columns are NumPy arrays."""

import json
import os
import pickle
import subprocess
import sys
import warnings
from concurrent.futures import ThreadPoolExecutor
from pathlib import Path
from typing import Any

import funicular
import numpy as np
import pytest
import workers
from conftest import ROBOTS, ROOT

CASES: list[tuple[str, list[str], dict[str, Any]]] = [
    (
        "yuan2014-4mm",
        ["map", "--grid", "x=-4:4:9", "--grid", "y=0,0.5", "--grid", "z=0.5", "--quantity", "first-frequency,pose-error"],
        {
            "grid": {"x": (-4, 4, 9), "y": [0, 0.5], "z": 0.5},
            "quantities": ["first-frequency", "pose-error"],
        },
    ),
    (
        "cogiro",
        ["map", "--grid", "z=0.5:3:4", "--pose", "1,2,1,0,3,10", "--tension-rule", "middle", "--max-tension-n", "4000"]
        + ["--force-n", "0,5,-50", "--up-to-hz", "90"],
        {
            "grid": {"z": (0.5, 3, 4)},
            "pose": [1, 2, 1, 0, 3, 10],
            "tension_rule": "middle",
            "max_tension_n": 4000,
            "force_n": [0, 5, -50],
            "up_to_hz": 90,
        },
    ),
    (
        "yuan2014-4mm",
        ["sweep", "--vary", "platform.mass_kg=10:40:7", "--vary", "materials.rope-4mm.diameter_m=0.004,0.006"]
        + ["--quantity", "pose,first-kind", "--static-model", "catenary"],
        {
            "vary": {"platform.mass_kg": (10, 40, 7), "materials.rope-4mm.diameter_m": [0.004, 0.006]},
            "quantities": ["pose", "first-kind"],
        },
    ),
]


@pytest.mark.parametrize(("name", "options", "keywords"), CASES)
def test_files_are_those_of_the_program(
    name: str, options: list[str], keywords: dict[str, Any], executable: str, tmp_path: Path
) -> None:
    theirs = tmp_path / "theirs.parquet"
    command, *rest = options
    line = [executable, command, str(ROBOTS / f"{name}.toml"), *rest, "-o", str(theirs)]
    subprocess.run(line, check=True, capture_output=True, cwd=ROOT)
    robot = funicular.Robot.from_file(ROBOTS / f"{name}.toml")
    rows = getattr(robot, command)(**keywords)
    rows.to_parquet(tmp_path / "ours.parquet")
    read = funicular.Sweep.read(theirs)
    assert rows.plan == read.plan
    assert (tmp_path / "ours.parquet").read_bytes() == theirs.read_bytes()
    getattr(robot, command)(**keywords, file=tmp_path / "file.parquet")
    assert (tmp_path / "file.parquet").read_bytes() == theirs.read_bytes()
    assert read == rows and read.robot == robot and len(read) == len(rows)


def test_a_list_of_poses_is_that_of_the_program(executable: str, robot: funicular.Robot, tmp_path: Path) -> None:
    poses = np.array([[0, 0, 0.5, 0, 0, 10], [9, 0, 0.5, 0, 0, 0], [0.25, -0.5, 0.625, 1, 2, 3]])
    table = "x_m,y_m,z_m,roll_deg,pitch_deg,yaw_deg\n" + "\n".join(",".join(map(repr, map(float, row))) for row in poses)
    (tmp_path / "poses.csv").write_text(table)
    line = [executable, "map", str(ROBOTS / "yuan2014-4mm.toml"), "--poses", str(tmp_path / "poses.csv")]
    subprocess.run([*line, "-o", str(tmp_path / "theirs.parquet")], check=True, capture_output=True)
    rows = robot.map(poses=poses)
    rows.to_parquet(tmp_path / "ours.parquet")
    assert (tmp_path / "ours.parquet").read_bytes() == (tmp_path / "theirs.parquet").read_bytes()
    assert rows.axes == {}
    with pytest.raises(funicular.InputError, match="no grid"):
        rows.on_grid("tension_max_n")


@pytest.fixture(scope="module")
def rows() -> funicular.Sweep:
    return funicular.Robot.example().map(
        {"x": (-4, 4, 9), "y": (-1, 1, 3), "z": [0.5]}, pose=[0, 0, 0], quantities=["tension-max", "first-kind"], up_to_hz=20
    )


def test_columns_are_those_of_equilibria(rows: funicular.Sweep, robot: funicular.Robot) -> None:
    poses = np.stack([rows["x_m"], rows["y_m"], rows["z_m"]], axis=1)
    others = robot.equilibria(poses)
    assert np.array_equal(rows.feasible, others.ok) and 0 < rows.feasible.sum() < len(rows) == 27
    assert np.array_equal(np.isnan(rows["tension_max_n"]), ~others.ok)
    expected = np.fmax(others.tension_platform_n, others.tension_anchor_n).max(axis=1)
    assert np.allclose(rows["tension_max_n"], expected, rtol=1e-12, equal_nan=True)
    reasons = [reason or "" for reason in rows["reason"][~rows.feasible]]
    assert all("would need" in reason for reason in reasons)
    assert rows.units["tension_max_n"] == "N" and rows.units["status"] == "" and "tension" in rows.about["tension_max_n"]
    assert list(rows.columns)[:3] == ["x_m", "y_m", "z_m"] and "27 rows" in repr(rows)


def test_a_grid_has_its_dimensions(rows: funicular.Sweep) -> None:
    assert list(rows.axes) == ["x", "y"]
    tension = rows.on_grid("tension_max_n")
    assert tension.shape == (3, 9)
    x, y = np.meshgrid(rows.axes["x"], rows.axes["y"])
    assert np.array_equal(rows.on_grid("x_m"), x) and np.array_equal(rows.on_grid("y_m"), y)


def test_a_range_has_as_many_values_as_any_whole_number_says(robot: funicular.Robot) -> None:
    expected = robot.map({"x": (-0.1, 0.1, 5), "y": 0, "z": 0.5})
    assert len(expected) == 5
    assert robot.map({"x": (-0.1, 0.1, np.int64(5)), "y": 0, "z": 0.5}) == expected


def test_a_part_of_a_grid_has_no_dimensions(executable: str, tmp_path: Path) -> None:
    part = tmp_path / "part.parquet"
    line = [executable, "map", str(ROBOTS / "yuan2014-4mm.toml"), "--part", "1/2", "-o", str(part)]
    subprocess.run([*line, *"--grid x=-1:1:40 --grid y=-1:1:10 --grid z=0.5".split()], check=True, capture_output=True)
    rows = funicular.Sweep.read(part)
    assert rows.complete and 0 < len(rows) < 400
    with pytest.raises(funicular.InputError, match=f"{len(rows)} of 400 rows are there; merge the parts"):
        rows.on_grid("tension_max_n")


def test_arrow_takes_the_rows_without_copies(rows: funicular.Sweep, tmp_path: Path) -> None:
    pyarrow = pytest.importorskip("pyarrow")
    table, again = rows.to_arrow(), pyarrow.table(rows)
    assert table.schema.field("tension_max_n").metadata[b"unit"] == b"N"
    assert table.column("tension_max_n").null_count == (~rows.feasible).sum()
    address = [of.column("tension_max_n").chunk(0).buffers()[1].address for of in (table, again)]
    assert address[0] == address[1]
    kept = table.column("tension_max_n")
    del table, again
    assert np.array_equal(kept.to_numpy(), rows["tension_max_n"], equal_nan=True)
    import pyarrow.parquet

    rows.to_parquet(tmp_path / "rows.parquet")
    read = pyarrow.parquet.read_table(tmp_path / "rows.parquet")
    assert read.equals(rows.to_arrow())
    # Each field of the file has the type, the unit and the description of the field in memory.
    for field in rows.to_arrow().schema:
        assert read.schema.field(field.name).equals(field, check_metadata=True)


def test_tables_pickles_and_pages(rows: funicular.Sweep) -> None:
    table = rows.to_pandas()
    assert table.shape == (27, len(rows.columns)) and table.attrs["units"]["x_m"] == "m"
    assert table["status"].tolist() == rows["status"].tolist()
    again = pickle.loads(pickle.dumps(rows))
    assert again == rows and again.plan == rows.plan and again.file is None
    assert "tension_max_n [N]" in rows._repr_html_() and "would need" in rows._repr_html_()
    with pytest.raises(ValueError, match="read-only"):
        rows["x_m"][0] = 1


def test_a_sweep_in_memory_goes_to_any_format(rows: funicular.Sweep, tmp_path: Path) -> None:
    rows.write(tmp_path / "rows.csv")
    rows.write(tmp_path / "rows.vti")
    lines = (tmp_path / "rows.csv").read_text().splitlines()
    assert len(lines) == 28 and lines[0].split(",") == list(rows.columns)
    with pytest.raises(funicular.FileError, match="names no format"):
        rows.write(tmp_path / "rows.xls")
    with pytest.raises(funicular.InputError, match="must end in .parquet"):
        rows.to_parquet(tmp_path / "rows.csv")
    with pytest.raises(funicular.FileError, match="no directory"):
        rows.to_parquet(tmp_path / "nowhere" / "rows.parquet")


def test_a_slip_warns_once_per_call_and_before_the_rows(robot: funicular.Robot, tmp_path: Path) -> None:
    slip = robot.with_({"materials.rope-4mm.youngs_modulus_pa": 20.0})
    grid: dict[str, Any] = {"x": (0, 0.1, 40), "y": 0, "z": 1}
    request = slip.request("map", grid=grid)
    with ThreadPoolExecutor(2) as executor:
        for call in (
            lambda: slip.map(grid),
            lambda: slip.map(grid, executor=executor, chunks_per_task=1),
            lambda: slip.map(grid, file=tmp_path / "map.parquet", resume=True),
            lambda: slip.map(grid, file=tmp_path / "map.parquet", resume=True),
            lambda: slip.sweep({"platform.mass_kg": [10, 11]}, pose=[0, 0, 1]),
            lambda: funicular.run(request),
        ):
            with pytest.warns(funicular.RobotWarning, match="Young's modulus is 20 Pa, .* GPa given as Pa") as caught:
                call()
            assert [warning.filename for warning in caught] == [__file__]

    # An exception in place of the warning leaves no file.
    with warnings.catch_warnings():
        warnings.simplefilter("error", funicular.RobotWarning)
        with pytest.raises(funicular.RobotWarning, match="GPa given as Pa"):
            slip.map(grid, file=tmp_path / "none.parquet")
    assert sorted(path.name for path in tmp_path.iterdir()) == ["map.parquet"]


def test_a_damaged_file_is_refused(robot: funicular.Robot, tmp_path: Path) -> None:
    path = tmp_path / "map.parquet"
    asked: dict[str, Any] = {"grid": {"x": [0, 1], "y": 0, "z": 0.5}, "file": path}
    robot.map(**asked)
    good = path.read_bytes()
    for at in range(0, len(good), 41):
        path.write_bytes(good[:at] + bytes([good[at] ^ 4]) + good[at + 1 :])
        message = "is damaged, or another program|it is no Parquet file|lack the checksum"
        with pytest.raises(funicular.FileError, match=message):
            funicular.Sweep.read(path)
        with pytest.raises(funicular.FileError, match=message):
            robot.map(**asked, resume=True)
    path.write_bytes(good)
    assert len(funicular.Sweep.read(path)) == 2


def test_files_of_other_sweeps_are_left_alone(robot: funicular.Robot, tmp_path: Path) -> None:
    path = tmp_path / "map.parquet"
    robot.map({"x": [0, 1], "y": 0, "z": 0.5}, file=path)
    assert len(robot.map({"x": [0, 1], "y": 0, "z": 0.5}, file=path, resume=True)) == 2
    with pytest.raises(funicular.FileError, match="belongs to another sweep"):
        robot.map({"x": [0, 2], "y": 0, "z": 0.5}, file=path, resume=True)
    with pytest.raises(funicular.FileError, match="robot file, line"):
        robot.with_(mass_kg=20).map({"x": [0, 1], "y": 0, "z": 0.5}, file=path, resume=True)
    Path(f"{path}.partial").write_text("no journal")
    with pytest.raises(funicular.FileError, match="start again with `discard=True`"):
        robot.map({"x": [0, 1], "y": 0, "z": 0.5}, file=path)
    assert len(robot.map({"x": [0, 1], "y": 0, "z": 0.5}, file=path, discard=True)) == 2
    os.mkfifo(tmp_path / "pipe.csv")
    with pytest.raises(funicular.FileError, match="leave out `file`") as error:
        robot.map({"x": [0, 1], "y": 0, "z": 0.5}, file=tmp_path / "pipe.csv")
    assert "--" not in str(error.value)
    (tmp_path / "other.parquet").write_text("no")
    with pytest.raises(funicular.FileError, match="no Parquet file"):
        funicular.Sweep.read(tmp_path / "other.parquet")


@pytest.mark.parametrize(
    ("command", "keywords", "told"),
    [
        ("map", {}, "`grid` or `poses`"),
        ("map", {"grid": {"x": 0}, "poses": [[0, 0, 0]]}, "`grid` or `poses`"),
        ("map", {"grid": {"q": 0}}, "no axis `q`"),
        ("map", {"grid": {"x": (0, 1, 1)}}, r"`x\[2\]` is 1: the third of a tuple is the number of values"),
        ("map", {"grid": {"x": (0, 1, -1)}}, r"`x\[2\]` is -1: the third of a tuple is the number of values"),
        ("map", {"grid": {"x": (0, 1, -(10**30))}}, r"`x\[2\]` is -1e30: the third of a tuple"),
        ("map", {"grid": {"x": (-0.1, 0.1, 5.0)}}, r"`x\[2\]` is 5.0, of type float: give a whole number; .* give a list"),
        ("map", {"grid": {"x": (-0.1, 0.1, True)}}, r"`x\[2\]` is True, of type bool: give a whole number; .* give a list"),
        ("sweep", {"vary": {"platform.mass_kg": (10, 20, "3")}}, r"`platform.mass_kg\[2\]` is '3', of type str: give a whole number"),
        ("map", {"grid": {"x": []}}, "x: it has no values"),
        ("map", {"grid": {"x": [0, float("nan")]}}, "not a finite number"),
        ("map", {"poses": [[0, 0]]}, "give x, y, z"),
        ("map", {"poses": [[0, 0, 0.5]], "pose": [0, 0, 1]}, "give `pose` or `poses`, not both"),
        ("map", {"poses": [[0, 0, 0.5]], "lengths_m": [7] * 6}, "give `lengths_m` or `poses`, not both"),
        ("map", {"poses": np.zeros((0, 3))}, "has no poses"),
        ("map", {"grid": {"x": 0}, "quantities": ["tension-mx"]}, "did you mean `tension-max`"),
        ("map", {"grid": {"x": 0}, "quantities": []}, "`quantities` is an empty list"),
        ("map", {"grid": {"x": 0}, "tension_rule": "middle"}, "nothing to choose"),
        ("map", {"grid": {"x": 0}, "resume": True}, "go with `file`"),
        ("map", {"grid": {"x": 0}, "chunks_per_task": 3}, "goes with `executor`"),
        ("map", {"grid": {"x": 0}, "executor": 3}, "`executor` is a int"),
        ("map", {"grid": {"x": 0}, "executor": ThreadPoolExecutor, "chunks_per_task": -1}, "`chunks_per_task` is -1"),
        ("map", {"grid": {"x": 0}, "threads": 0}, "`threads` is 0"),
        ("map", {"grid": {"x": 0}, "threads": -1}, "`threads` is -1: give at least one"),
        ("map", {"grid": {"x": 0}, "threads": 1025}, "`threads` is 1025: .* at most 1024"),
        ("sweep", {"vary": {"platform.mass_kg": 1}, "threads": 2**61}, "at most 1024"),
        ("map", {"grid": {"x": (0, 1, 10**9)}}, "more than the 100000000"),
        ("sweep", {"vary": {"platform.mas_kg": [1, 2]}}, "mas_kg"),
        ("sweep", {"vary": {"platform.mass_kg": (-1, 1, 3)}}, "mass_kg"),
        ("sweep", {"vary": {"a b": 1}}, "not a path"),
    ],
)
def test_arguments_that_mean_nothing_are_explained(
    command: str, keywords: dict[str, Any], told: str, robot: funicular.Robot
) -> None:
    with pytest.raises(funicular.Error, match=told.replace("(", r"\(")) as error:
        getattr(robot, command)(**keywords)
    assert "--" not in str(error.value)


# A limit of the file size replaces a full disk: it fails in the same way and can be set on every machine.
FULL = """
import resource, sys
import funicular, workers
resource.setrlimit(resource.RLIMIT_FSIZE, (100_000, resource.RLIM_INFINITY))
try:
    workers.ask_long(funicular.Robot.example(), file=sys.argv[1], threads=3)
except funicular.FileError as error:
    print(error)
"""


def test_a_full_disk_is_explained_and_what_was_written_goes_on(robot: funicular.Robot, tmp_path: Path) -> None:
    pytest.importorskip("resource")
    path, whole = tmp_path / "map.parquet", tmp_path / "whole.parquet"
    line = [sys.executable, "-c", FULL, str(path)]
    done = subprocess.run(line, cwd=Path(__file__).parent, capture_output=True, text=True, check=False)
    assert done.returncode == 0 and "panicked" not in done.stderr, done.stderr
    assert "cannot write" in done.stdout and "fix the cause, then continue with `resume=True`" in done.stdout
    begun: list[int] = []
    workers.ask_long(robot, file=path, resume=True, progress=lambda done, _: begun.append(done))
    workers.ask_long(robot, file=whole)
    assert begun[0] > 0 and path.read_bytes() == whole.read_bytes()


def test_the_plan_says_what_was_asked(rows: funicular.Sweep) -> None:
    assert rows.plan["quantities"] == ["tension-max", "first-kind"] and rows.plan["command"] == "map"
    assert json.dumps(rows.plan)


def test_a_dataset_has_the_dimensions_of_the_grid_and_survives_netcdf(rows: funicular.Sweep, tmp_path: Path) -> None:
    xarray = pytest.importorskip("xarray")
    of = rows.to_xarray()
    assert of["tension_max_n"].dims == ("y", "x") and of["tension_max_n"].shape == (3, 9)
    # One point by its coordinates, against the row itself.
    at = (rows["x_m"] == 1.0) & (rows["y_m"] == -1.0)
    assert at.sum() == 1
    assert of["tension_max_n"].sel(x=1.0, y=-1.0).item() == rows["tension_max_n"][at][0]
    assert float(of["z"]) == 0.5 and of["z"].dims == () and of["z"].attrs["units"] == "m"
    assert of["tension_max_n"].attrs["units"] == "N" and of["tension_max_n"].attrs["long_name"] == rows.about["tension_max_n"]
    assert funicular.Robot.from_toml(of.attrs["robot"]) == rows.robot

    of.to_netcdf(tmp_path / "rows.nc")
    with xarray.open_dataset(tmp_path / "rows.nc") as read:
        assert read.load().equals(of) and read.attrs == of.attrs
        assert read["tension_max_n"].attrs == of["tension_max_n"].attrs


def test_datasets_of_varied_values_of_poses_and_of_parts(robot: funicular.Robot, tmp_path: Path) -> None:
    pytest.importorskip("xarray")
    varied = robot.sweep({"platform.mass_kg": (10, 20, 3), "platform.center_of_mass_m.z": (0.0, 0.1, 2)}, quantities=["tension-min"])
    of = varied.to_xarray()
    assert of["tension_min_n"].dims == ("platform.center_of_mass_m.z", "platform.mass_kg")
    assert np.array_equal(of["tension_min_n"].values.ravel(), varied["tension_min_n"])
    assert of["platform.mass_kg"].values.tolist() == [10, 15, 20] and of["platform.mass_kg"].attrs["units"] == "kg"

    listed = robot.map(poses=[[0, 0, 0.5], [0, 0.1, 0.5], [0, 0.2, 0.5]], quantities=["tension-min"])
    of = listed.to_xarray()
    assert of["tension_min_n"].dims == ("row",) and np.array_equal(of["y_m"], listed["y_m"])


def test_datasets_of_modes_and_responses(robot: funicular.Robot, tmp_path: Path) -> None:
    xarray = pytest.importorskip("xarray")
    rest = robot.equilibrium()
    modes = rest.modes(below_hz=2, stations=3)
    of = modes.to_xarray()
    assert np.array_equal(of["frequency_hz"], modes.frequency_hz) and of["frequency_hz"].attrs == {"units": "Hz"}
    assert modes.eigenvalue_per_s is not None and modes.cable_shapes is not None
    assert np.array_equal(of["eigenvalue_imag_per_s"], modes.eigenvalue_per_s.imag)
    assert of["shape"].sel(motion="rz", mode=2).item() == modes.shape[1, 5]
    assert of["cable_shapes"].dims == ("mode", "cable", "station", "direction")
    assert of["cable_energy_fractions"].sel(cable="3").values.tolist() == modes.cable_energy_fractions[:, 2].tolist()
    of.to_netcdf(tmp_path / "modes.nc")
    with xarray.open_dataset(tmp_path / "modes.nc") as read:
        assert read.load().equals(of)

    request = robot.request("frf", from_hz=1, to_hz=2, points=5, input=["fz", "fx"], output=["az", "z"])
    of = funicular.run(request).to_xarray()
    direct = rest.frf(of["frequency_hz"].values, ["fz", "fx"], ["az", "z"])
    rows = of.sel(response=(of["input"] == "fx") & (of["output"] == "z"))
    assert np.allclose((rows["real"] + 1j * rows["imag"]).values[0], direct[1, 1], rtol=1e-12)
    assert rows["unit"].item() == "m/N"
    of.to_netcdf(tmp_path / "frf.nc")
    one = funicular.run(robot.request("frf", from_hz=1, to_hz=2, points=5)).to_xarray()
    assert one["real"].dims == ("frequency_hz",) and one["real"].attrs == {"units": "(m/s²)/N"}

    settle = rest.settle([0, 0, 10])
    of = settle.to_xarray()
    assert of["history_x_m"].values.tolist() == [row["x_m"] for row in settle["history"]]
    assert of["history_x_m"].attrs == {"units": "m"} and of.attrs["peak_m"] == settle["peak_m"]


def test_a_dataset_without_xarray_names_the_package(rows: funicular.Sweep, monkeypatch: pytest.MonkeyPatch) -> None:
    monkeypatch.setitem(sys.modules, "xarray", None)
    with pytest.raises(ImportError, match="a dataset needs the package xarray: pip install xarray"):
        rows.to_xarray()
