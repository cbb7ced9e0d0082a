"""What the tests share: the repository's robots, and the program that results are compared with."""

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

Program = Callable[..., dict[str, Any]]

# Ctrl-C is tested: a shell that runs the tests in the background has them ignore it, and so all that they start.
signal.signal(signal.SIGINT, signal.default_int_handler)


@pytest.fixture(scope="session")
def robot() -> funicular.Robot:
    return funicular.Robot.example()


@pytest.fixture(scope="session")
def rest(robot: funicular.Robot) -> funicular.Equilibrium:
    return robot.equilibrium()


@pytest.fixture(scope="session")
def cogiro() -> funicular.Robot:
    """Eight cables for six degrees of freedom."""
    return funicular.Robot.from_file(ROBOTS / "cogiro.toml")


@pytest.fixture(scope="session")
def executable() -> str:
    """The program, which scripts/test-python builds and names."""
    path = os.environ.get("FUNICULAR_PROGRAM")
    if not path:
        pytest.skip("FUNICULAR_PROGRAM does not name the program")
    return path


@pytest.fixture(scope="session")
def program(executable: str) -> Program:
    """What a command of the program answers, as JSON."""

    def run(*arguments: object) -> dict[str, Any]:
        line = [executable, *map(str, arguments), "--format", "json"]
        answer: dict[str, Any] = json.loads(subprocess.run(line, check=True, capture_output=True, cwd=ROOT).stdout)
        return answer

    return run
