"""Files that commands write besides their result: keywords of methods, `write_files` of a request, and the program give the same."""

import json
from pathlib import Path

import pytest

import funicular
from conftest import Program


def bytes_of(folder: Path, name: str) -> bytes:
    return (folder / name).read_bytes()


def test_a_keyword_a_request_and_the_program_write_the_same(robot: funicular.Robot, program: Program, tmp_path: Path) -> None:
    given = {"move_m": (0, 0.05, 0), "profile_s": [1.2, 0.3], "below_hz": 5.0, "sample_time_s": 0.1}
    files = {"figure": "a.svg", "lengths": "a.csv", "page": "a.html"}
    found = robot.settle(**given, **{key: tmp_path / name for key, name in files.items()})
    again = funicular.run(robot.request("settle", **given), **{key: tmp_path / f"b{name}" for key, name in files.items()})
    request = {**robot.request("settle", **given), "write_files": {key: str(tmp_path / f"c{name}") for key, name in files.items()}}
    funicular.run(request)
    path = tmp_path / "request.json"
    path.write_text(json.dumps({**request, "write_files": {key: str(tmp_path / f"d{name}") for key, name in files.items()}}))
    program("request", path)
    assert found["modes"] == again["modes"]
    for name in ("a.svg", "a.csv"):
        assert bytes_of(tmp_path, name) == bytes_of(tmp_path, f"b{name}") == bytes_of(tmp_path, f"c{name}")
        assert bytes_of(tmp_path, name) == bytes_of(tmp_path, f"d{name}")
    assert "robot.settle(…, page=" in (tmp_path / "a.html").read_text().replace("&#34;", '"')


def test_files_are_refused_before_the_work(robot: funicular.Robot, tmp_path: Path) -> None:
    with pytest.raises(funicular.InputError, match="ends in .svg or .pdf"):
        robot.settle(release_n=(0, 0, 1), figure=tmp_path / "a.png.x")
    with pytest.raises(funicular.InputError, match="sample_time_s"):
        robot.settle(move_m=(0, 0.05, 0), profile_s=[1.2, 0.3], lengths=tmp_path / "a.csv")
    with pytest.raises(funicular.FileError, match="means CSV"):
        robot.settle(release_n=(0, 0, 1), page=tmp_path / "a.csv")
    with pytest.raises(funicular.InputError, match="writes no `page`"):
        funicular.run(robot.request("check"), page=tmp_path / "a.html")
    assert not list(tmp_path.iterdir())
