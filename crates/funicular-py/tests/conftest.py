"""Fixtures: the robots of the repository, and the program whose results are compared."""

import json
import os
import signal
import subprocess
from collections.abc import Callable
from pathlib import Path
from typing import Any

import funicular
import pytest

ROOT = Path(__file__).parents[3]
ROBOTS = ROOT / "robots"
# The folder is also a crate, whose manifest is no robot file.
ROBOT_FILES = sorted(path.name for path in ROBOTS.glob("*.toml") if path.name != "Cargo.toml")

Program = Callable[..., dict[str, Any]]

# Mark of tests that compare responses at given frequencies, which may lie beside the peaks.
plain_grid = pytest.mark.filterwarnings("ignore::funicular.ResponseWarning")

# Ctrl-C is tested, but a shell that runs the tests in the background makes them and their children ignore it.
signal.signal(signal.SIGINT, signal.default_int_handler)


@pytest.fixture(scope="session")
def robot() -> funicular.Robot:
    return funicular.Robot.example()


@pytest.fixture(scope="session")
def rest(robot: funicular.Robot) -> funicular.Equilibrium:
    return robot.equilibrium()


@pytest.fixture(scope="session")
def cogiro() -> funicular.Robot:
    """Robot with eight cables for six degrees of freedom."""
    return funicular.Robot.from_file(ROBOTS / "cogiro.toml")


@pytest.fixture(scope="session")
def executable() -> str:
    """Path of the program, which scripts/test-python builds and names."""
    path = os.environ.get("FUNICULAR_PROGRAM")
    if not path:
        pytest.skip("FUNICULAR_PROGRAM does not name the program")
    return path


@pytest.fixture(scope="session")
def program(executable: str) -> Program:
    """Function that runs a command of the program and returns its JSON."""

    def run(*arguments: object) -> dict[str, Any]:
        line = [executable, *map(str, arguments), "--format", "json"]
        answer: dict[str, Any] = json.loads(subprocess.run(line, check=True, capture_output=True, cwd=ROOT).stdout)
        return answer

    return run
