"""Equal tasks, this package beside other programs, in one sitting: `bench/peers` runs it in an environment of its own.

Every task has a reference in high precision, and every program its error against it beside its time. Times are CPU seconds of this
process; programs take turns, ROUNDS times each, so that a slow moment of the machine meets all of them. A table row says the
median and the spread of a program; a ratio is the median of the ratios of the rounds. Where the spread is above NOISY the row
says so, and is not to be quoted. `--write docs/speed.md` puts the tables between the marks of that page.
"""

import argparse
import contextlib
import importlib.metadata
import io
import json
import math
import os
import platform
import re
import runpy
import statistics
import sys
import tempfile
import time
from collections.abc import Callable
from dataclasses import dataclass
from pathlib import Path
from typing import Any

import funicular
import mpmath
import numba
import numpy as np
import scipy.linalg
import scipy.optimize

ROOT = Path(__file__).resolve().parent.parent
ROUNDS = 7
# CPU time of one round of one program below which it is repeated [s].
MIN_ROUND_S = 0.05
# Spread, half the range of the middle half over the median, above which a row is not to be quoted.
NOISY = 0.1

# Gravity of the robot files [m/s²].
GRAVITY = 9.81

# Digits of the references.
mpmath.mp.dps = 30


@dataclass
class Program:
    """A program at a task: what runs, and the error of what it returned."""

    name: str
    run: Callable[[], Any]
    error: Callable[[Any], float]


@dataclass
class Task:
    """Task with its programs; the first is this package. A run does `units` units of work."""

    name: str
    unit: str
    units: int
    reference: str
    programs: list[Program]


# ---- One catenary: end forces from the places of the ends ----

SPAN, RISE, LENGTH, WEIGHT, STIFFNESS = 6.2, 2.9, 6.87, 0.6, 1.2e6


def exact_catenary(span: float, rise: float, length: float, weight: float, stiffness: float) -> tuple[Any, Any]:
    """Horizontal and vertical force at the start, by Irvine's equations in 30 digits."""
    rough = [float(of) for of in (span, rise, length, weight, stiffness)]
    near = newton(*rough, *start(*rough))
    span, rise, length, weight, stiffness = (mpmath.mpf(of) for of in (span, rise, length, weight, stiffness))

    def ends(h: Any, v: Any) -> tuple[Any, Any]:
        end = v + weight * length
        x = h * length / stiffness + h / weight * (mpmath.asinh(end / h) - mpmath.asinh(v / h))
        z = (v * length + weight * length**2 / 2) / stiffness + (mpmath.hypot(h, end) - mpmath.hypot(h, v)) / weight
        return x - span, z - rise

    found = mpmath.findroot(ends, near)
    return found[0], found[1]


def start(span: float, rise: float, length: float, weight: float, stiffness: float) -> tuple[float, float]:
    """First values of a search: a parabola if the cable is longer than its chord, or a taut line."""
    chord = math.hypot(span, rise)
    if length > chord:
        h = weight * span * math.sqrt(span / (24 * max(math.sqrt(length**2 - rise**2) - span, 1e-6 * span)))
    else:
        h = stiffness * (chord / length - 1) * span / chord
    return h, h * rise / span - weight * length / 2


@numba.njit
def newton(span: float, rise: float, length: float, weight: float, stiffness: float, h: float, v: float) -> tuple[float, float]:
    """Newton's method on Irvine's equations, halved where the horizontal force would become negative."""
    for _ in range(50):
        end = v + weight * length
        before, after = math.sqrt(h * h + v * v), math.sqrt(h * h + end * end)
        a, b = math.asinh(end / h), math.asinh(v / h)
        x = h * length / stiffness + h / weight * (a - b) - span
        z = (v * length + weight * length * length / 2) / stiffness + (after - before) / weight - rise
        xh = length / stiffness + (a - b) / weight - (end / after - v / before) / weight
        xv = h / weight * (1 / after - 1 / before)
        zv = length / stiffness + (end / after - v / before) / weight
        det = xh * zv - xv * xv
        dh, dv = (zv * x - xv * z) / det, (xh * z - xv * x) / det
        step = 1.0
        while h - step * dh <= 0:
            step *= 0.5
        h, v = h - step * dh, v - step * dv
        if abs(dh) + abs(dv) < 1e-12 * (abs(h) + abs(v)):
            break
    return h, v


def one_catenary() -> Task:
    import moorpy

    exact = exact_catenary(SPAN, RISE, LENGTH, WEIGHT, STIFFNESS)

    def error(found: tuple[float, float]) -> float:
        return max(abs(float(found[0] - exact[0])), abs(float(found[1] - exact[1]))) / float(mpmath.hypot(*exact))

    def ours() -> tuple[float, float]:
        cable = funicular.Catenary(SPAN, RISE, unstrained_length_m=LENGTH, weight_n_per_m=WEIGHT, axial_stiffness_n=STIFFNESS)
        h, tension = cable.horizontal_force_n, cable.tension_start_n
        return h, math.copysign(math.sqrt(max(tension**2 - h**2, 0)), float(exact[1]))

    def by_moorpy() -> tuple[float, float]:
        fx, fz, *_ = moorpy.Catenary.catenary(SPAN, RISE, LENGTH, STIFFNESS, WEIGHT, CB=-1e9, Tol=1e-10)
        return -fx if fx < 0 else fx, fz

    def by_scipy() -> tuple[float, float]:
        def ends(of: Any) -> list[float]:
            h, v = of
            end = v + WEIGHT * LENGTH
            x = h * LENGTH / STIFFNESS + h / WEIGHT * (math.asinh(end / h) - math.asinh(v / h))
            z = (v * LENGTH + WEIGHT * LENGTH**2 / 2) / STIFFNESS + (math.hypot(h, end) - math.hypot(h, v)) / WEIGHT
            return [x - SPAN, z - RISE]

        return tuple(scipy.optimize.root(ends, start(SPAN, RISE, LENGTH, WEIGHT, STIFFNESS), tol=1e-12).x)

    def by_numba() -> tuple[float, float]:
        return newton(SPAN, RISE, LENGTH, WEIGHT, STIFFNESS, *start(SPAN, RISE, LENGTH, WEIGHT, STIFFNESS))

    programs = [
        Program("funicular (Python)", ours, error),
        # The vertical force has another sign there.
        Program("MoorPy", by_moorpy, lambda of: min(error(of), error((of[0], -of[1])))),
        Program("SciPy `root`", by_scipy, error),
        Program("Newton in numba", by_numba, error),
    ]
    return Task("One catenary, called from Python", "µs", 1, "Irvine's equations in 30 digits", programs)


# ---- The pose of a robot from its lengths ----


def pose_from_lengths() -> Task:
    import moorpy

    robot = funicular.Robot.example()
    rest = robot.equilibrium()
    lengths = np.asarray(rest.unstrained_length_m)
    values = robot.to_dict()
    rope = next(iter(values["materials"].values()))
    stiffness = rope["youngs_modulus_pa"] * math.pi / 4 * rope["diameter_m"] ** 2
    weight, load = GRAVITY * rope["mass_kg_per_m"], GRAVITY * robot.mass_kg
    anchors, attachments = np.asarray(robot.anchor_m), np.asarray(robot.attachment_m)
    center = np.asarray(values["platform"].get("center_of_mass_m", [0, 0, 0]), dtype=float)

    def rotation(roll: Any, pitch: Any, yaw: Any, lib: Any) -> list[list[Any]]:
        a, b, c = (lib.cos(of) for of in (roll, pitch, yaw))
        d, e, f = (lib.sin(of) for of in (roll, pitch, yaw))
        return [
            [b * c, c * d * e - a * f, d * f + a * c * e],
            [b * f, a * c + d * e * f, a * e * f - c * d],
            [-e, b * d, a * b],
        ]

    def residual(at: Any, forces: Callable[..., tuple[Any, Any]], lib: Any) -> list[Any]:
        """Force, and moment about the origin, of cables and weight; `forces` of a cable at its platform end."""
        turned = rotation(*at[3:], lib)
        arm = lambda point: [sum(turned[k][j] * float(point[j]) for j in range(3)) for k in range(3)]  # noqa: E731
        of_weight, total = arm(center), [0, 0, -load]
        moment = [-of_weight[1] * load, of_weight[0] * load, 0]
        for i in range(len(lengths)):
            lever = arm(attachments[i])
            way = [float(anchors[i][k]) - at[k] - lever[k] for k in range(3)]
            span = lib.sqrt(way[0] ** 2 + way[1] ** 2)
            h, v = forces(span, way[2], lengths[i])
            force = [h * way[0] / span, h * way[1] / span, v]
            total = [a + b for a, b in zip(total, force, strict=True)]
            moment = [
                moment[0] + lever[1] * force[2] - lever[2] * force[1],
                moment[1] + lever[2] * force[0] - lever[0] * force[2],
                moment[2] + lever[0] * force[1] - lever[1] * force[0],
            ]
        return [*total, *moment]

    def by_newton(span: float, rise: float, length: float) -> tuple[float, float]:
        return newton(span, rise, length, weight, stiffness, *start(span, rise, length, weight, stiffness))

    def exactly(span: Any, rise: Any, length: float) -> tuple[Any, Any]:
        return exact_catenary(span, rise, length, weight, stiffness)

    # One Newton step after another in 30 digits, with the matrix of differences in double precision.
    near = [*rest.pose.position_m, *np.radians(rest.pose.roll_pitch_yaw_deg)]
    matrix = scipy.optimize.approx_fprime(near, lambda of: np.array(residual(of, by_newton, math), dtype=float), 1e-7)
    inverse = mpmath.matrix(np.linalg.inv(matrix).tolist())
    exact = [mpmath.mpf(of) for of in near]
    for _ in range(8):
        step = inverse * mpmath.matrix(residual(exact, exactly, mpmath))
        exact = [a - b for a, b in zip(exact, step, strict=True)]
    assert max(abs(of) for of in step) < 1e-18, step

    def error(found: Any) -> float:
        return max(abs(float(exact[k] - mpmath.mpf(float(found[k])))) for k in range(3))

    def ours() -> Any:
        return robot.equilibrium(lengths_m=lengths).pose.position_m

    near_start = np.array(near) + 0.01

    def by_scipy() -> Any:
        function = lambda of: np.array(residual(of, by_newton, math), dtype=float)  # noqa: E731
        return scipy.optimize.root(function, near_start, tol=1e-12).x[:3]

    def by_moorpy() -> Any:
        system = moorpy.System(depth=0)
        system.g, system.rho = 1.0, 0.0
        system.addBody(0, near_start, m=load, rCG=center)
        body = system.bodyList[0]
        system.lineTypes["rope"] = {
            "name": "rope", "d_vol": 1e-6, "m": weight, "w": weight, "EA": stiffness, "EAd": 0, "EAd_Lm": 0, "MBL": 0, "cost": 0,
            "notes": "", "input_type": "", "input_d": 0, "material": "rope",
        }  # fmt: skip
        for anchor, attachment, length in zip(anchors, attachments, lengths, strict=True):
            system.addPoint(1, anchor)
            fixed = system.pointList[-1]
            system.addPoint(1, near_start[:3] + attachment)
            end = system.pointList[-1]
            body.attachPoint(end.number, attachment)
            system.addLine(length, "rope", pointA=fixed.number, pointB=end.number)
            system.lineList[-1].cb = -1e9
        with contextlib.redirect_stdout(io.StringIO()):
            system.initialize()
            system.solveEquilibrium(tol=1e-8)
        return body.r6[:3]

    programs = [
        Program("funicular (Python), no start pose", ours, error),
        Program("MoorPy, from 10 mm and 10 mrad away", by_moorpy, error),
        Program("SciPy `root` with numba, from there", by_scipy, error),
    ]
    return Task("Pose of six sagging cables from their lengths", "µs", 1, "Newton's method in 30 digits", programs)


# ---- All natural frequencies below a limit ----

LIMIT_HZ = 5.0


def frequencies() -> Task:
    rest = funicular.Robot.example().equilibrium()
    exact = np.asarray(rest.modes(LIMIT_HZ, cable_model="catenary-dynamic").frequency_hz)

    def error(found: Any) -> float:
        found = np.sort(np.asarray(found))[: len(exact)]
        return float(np.max(np.abs(found / exact - 1))) if len(found) == len(exact) else math.inf

    def ours() -> Any:
        return rest.modes(LIMIT_HZ).frequency_hz

    def by_opensees(segments: int) -> Callable[[], Any]:
        path = Path(tempfile.mkdtemp()) / "robot.py"
        rest.export("opensees", path, segments=segments)
        # As many frequencies as there are below the limit.
        text = re.sub(r"^FREQUENCIES_HZ = \[.*?\]", f"FREQUENCIES_HZ = {list(map(float, exact))}", path.read_text(), flags=re.M | re.S)
        path.write_text(text)

        def run() -> Any:
            with contextlib.redirect_stdout(io.StringIO()):
                return runpy.run_path(str(path))["frequencies"]

        return run

    programs = [Program("funicular, `catenary-dynamic`", ours, error)]
    programs += [Program(f"OpenSees, {n} bars a cable, statics included", by_opensees(n), error) for n in (10, 20, 40)]
    about = "the exact frequencies of this package; OpenSees converges to them with the square of the bars"
    return Task(f"All {len(exact)} natural frequencies below {LIMIT_HZ:g} Hz", "ms", 1, about, programs)


# ---- Load factors: how much of the required load straight cables hold ----

POSES = 20


def load_factors() -> Task:
    robot = funicular.Robot.from_file(ROOT / "robots/cogiro.toml")
    rng = np.random.default_rng(1)
    poses = np.column_stack([rng.uniform([-4, -3, 1], [4, 3, 3], (POSES, 3)), rng.uniform(-5, 5, (POSES, 3))])
    required = np.array([100.0, 100.0, 200.0])
    low, high = (np.array([row[key] for row in robot.equilibrium(pose=[0, 0, 2], tension_rule="centre").to_dict()["cables"]])
                 for key in ("minimum_tension_n", "maximum_tension_n"))  # fmt: skip
    weight = GRAVITY * robot.mass_kg
    structure, center = [], np.asarray(robot.to_dict()["platform"].get("center_of_mass_m", [0, 0, 0]), dtype=float)
    for pose in poses:
        turned = funicular.Pose(pose[:3], pose[3:]).rotation
        levers = np.asarray(robot.attachment_m) @ turned.T
        along = np.asarray(robot.anchor_m) - pose[:3] - levers
        along /= np.linalg.norm(along, axis=1, keepdims=True)
        arm = turned @ center
        structure.append((np.hstack([along, np.cross(levers, along)]).T, np.array([0, 0, -weight, *np.cross(arm, [0, 0, -weight])])))
    corners = [np.array([*(signs * required), 0, 0, 0]) for signs in np.array(np.meshgrid(*[[-1, 1]] * 3)).reshape(3, -1).T]

    def by_highs() -> Any:
        """Largest factor with which all corners of the box are held, one linear program for each corner."""
        found = []
        for matrix, dead in structure:
            of_corners = []
            for corner in corners:
                done = scipy.optimize.linprog(
                    [*np.zeros(8), -1], A_eq=np.hstack([matrix, corner[:, None]]), b_eq=-dead,
                    bounds=[*zip(low, high, strict=True), (0, None)], method="highs",
                )  # fmt: skip
                of_corners.append(done.x[-1] if done.status == 0 else 0.0)
            found.append(min(of_corners))
        return found

    def ours() -> Any:
        values = []
        for pose in poses:
            found = robot.loads(list(pose), static_model="ideal", required_force_n=list(required))
            values.append(found["required"].get("load_factor", 0.0))
        return values

    exact = by_highs()

    def error(found: Any) -> float:
        pairs = [(a, b) for a, b in zip(found, exact, strict=True) if b > 0]
        return max((abs(a / b - 1) for a, b in pairs), default=math.inf)

    programs = [Program("funicular (Python)", ours, error), Program("SciPy `linprog` with HiGHS", by_highs, error)]
    return Task("Load factor of eight straight cables for a box of forces", "ms", POSES, "HiGHS itself: both are exact", programs)


# ---- Running and writing ----


def cpu_seconds(run: Callable[[], Any]) -> float:
    """CPU time of one run, repeated until it can be measured."""
    count = 1
    while True:
        begin = time.process_time()
        for _ in range(count):
            run()
        spent = time.process_time() - begin
        if spent >= MIN_ROUND_S:
            return spent / count
        count = max(2 * count, math.ceil(count * MIN_ROUND_S / max(spent, 1e-6)))


def spread(of: list[float]) -> float:
    """Half the range of the middle half over the median."""
    lower, _, upper = statistics.quantiles(of, n=4)
    return 0.5 * (upper - lower) / statistics.median(of)


def measured(task: Task) -> dict[str, Any]:
    """Rows of a task."""
    errors = [program.error(program.run()) for program in task.programs]
    times: list[list[float]] = [[] for _ in task.programs]
    for k in range(ROUNDS):
        order = range(len(task.programs)) if k % 2 == 0 else reversed(range(len(task.programs)))
        for i in order:
            times[i].append(cpu_seconds(task.programs[i].run) / task.units)
        print(f"{task.name}: {k + 1} of {ROUNDS}", file=sys.stderr)
    rows = []
    for program, error, of in zip(task.programs, errors, times, strict=True):
        ratios = [a / b for a, b in zip(of, times[0], strict=True)]
        noise = max(spread(of), spread(ratios) if of is not times[0] else 0)
        rows.append({
            "program": program.name, "time_s": statistics.median(of), "spread": spread(of), "ratio": statistics.median(ratios),
            "error": error, "noisy": noise > NOISY,
        })  # fmt: skip
    return {"task": task.name, "unit": task.unit, "reference": task.reference, "rows": rows}


def table(found: dict[str, Any]) -> str:
    """Markdown of a task."""
    unit = found["unit"]
    factor = {"µs": 1e6, "ms": 1e3}[unit]
    lines = [f"### {found['task']}", "", f"Errors are against: {found['reference']}.", ""]
    lines += [f"| Program | Time [{unit}] | Spread | Times ours | Error |", "|---|---|---|---|---|"]
    for row in found["rows"]:
        note = " (do not quote: noisy)" if row["noisy"] else ""
        ratio = "1" if row is found["rows"][0] else f"{row['ratio']:.3g}"
        lines.append(f"| {row['program']}{note} | {factor * row['time_s']:.3g} | {row['spread']:.0%} | {ratio} | {row['error']:.1e} |")
    return "\n".join(lines) + "\n"


def machine() -> str:
    names = ("funicular", "moorpy", "openseespy", "numba", "numpy", "scipy")
    versions = ", ".join(f"{name} {importlib.metadata.version(name)}" for name in names)
    cpu = re.search(r"^model name\s*: (.*)$", Path("/proc/cpuinfo").read_text(), re.M) if os.path.exists("/proc/cpuinfo") else None
    return f"{cpu[1] if cpu else platform.processor()}, {os.cpu_count()} processors; Python {platform.python_version()}, {versions}"


TASKS = {"catenary": one_catenary, "pose": pose_from_lengths, "frequencies": frequencies, "load-factor": load_factors}
MARKS = ("<!-- beside other programs: bench/peers writes this -->", "<!-- end -->")


def main() -> None:
    arguments = argparse.ArgumentParser(description=__doc__, formatter_class=argparse.RawDescriptionHelpFormatter)
    arguments.add_argument("tasks", nargs="*", choices=[[], *TASKS], help="tasks to run; all if none is given")
    arguments.add_argument("--write", type=Path, metavar="FILE.md", help="page whose marked part is written")
    arguments.add_argument("--json", type=Path, metavar="FILE.json", help="file for all numbers")
    given = arguments.parse_args()

    found = [measured(TASKS[name]()) for name in given.tasks or TASKS]
    head = f"CPU time of one core, median of {ROUNDS} rounds in which the programs take turns. {machine()}.\n"
    text = head + "\n" + "\n".join(table(of) for of in found)
    print(text)
    if given.json:
        given.json.write_text(json.dumps({"machine": machine(), "tasks": found}, indent=1))
    if given.write:
        page = given.write.read_text()
        before, rest = page.split(MARKS[0])
        given.write.write_text(before + MARKS[0] + "\n\n" + text + "\n" + MARKS[1] + rest.split(MARKS[1])[1])


if __name__ == "__main__":
    main()
