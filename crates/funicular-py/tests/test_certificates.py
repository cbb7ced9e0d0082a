"""Certificates of proofs: accepted by a second program with rational numbers, which rejects damaged ones."""

import hashlib
import importlib.util
import json
import random
from collections.abc import Callable
from pathlib import Path
from types import ModuleType
from typing import Any

import pytest

import funicular

ROOT = Path(__file__).resolve().parents[3]
CHECKER = ROOT / "scripts" / "check_certificate.py"


@pytest.fixture(scope="module")
def checker() -> ModuleType:
    spec = importlib.util.spec_from_file_location("check_certificate", CHECKER)
    assert spec is not None and spec.loader is not None
    module = importlib.util.module_from_spec(spec)
    spec.loader.exec_module(module)
    return module


def written(robot: funicular.Robot, path: Path, **keywords: Any) -> str:
    robot.prove(certificate=str(path), **keywords)
    return path.read_text()


def sealed(lines: list[dict[str, Any]]) -> str:
    """Text of lines with the digest that belongs to them: only the numbers can show a damage then."""
    text = "".join(json.dumps(line) + "\n" for line in lines[:-1])
    return text + json.dumps({"sha256": hashlib.sha256(text.encode()).hexdigest()}) + "\n"


@pytest.mark.parametrize(
    "keywords",
    [
        {"pose": (0, 0, 2.7), "within_m": (7.5, 5.5, 2.7), "boxes": 600, "static_model": "spring"},
        {"pose": (0, 0, 2.7), "within_m": (7.5, 5.5, 2.7), "boxes": 600},
        {"pose": (0, 0, 2), "within_m": (1, 1, 0.5), "within_deg": (1, 1, 1), "required_force_n": (20, 20, 20), "boxes": 20},
        {"pose": (0, 0, 1.5), "within_m": (0, 0, 0)},
        {"pose": (0, 0, 1.5, 0, 0, 5), "within_m": (6, 0, 0), "boxes": 40},
    ],
)
def test_certificates_are_accepted(cogiro: funicular.Robot, checker: ModuleType, tmp_path: Path, keywords: dict[str, Any]) -> None:
    found = checker.check(written(cogiro, tmp_path / "proof.jsonl", **keywords))
    proved = cogiro.prove(**keywords)
    boxes = [box["verdict"] for box in proved["boxes"]]
    for verdict in ("inside", "outside"):
        count, size = found[verdict]
        assert count == boxes.count(verdict) and size == pytest.approx(proved[verdict], rel=1e-9)
    assert found["inside"][0] > 0


def test_a_planar_robot_has_a_certificate(checker: ModuleType, tmp_path: Path) -> None:
    robot = funicular.Robot.from_file(ROOT / "robots" / "kntu-planar.toml")
    text = written(robot, tmp_path / "proof.jsonl", pose=(0, 0, 0), within_m=(1, 1, 0), boxes=200)
    assert checker.check(text)["inside"][0] > 0


Change = Callable[[list[dict[str, Any]], random.Random], None]


def box_of(lines: list[dict[str, Any]], chance: random.Random, verdict: str) -> dict[str, Any]:
    return chance.choice([line for line in lines[1:-2] if line["verdict"] == verdict])


def tension(lines: list[dict[str, Any]], chance: random.Random) -> None:
    """A tension of one cable is another one: the balance is lost by more than other tensions can make up."""
    part = box_of(lines, chance, "inside")["tensions"][0][0]
    part[chance.randrange(len(part))] *= chance.choice([-1.0, 0.0, 20.0])


def change_of_tension(lines: list[dict[str, Any]], chance: random.Random) -> None:
    part = box_of(lines, chance, "inside")["tensions"][0]
    part[chance.randrange(1, len(part))][chance.randrange(8)] += chance.choice([-1e4, 1e4])


def larger(lines: list[dict[str, Any]], chance: random.Random) -> None:
    """A box is wider than what is proved, up to the box of the statement."""
    box = box_of(lines, chance, chance.choice(["inside", "outside"]))
    box["lower"], box["upper"] = list(lines[0]["lower"]), list(lines[0]["upper"])


def other_verdict(lines: list[dict[str, Any]], chance: random.Random) -> None:
    box = box_of(lines, chance, "inside")
    outside = box_of(lines, chance, "outside")
    for place in ("lower", "upper"):
        box[place], outside[place] = outside[place], box[place]


def direction(lines: list[dict[str, Any]], chance: random.Random) -> None:
    box = box_of(lines, chance, "outside")
    box["direction"] = [-x for x in box["direction"]] if chance.random() < 0.5 else [0.0] * 6


def load(lines: list[dict[str, Any]], chance: random.Random) -> None:
    box_of(lines, chance, "outside")["load"] = chance.choice([-1, 1, 0.5, None])


def limit(lines: list[dict[str, Any]], chance: random.Random) -> None:
    cable = chance.choice(lines[0]["cables"])
    cable.update(chance.choice([{"least": 4000.0}, {"greatest": 101.0}, {"greatest": 50.0}, {"least": -5.0}]))


def anchor(lines: list[dict[str, Any]], chance: random.Random) -> None:
    chance.choice(lines[0]["cables"])["anchor"][chance.randrange(3)] += chance.choice([-5.0, 5.0])


def weight(lines: list[dict[str, Any]], chance: random.Random) -> None:
    lines[0]["loads"][0][2] *= chance.choice([0.2, 5.0, -1.0])


def dropped(lines: list[dict[str, Any]], chance: random.Random) -> None:
    del lines[chance.randrange(1, len(lines) - 2)]


def doubled(lines: list[dict[str, Any]], chance: random.Random) -> None:
    """A box counts twice, and the end agrees."""
    box = box_of(lines, chance, "inside")
    lines.insert(1, box)
    volume = 1.0
    for low, high in zip(box["lower"], box["upper"], strict=True):
        volume *= high - low
    lines[-2]["inside"] += 1
    lines[-2]["inside_size"] += volume


def size(lines: list[dict[str, Any]], chance: random.Random) -> None:
    lines[-2][chance.choice(["inside_size", "outside_size"])] *= chance.choice([0.999, 1.001])


def no_number(lines: list[dict[str, Any]], chance: random.Random) -> None:
    box = box_of(lines, chance, "inside")
    box["tensions"][0][0][0] = chance.choice([float("nan"), float("inf"), "1", None, True])


def missing(lines: list[dict[str, Any]], chance: random.Random) -> None:
    line = chance.choice(lines[:-1])
    del line[chance.choice([key for key in line if key not in ("claim", "robot")])]


DAMAGES: list[Change] = [
    *(tension, change_of_tension, larger, other_verdict, direction, load, limit, anchor, weight, dropped, doubled, size),
    *(no_number, missing),
]


def test_damaged_certificates_are_rejected(cogiro: funicular.Robot, checker: ModuleType, tmp_path: Path) -> None:
    keywords: dict[str, Any] = {"pose": (0, 0, 2.7), "within_m": (7.5, 5.5, 2.7), "boxes": 2000, "static_model": "spring"}
    text = written(cogiro, tmp_path / "proof.jsonl", **keywords)
    lines = [json.loads(line) for line in text.splitlines()]
    assert checker.check(sealed(lines)) == checker.check(text)

    # With the digest that belongs to it, a damage shows in the numbers.
    chance = random.Random(5)
    for number in range(100):
        damage = DAMAGES[number % len(DAMAGES)]
        copy = json.loads(text.splitlines()[0]), *(json.loads(line) for line in text.splitlines()[1:])
        damaged = list(copy)
        damage(damaged, chance)
        with pytest.raises(checker.Rejected):
            checker.check(sealed(damaged))
            pytest.fail(f"accepted: {damage.__name__}, number {number}")

    # Any other change is found by the digest.
    for _ in range(20):
        place = chance.randrange(len(text) - 1)
        other = chance.choice([c for c in "0123456789" if c != text[place]])
        with pytest.raises(checker.Rejected):
            checker.check(text[:place] + other + text[place + 1 :])
    for cut in (0, 1, len(text) // 2, len(text) - 1):
        with pytest.raises(checker.Rejected):
            checker.check(text[:cut])
