"""Python code of the documents runs as it stands, in the order of a page; printed values are those in its comments."""

import concurrent.futures
import json
import os
import re
import runpy
import subprocess
import sys
import types
from collections.abc import Callable
from pathlib import Path
from typing import Any

import funicular
import pytest
import ros_stub
from conftest import ROOT

PAGES = ["quick-start", "jupyter", "workspace", "measuring", "matlab", "python", "export", "gradients", "simulation", "stepping", "tutorials/controller", "tutorials/closed-loop", "tutorials/predictive"]


@pytest.mark.parametrize("page", PAGES)
def test_the_code_of_a_page_runs_and_prints_what_it_shows(page: str, tmp_path: Path) -> None:
    blocks = re.findall(r"^```python\n(.*?)^```", (ROOT / f"docs/{page}.md").read_text(), re.DOTALL | re.MULTILINE)
    assert blocks
    code = "\n".join(blocks)
    for folder in ("robots", "docs"):
        os.symlink(ROOT / folder, tmp_path / folder)
    (tmp_path / "page.py").write_text(code)

    done = subprocess.run(
        [sys.executable, "page.py"],
        capture_output=True,
        text=True,
        cwd=tmp_path,
        env={**os.environ, "MPLBACKEND": "Agg"},
        check=False,
    )
    assert done.returncode == 0, done.stderr

    # Every line that prints has its output in a comment.
    assert len(re.findall(r"^ *print\(", code, re.MULTILINE)) == len(re.findall(r"^ *print\(.*\)  # ", code, re.MULTILINE))
    assert re.findall(r"^ *print\(.*\)  # (.*)$", code, re.MULTILINE) == done.stdout.splitlines()


def test_both_recipes_of_a_container_build_the_same_from_the_same() -> None:
    docker = (ROOT / "docs/sweeps/Dockerfile").read_text()
    apptainer = (ROOT / "docs/sweeps/funicular.def").read_text()
    stages = re.findall(r"^Bootstrap: docker\nFrom: (\S+)\nStage: (\S+)$", apptainer, re.MULTILINE)
    images = re.findall(r"^FROM (\S+)", docker, re.MULTILINE)
    assert [image for image, _ in stages] == images == re.findall(r"^From: (\S+)", apptainer, re.MULTILINE)

    sections = re.findall(r"^%(\w+)(?: from (\w+))?$", apptainer, re.MULTILINE)
    assert sections == [("files", ""), ("post", ""), ("files", stages[0][1]), ("post", ""), ("runscript", "")]

    # The commands that make program and wheel, with the paths that they read.
    for command in (
        "cargo install --locked --root /made --path crates/funicular-cli",
        "/tools/bin/pip install --no-cache-dir maturin==",
        "/tools/bin/maturin build --release --locked --manifest-path crates/funicular-py/Cargo.toml --out /made/wheels",
    ):
        assert command in docker and command in apptainer
    maturin = re.search(r"^maturin==\S+", (ROOT / "scripts/test-python-requirements.txt").read_text(), re.MULTILINE)
    assert maturin and maturin[0] in docker and maturin[0] in apptainer
    assert (ROOT / "crates/funicular-cli/Cargo.toml").exists() and (ROOT / "crates/funicular-py/Cargo.toml").exists()


def test_ray_computes_by_the_executor_of_the_document() -> None:
    """The class of the document, with threads in place of Ray: `ray.remote(f).remote(…).future()` is a future."""
    code = re.search(r"^class RayExecutor.*?^```", (ROOT / "docs/sweeps.md").read_text(), re.DOTALL | re.MULTILINE)
    assert code
    pool = concurrent.futures.ThreadPoolExecutor(2)

    class Reference:
        def __init__(self, future: "concurrent.futures.Future[object]") -> None:
            self.future = lambda: future

    class Remote:
        def __init__(self, task: "Callable[..., object]") -> None:
            self.remote = lambda *args, **kwargs: Reference(pool.submit(task, *args, **kwargs))

    names: dict[str, Any] = {"concurrent": concurrent, "ray": types.SimpleNamespace(remote=Remote)}
    exec(code[0].removesuffix("```"), names)
    robot = funicular.Robot.example()
    grid: dict[str, Any] = {"x": (-4, 4, 9), "y": (-1, 1, 3), "z": [0.5]}
    with names["RayExecutor"](2) as executor:
        assert robot.map(grid, quantities=["tension-max"], executor=executor) == robot.map(grid, quantities=["tension-max"])


def test_the_node_of_ros_serves_equilibrium_lengths_and_tensions_on_a_stub_of_ros(monkeypatch: pytest.MonkeyPatch) -> None:
    ros_stub.install(monkeypatch.setitem)
    monkeypatch.setitem(ros_stub.Node.parameters, "robot_file", str(ROOT / "robots/cogiro.toml"))
    names = runpy.run_path(str(ROOT / "docs/export/cable_robot_node.py"))
    node = names["CableRobot"]()
    robot = funicular.Robot.from_file(ROOT / "robots/cogiro.toml")

    answer = node.called["~/equilibrium"](None, types.SimpleNamespace())
    assert answer.success and json.loads(answer.message)["pose"] == robot.equilibrium().to_dict()["pose"]

    # A pose gives lengths and tensions, and these lengths lead back to the pose.
    asked = names["PoseStamped"]()
    at, turn = asked.pose.position, asked.pose.orientation
    (at.x, at.y, at.z), (turn.w, turn.x, turn.y, turn.z) = (0.5, 0.25, 1.5), (1.0, 0.0, 0.0, 0.0)
    node.called["~/pose"](asked)
    [found] = node.published["~/cables"].sent
    rest = robot.equilibrium(pose=[0.5, 0.25, 1.5])
    assert found.name == list(robot.cable_names) and found.header is asked.header
    assert found.position == rest.unstrained_length_m.tolist() and found.effort == rest.tension_platform_n.tolist()

    node.called["~/lengths"](found)
    [back] = node.published["~/platform"].sent
    assert abs(back.pose.position.x - 0.5) < 1e-6 and abs(back.pose.position.z - 1.5) < 1e-6

    # No equilibrium: a warning, and no message.
    at.z = 500.0
    node.called["~/pose"](asked)
    found.name = found.name[1:]
    node.called["~/lengths"](found)
    assert len(node.published["~/cables"].sent) == len(node.published["~/platform"].sent) == 1
    assert "no equilibrium at this pose" in node.warned[0] and node.warned[1] == "the lengths of the cables 1 are missing"
