"""Comparison of funicular with other programs on robots of the library; scripts/cross-check runs it."""

import contextlib
import csv
import io
import json
import logging
import math
import os
import re
import runpy
import subprocess
import sys
import tempfile
import tomllib
from pathlib import Path

import control
import fmpy
import moordyn
import moorpy
import mujoco
import numpy as np
import pyuff
import vtk
import yourdfpy
from fmpy import fmi2, fmi3
from pydrake.multibody.parsing import Parser
from pydrake.multibody.plant import MultibodyPlant
from pydrake.multibody.tree import ForceElementIndex
from vtk.util.numpy_support import vtk_to_numpy

# Elements of Gazebo that Drake passes over.
logging.getLogger("drake").setLevel(logging.ERROR)

# Maximum differences that pass.
POSITION_M = 1e-6  # of any attachment
TENSION_RATIO = 1e-6  # of the robot's maximum tension
# Relative error of a frequency from the platform's frame and the eigenvalue solver.
FLOOR_RATIO = 2e-6
# The error of a chain is of second order in the length of its bars. A chain with half as many bars therefore gives an
# estimate of the error: a third of the change. Errors of other orders are covered by this factor.
MARGIN = 1.5
# Remaining fraction of this error after extrapolation from two meshes.
EXTRAPOLATED = 0.5

# Most times that MuJoCo simulates ten times the time in which the slowest motion decays to 1/e.
MAX_TIMES = 20
# Relative difference of a frequency of MuJoCo's model, whose stiffness is a difference quotient.
STIFFNESS_RATIO = 1e-3

BARS = 20

# Cables as chains in MuJoCo: robots with sagging cables, pulleys, point masses and planes; numbers of pieces; least number
# of modes that are compared. Relative errors of frequencies and of the sag are at most these over the square of the number of pieces.
CHAINED = ["yuan2014-4mm", "cogiro-winches", "kntu-planar", "yuan2014-8mm", "stadium-camera", "fast"]
PIECES = (4, 8, 16)
FIRST_MODES = 6
CHAIN_FREQUENCY = 0.4
CHAIN_SAG = 0.03
# Part of the commanded way that a rope which comes and goes without mass leaves: 5e-3 where ropes of 0.46 kg each hold 10 kg.
CHAIN_COMMAND = 1e-2

# Motions in MoorDyn: time [s], options, events, and the difference of the tensions from `simulate` over their root mean square.
RELEASE = "[[release]]\nat_s = 0.0\nmass_kg = 1.95\n"
MOVE = (
    "[[lengths]]\nat_s = 0.2\nduration_s = 1.0\nchange_m = { 1 = -0.01, 2 = -0.01, 3 = -0.01, 4 = -0.01, 5 = -0.01, 6 = -0.01 }\n"
    "[[stop]]\nat_s = 0.7\nduration_s = 0.2\n"
)
CUT = '[[cut]]\ncable = "1"\nat_s = 0.1\n'
SCENARIOS = [("release", 2.0, ["--mass-kg=12.5"], RELEASE, 3e-2), ("move", 2.0, [], MOVE, 3e-3), ("cut", 1.0, [], CUT, 3e-2)]
# Part of the difference that is left with twice as many segments: 1/4 for long waves, more for a step.
HALVED = 0.7


class Case:
    """A robot with the load on it."""

    def __init__(self, name, seconds=None, segments=BARS, robot=None, options=(), tilted=False, driven=False, awkward=False):
        self.name, self.robot, self.options, self.tilted = name, robot or name, list(options), tilted
        # True for a robot with a flexible post and names that no XML holds as they are.
        self.awkward = awkward
        # True for a robot with pulleys and winches, which only OpenSees has, as springs.
        self.driven = driven
        # Time [s] that MoorDyn integrates (some periods of the lowest mode), None if MoorDyn cannot model the robot;
        # segments.
        self.seconds, self.segments = seconds, segments


LOADED = ["--force-n=200,100,-300", "--load-point-m=0.3,0.2,0.1", "--moment-n-m=100,-60,50"]
PUSHED = ["--force-n=3,2,-1", "--load-point-m=0.1,0.05,0.02", "--moment-n-m=0.3,0.1,0.4"]
SHORT = [
    Case("yuan2014-4mm", 10.0), Case("cogiro", 4.0), Case("cogiro, loaded", robot="cogiro", options=LOADED),
    Case("kntu-planar, loaded", robot="kntu-planar", options=PUSHED), Case("kntu-planar, tilted", robot="kntu-planar", tilted=True),
    Case("yuan2014-4mm, winches", robot="yuan2014-4mm", driven=True),
]  # fmt: skip
ALL = [
    Case("yuan2014-4mm", 20.0), Case("cogiro", 10.0), Case("yuan2014-8mm", 20.0, 2 * BARS), Case("sap2000-8-cable-point-mass", 4.0),
    Case("ipanema2", 2.0), Case("stadium-camera", 20.0), Case("fast", 100.0), Case("caroca", 4.0), Case("expo2015-lucia", 4.0),
    Case("nist-robocrane", 4.0), Case("kntu-planar"), *SHORT[2:],
    Case("stadium-camera, loaded", robot="stadium-camera", options=["--force-n=50,20,10"]),
]  # fmt: skip

# Robots whose pulleys, winches or few cables only MuJoCo's check has.
SIMULATED = [Case("yuan2014-4mm, names, post", robot="yuan2014-4mm", awkward=True), *(Case(name) for name in ("cogiro-winches", "grab-2-cables", "grab-3-cables", "grab-4-cables", "yuan2014-dynamic-test"))]


class Table:
    """Table of differences and their limits."""

    def __init__(self):
        self.failed = 0
        print(f"{'robot':28} {'program':20} {'quantity':46} {'difference':>11} {'limit':>9}")

    def row(self, robot, program, quantity, difference, limit):
        passed = difference <= limit
        self.failed += not passed
        print(f"{robot:28} {program:20} {quantity:46} {difference:11.2e} {limit:9.1e}{'' if passed else '  FAILED'}", flush=True)


class Robot:
    """A robot of the library with the results of funicular."""

    def __init__(self, program, case, folder):
        self.program, self.name, self.options = program, case.name, case.options
        self.path = f"robots/{case.robot}.toml"
        self.file = tomllib.loads(Path(self.path).read_text())
        if case.tilted:
            self.path = folder / "tilted.toml"
            self.path.write_text(tilted(self.file))
            self.file = tomllib.loads(self.path.read_text())
        if case.driven:
            text = driven(Path(self.path).read_text(), self.file)
            self.path = folder / "driven.toml"
            self.path.write_text(text)
            self.file = tomllib.loads(text)
        if case.awkward:
            text = Path(self.path).read_text().replace("[[cables]]", '[[cables]]\nsupport = "post"', 2)
            text = text.replace('name = "1"', 'name = "<&\\uFFFE --\\""').replace('name = "2"', 'name = "索 a/b::c"')
            self.path = folder / "awkward.toml"
            self.path.write_text(text + "\n[supports.post]\nstiffness_n_per_m = 50000\n")
            self.file = tomllib.loads(self.path.read_text())
        self.statics = json.loads(self.run("statics", "--format", "json"))
        platform = self.file["platform"]
        motion = platform.get("motion", "rigid")
        self.motion = motion
        self.is_point = motion == "point-mass"
        # Components of the motion in MoorPy, which knows no other planes.
        self.components = {
            "rigid": [0, 1, 2, 3, 4, 5], "point-mass": [0, 1, 2], "planar-xy": [0, 1, 5], "planar-xz": [0, 2, 4], "planar-yz": [1, 2, 3],
        }.get(motion)  # fmt: skip
        self.mass = platform["mass_kg"]
        self.center = np.array(platform.get("center_of_mass_m", [0.0, 0.0, 0.0]))
        self.position = np.array(self.statics["pose"]["position_m"])
        self.rotation = rotation_of(self.statics["pose"]["quaternion_wxyz"])
        cables = self.file["cables"]
        drives = self.drives = [row.get("drive", {}) for row in self.statics["cables"]]
        self.anchors = np.array([drive.get("exit_m", cable["anchor_m"]) for drive, cable in zip(drives, cables)])
        self.attachments = np.array([cable.get("attachment_m", [0.0, 0.0, 0.0]) for cable in cables])
        self.ropes = [self.file["materials"][cable["material"]] for cable in cables]
        rows = self.statics["cables"]
        self.lengths = [row["unstrained_length_m"] for row in rows]
        self.tensions = np.array([[row["tension_platform_n"], row["tension_anchor_n"]] for row in rows])
        of = dict(option[2:].split("=") for option in self.options)
        force, point, moment = (
            np.array([float(x) for x in of.get(key, "0,0,0").split(",")]) for key in ("force-n", "load-point-m", "moment-n-m")
        )
        self.wrench = np.concatenate([force, np.cross(self.rotation @ point, force) + moment])

    def run(self, verb, *arguments):
        done = subprocess.run([self.program, verb, self.path, *self.options, *arguments], capture_output=True, text=True)
        if done.returncode != 0:
            raise SystemExit(f"{self.path}: {verb} {' '.join(arguments)}: {done.stderr}")
        return done.stdout

    def export(self, program, path, *arguments):
        self.run("export", "--to", program, "-o", str(path), *arguments)

    def moved(self, position, rotation):
        """Largest distance of an attachment from its position in funicular [m]."""
        ours = self.position + self.attachments @ self.rotation.T
        return np.linalg.norm(position + self.attachments @ rotation.T - ours, axis=1).max()

    def off(self, tensions):
        return np.abs(np.array(tensions) - self.tensions).max() / self.tensions.max()


def rotation_of(quaternion):
    """Matrix of a unit quaternion w, x, y, z."""
    w, x, y, z = quaternion
    return np.array([
        [1 - 2 * (y * y + z * z), 2 * (x * y - w * z), 2 * (x * z + w * y)],
        [2 * (x * y + w * z), 1 - 2 * (x * x + z * z), 2 * (y * z - w * x)],
        [2 * (x * z - w * y), 2 * (y * z + w * x), 1 - 2 * (x * x + y * y)],
    ])  # fmt: skip


def driven(text, file):
    """Leads every cable of a robot with lengths over a pulley to a winch that yields, 3 m from the pulley."""
    for cable in file["cables"]:
        length = cable["unstrained_length_m"]
        # The arc is about twice the radius.
        text = text.replace(f"unstrained_length_m = {length}", f"unstrained_length_m = {length + 3.1}")
    text = text.replace("[[cables]]", '[[cables]]\npulley = "wheel"\nwinch = "drum"')
    return text + (
        "\n[pulleys.wheel]\nradius_m = 0.05\nentry_direction = [0, 0, 1]\n"
        "\n[winches.drum]\ndrum_side_length_m = 3.0\nstiffness_n_per_m = 50e3\n"
    )


def tilted(file):
    """Rotates a planar robot into a plane that is not a coordinate plane; gravity stays."""
    a, b = 0.4, -0.7
    turn = np.array([[1, 0, 0], [0, math.cos(a), -math.sin(a)], [0, math.sin(a), math.cos(a)]]) @ np.array([
        [math.cos(b), 0, math.sin(b)], [0, 1, 0], [-math.sin(b), 0, math.cos(b)],
    ])  # fmt: skip

    def turned(vector):
        return (turn @ vector).tolist()

    def table(values):
        return "".join(f"{key} = {json.dumps(value)}\n" for key, value in values.items())

    assert file["platform"]["motion"] == "planar-xy" and not any(file["platform"]["center_of_mass_m"])
    platform = file["platform"] | {"motion": "planar", "plane_normal": turned([0, 0, 1])}
    text = f'name = "tilted"\n[platform]\n{table(platform)}'
    text += "".join(f"[materials.{name}]\n{table(rope)}" for name, rope in file["materials"].items())
    for cable in file["cables"]:
        ends = {key: turned(cable[key]) for key in ("anchor_m", "attachment_m")}
        text += f"[[cables]]\n{table(cable | ends)}"
    return text


def axial_stiffness(rope):
    if "axial_stiffness_n" in rope:
        return rope["axial_stiffness_n"]
    return rope["youngs_modulus_pa"] * (rope.get("area_m2") or math.pi * rope["diameter_m"] ** 2 / 4)


@contextlib.contextmanager
def quiet():
    """Suppresses the output of a program, whose C code does not write through sys.stdout."""
    sys.stdout.flush()
    kept = [os.dup(1), os.dup(2)]
    with tempfile.TemporaryFile() as sink:
        os.dup2(sink.fileno(), 1)
        os.dup2(sink.fileno(), 2)
        try:
            yield
        except BaseException:
            sink.seek(0)
            os.write(kept[1], sink.read()[-3000:])
            raise
        finally:
            sys.stdout.flush()
            os.dup2(kept[0], 1)
            os.dup2(kept[1], 2)
            os.close(kept[0])
            os.close(kept[1])


def check_moorpy(robot, table):
    """Compares the statics of the robot file, from a start near funicular's pose."""
    with quiet():
        # In air, with the seabed far below. MoorPy's default tolerance of 0.05 m stops far from equilibrium.
        system = moorpy.System(depth=1e4, rho=0, g=9.81)
        start = robot.position + [0.01 * sign if k in robot.components else 0.0 for k, sign in enumerate((1, -1, 1))]
        roll, pitch, yaw = (math.radians(angle) for angle in robot.statics["pose"]["roll_pitch_yaw_deg"])
        if robot.is_point:
            system.addPoint(0, start, m=robot.mass, v=0, fExt=robot.wrench[:3])
        else:
            pose = np.array([*start, roll, pitch, yaw])
            # The wrench at funicular's pose, because MoorPy does not rotate it with the body.
            system.addBody(0, pose, m=robot.mass, v=0, rCG=robot.center, f6Ext=robot.wrench, DOFs=robot.components)
        for i, (rope, length) in enumerate(zip(robot.ropes, robot.lengths)):
            name = f"rope{i}"
            system.lineTypes[name] = {
                "name": name, "d_vol": 0.001, "m": rope["mass_kg_per_m"], "w": rope["mass_kg_per_m"] * 9.81,
                "EA": axial_stiffness(rope), "input_d": 0.001, "input_type": "rope",
            }  # fmt: skip
            if robot.is_point:
                end = 1
            else:
                system.addPoint(1, start + robot.rotation @ robot.attachments[i])
                end = len(system.pointList)
                system.bodyList[0].attachPoint(end, robot.attachments[i])
            system.addPoint(1, robot.anchors[i])
            system.addLine(length, name, pointA=end, pointB=len(system.pointList))
        system.initialize()
        system.solveEquilibrium(tol=1e-8, maxIter=1000)
        ends = [[line.TA, line.TB] for line in system.lineList]
        if robot.is_point:
            moved = np.linalg.norm(system.pointList[0].r - robot.position)
        else:
            points = np.array([system.pointList[2 * i].r for i in range(len(robot.lengths))])
            moved = np.linalg.norm(points - robot.position - robot.attachments @ robot.rotation.T, axis=1).max()
    table.row(robot.name, "MoorPy", "position of the attachments [m]", moved, POSITION_M)
    table.row(robot.name, "MoorPy", "tensions / maximum tension", robot.off(ends), TENSION_RATIO)


class Chains:
    """Results of OpenSees for chains with a number of bars."""

    def __init__(self, robot, folder, bars):
        path = folder / f"{bars}.py"
        robot.export("opensees", path, "--segments", str(bars))
        with quiet(), contextlib.redirect_stdout(io.StringIO()):
            done = runpy.run_path(str(path))
        result = done["result"]
        x, y, z = result["rotation_rad"]
        cross = np.array([[0, -z, y], [z, 0, -x], [-y, x, 0]])
        self.bars = bars
        self.moved = robot.moved(np.array(result["position_m"]), (np.eye(3) + cross) @ robot.rotation)
        # Differences relative to funicular's maximum tension, and to funicular's frequencies.
        self.tensions = (np.array(result["tensions_n"]) - robot.tensions).T / robot.tensions.max()
        self.frequencies = np.array(result["frequencies_hz"]) / np.array(done["FREQUENCIES_HZ"]) - 1.0


def check_opensees(robot, folder, table):
    """Compares statics and first frequencies, with limits from the results with half as many bars."""
    meshes = [Chains(robot, folder, bars) for bars in (BARS // 2, BARS, 2 * BARS)]
    for coarse, fine in zip(meshes, meshes[1:]):
        name = f"OpenSees, {fine.bars} bars"
        table.row(robot.name, name, "position of the attachments [m]", fine.moved, POSITION_M)
        table.row(robot.name, name, "tensions at the platform / maximum tension", np.abs(fine.tensions[0]).max(), TENSION_RATIO)
        for what, ours, before, floor in (
            ("tensions at the anchors / maximum tension", fine.tensions[1], coarse.tensions[1], TENSION_RATIO),
            (f"first {len(fine.frequencies)} frequencies, relative", fine.frequencies, coarse.frequencies, FLOOR_RATIO),
        ):
            error = np.abs(ours - before).max() / 3.0
            table.row(robot.name, name, what, np.abs(ours).max(), floor + MARGIN * error)
    left = fine.frequencies + (fine.frequencies - coarse.frequencies) / 3.0
    table.row(robot.name, "OpenSees, no mesh", "frequencies, extrapolated, relative", np.abs(left).max(), FLOOR_RATIO + EXTRAPOLATED * error)


def check_moordyn(robot, folder, table, seconds, segments):
    """Compares the equilibrium: the mean of the remaining motion, weighted so that waves cancel out.

    MoorDyn starts with catenaries, which differ from its chains, so the chains vibrate. Undamped axial waves add tension
    and move the mean by up to 4e-5 m (yuan2014-8mm), so the segments get half of their critical damping. Transverse waves
    hardly decay (a shift of 1.5e-6 m after 60 s, 1.2e-6 m after 90 s). Their square moves the mean: twice as many segments
    reduce it to a sixteenth.
    """
    path = folder / "moordyn.txt"
    robot.export("moordyn", path, "--segments", str(segments))
    text, types = re.subn(r"^(\S+_\d+ +\S+ +\S+ +\S+ +)0 ", r"\1-0.5 ", path.read_text(), flags=re.MULTILINE)
    assert types == len(robot.lengths), "every line type is damped"
    path.write_text(text)
    with quiet():
        system = moordyn.Create(str(path))
        moordyn.Init(system, [], [])
        count = int(seconds / 0.02)
        record = []
        for k in range(count):
            moordyn.Step(system, [], [], k * 0.02, 0.02)
            if robot.is_point:
                record.append(moordyn.GetPointPos(moordyn.GetPoint(system, len(robot.lengths) + 1)))
            else:
                points = [moordyn.GetPoint(system, len(robot.lengths) + 1 + i) for i in range(len(robot.lengths))]
                record.append([moordyn.GetPointPos(point) for point in points])
        moordyn.Close(system)
    late = np.array(record[count // 2 :])
    window = np.hanning(len(late))
    mean = np.tensordot(window, late, 1) / window.sum()
    ours = robot.position if robot.is_point else robot.position + robot.attachments @ robot.rotation.T
    moved = np.linalg.norm(np.atleast_2d(mean - ours), axis=1).max()
    table.row(robot.name, f"MoorDyn, {seconds:g} s", "mean position of the attachments [m]", moved, POSITION_M)


def check_scenario(robot, folder, table, name, seconds, scenario, limit):
    """Compares the tensions of a motion with those of `simulate`, both with the same loss of the stretch and no other.

    The difference is the error of MoorDyn's segments, which falls with the square of their length: `simulate` has three elements
    of degree eight in each rope. A release and a cut send steps of tension along the ropes, and chains of segments carry short
    waves too slowly, so that their difference falls less: twice as many segments leave half of it or more instead of a quarter.
    """
    path = folder / f"{name}.toml"
    path.write_text(scenario)
    options = ["--scenario", str(path), "--for", str(seconds)]
    for value in ("damping_ratio=0", "axial_damping_time_s=1e-4"):
        options += ["--set", f"materials.rope-4mm.{value}"]
    found = folder / f"{name}.csv"
    robot.run("simulate", *options, "--once", "-o", str(found))
    ours = columns_of(found)
    tensions = [column for column in ours if column.startswith("tension_")]
    size = rms([ours[column] for column in tensions])
    off = []
    for segments in (BARS, 2 * BARS):
        script = folder / f"{name}.py"
        robot.export("moordyn", script, *options, "--segments", str(segments))
        done = subprocess.run([sys.executable, str(script)], capture_output=True, text=True)
        if done.returncode != 0:
            raise SystemExit(f"{script}: {done.stderr}")
        theirs = columns_of(script.with_suffix(".moordyn.csv"))
        assert np.allclose(theirs["t_s"], ours["t_s"][1:], atol=1e-9), "the same times"
        off.append(rms([theirs[column] - ours[column][1:] for column in tensions]) / size)
    table.row(robot.name, f"MoorDyn, {2 * BARS} segments", f"tensions of a {name} / their r.m.s.", off[1], limit)
    table.row(robot.name, "MoorDyn", f"tensions of a {name}, {2 * BARS} over {BARS} segments", off[1] / off[0], HALVED)


def columns_of(path):
    """Columns of a CSV file by their names."""
    with path.open(newline="") as file:
        names, *rows = csv.reader(file)
    return dict(zip(names, np.array(rows, dtype=float).T))


def rms(values):
    return np.sqrt(np.mean(np.square(values)))


class Simulated:
    """A robot in MuJoCo."""

    def __init__(self, robot, folder, *options):
        path = folder / "mujoco.xml"
        robot.export("mujoco", path, *options)
        self.model = mujoco.MjModel.from_xml_path(str(path))
        self.data = mujoco.MjData(self.model)
        mujoco.mj_resetDataKeyframe(self.model, self.data, self.model.key("rest").id)
        mujoco.mj_forward(self.model, self.data)
        self.cables = len(robot.lengths)
        # Coordinates of the platform, without the swivels of pulleys.
        body = self.model.body("platform").id
        self.dofs = np.flatnonzero(self.model.dof_bodyid == body)

    def forces(self, step):
        """Generalised forces after a small step of the coordinates from the present state."""
        data = mujoco.MjData(self.model)
        data.qpos[:] = self.data.qpos
        data.ctrl[:] = self.data.ctrl
        mujoco.mj_integratePos(self.model, data.qpos, step, 1.0)
        mujoco.mj_forward(self.model, data)
        return data.qfrc_actuator + data.qfrc_passive - data.qfrc_bias

    def modes(self):
        """Natural frequencies at the present state [Hz], by the difference quotients of the forces; true for the platform's."""
        count = self.model.nv
        mass = np.zeros((count, count))
        mujoco.mj_fullM(self.model, self.data, mass)
        step = 1e-6 * np.eye(count)
        stiffness = -np.array([(self.forces(row) - self.forces(-row)) / 2e-6 for row in step]).T
        squares, shapes = np.linalg.eig(np.linalg.solve(mass, 0.5 * (stiffness + stiffness.T)))
        # Modes of the platform: most of their kinetic energy is in its coordinates.
        energies = (shapes * (mass @ shapes)).real
        of_platform = energies[self.dofs].sum(axis=0) > 0.5 * energies.sum(axis=0)
        order = np.argsort(squares.real)
        return np.sqrt(squares.real[order].clip(0)) / (2 * math.pi), of_platform[order]

    def frequencies(self):
        """Natural frequencies of the platform at the present state [Hz]."""
        found, of_platform = self.modes()
        return found[of_platform]

    def settle(self, slowest_hz):
        """Simulates with enough damping until nothing moves any more; `slowest_hz` is the lowest frequency at rest."""
        # Beside the rest a cable may be slack, and a motion without stiffness.
        rate = 2 * math.pi * max(self.frequencies().min(), 0.3 * slowest_hz)
        mass = np.zeros((self.model.nv, self.model.nv))
        mujoco.mj_fullM(self.model, self.data, mass)
        # Everything but the swivels of pulleys, which have their own.
        moving = [i for i, body in enumerate(self.model.dof_bodyid) if not self.model.body(body).name.startswith("pulley:")]
        self.model.dof_damping[moving] = 2 * rate * np.diag(mass)[moving]
        # What is left to move is about the speed over the rate of the decay.
        for _ in range(MAX_TIMES):
            for _ in range(int(10.0 / rate / self.model.opt.timestep)):
                mujoco.mj_step(self.model, self.data)
            if np.abs(self.data.qvel).max() < 0.01 * POSITION_M * rate:
                break

    def tensions(self):
        return np.array([-self.data.sensor(f"tension:{self.model.tendon(i).name}").data[0] for i in range(self.cables)])

    def command(self, changes):
        """Commands changes of the unstrained lengths [m], with the stiffness of the new lengths."""
        for i, change in enumerate(changes):
            stiffness, axial = self.model.actuator_gainprm[i, 0], -self.model.actuator_forcerange[i, 0]
            rest = self.model.actuator_biasprm[i, 0] / stiffness
            stiffness = 1.0 / (1.0 / stiffness + change / axial)
            self.model.actuator_gainprm[i, 0] = stiffness
            self.model.actuator_biasprm[i, :2] = stiffness * rest, -stiffness
            self.data.ctrl[i] = change


def check_mujoco(robot, folder, table):
    """Compares rest, tensions, frequencies and a commanded length with straight springs, simulated from beside the rest."""
    told = json.loads(robot.run("statics", "--static-model", "spring", "--format", "json"))
    try:
        simulated = Simulated(robot, folder)
    except ValueError as error:
        raise SystemExit(f"{robot.name}: MuJoCo refuses the model: {error}") from error
    pose = np.array(told["pose"]["position_m"]), rotation_of(told["pose"]["quaternion_wxyz"])

    # Stiffness across a tensioned cable is in MuJoCo, and not in the cable model `spring`.
    modes = ["modes", "--static-model", "spring", "--cable-model", "catenary-static", "--format", "json"]
    theirs = simulated.frequencies()
    listed = json.loads(robot.run(*modes, "--below-hz", str(2 * theirs.max())))["modes"]
    ours = np.array([mode["frequency_hz"] for mode in listed])
    count = len(theirs) if len(ours) == len(theirs) else 0
    off = np.abs(theirs[:count] / ours[:count] - 1.0).max() if count else math.inf
    # Flexible supports are fixed where they are at rest, and the file says so: only the rest is that of the robot.
    supported = "supports" in robot.file
    if not supported:
        table.row(robot.name, "MuJoCo", f"{len(theirs)} frequencies of the platform, relative", off, STIFFNESS_RATIO)

    # The tensions at rest as commands, with the springs switched off.
    held = mujoco.MjData(simulated.model)
    mujoco.mj_resetDataKeyframe(simulated.model, held, simulated.model.key("forces").id)
    simulated.model.opt.disableactuator = 1 << 1
    mujoco.mj_forward(simulated.model, held)
    simulated.model.opt.disableactuator = 0
    off = np.abs(held.qacc[simulated.dofs]).max()
    table.row(robot.name, "MuJoCo", "acceleration under commanded tensions [m/s2, rad/s2]", off, 1e-6)

    start = np.zeros(simulated.model.nv)
    start[simulated.dofs] = 1e-3 * (-1.0) ** np.arange(len(simulated.dofs))
    mujoco.mj_integratePos(simulated.model, simulated.data.qpos, start, 1.0)
    simulated.settle(theirs.min())
    moved = between(robot, simulated, *pose)
    table.row(robot.name, "MuJoCo", "position of the attachments [m]", moved, POSITION_M)
    rows = told["cables"]
    tensions = np.array([row["tension_platform_n"] for row in rows])
    table.row(robot.name, "MuJoCo", "tensions / maximum tension", np.abs(simulated.tensions() - tensions).max() / tensions.max(), TENSION_RATIO)

    # The lengths of a pose beside the rest, as a command. Fewer cables than coordinates reach another one near it.
    shift = 0.005 * np.linalg.norm(robot.anchors - pose[0], axis=1).mean()
    target = pose[0] + shift * np.array(SHIFTS.get(robot.motion, (0.6, -0.48, 0.64)))
    angles = ",".join(str(angle) for angle in told["pose"]["roll_pitch_yaw_deg"])
    place = ",".join(str(x) for x in target) + ("" if robot.is_point else f",{angles}")
    if robot.motion == "planar" or supported:
        return
    commanded = json.loads(robot.run("statics", "--static-model", "spring", f"--pose={place}", "--format", "json"))
    pairs = zip(commanded["cables"], rows, strict=True)
    simulated.command([new["unstrained_length_m"] - old["unstrained_length_m"] for new, old in pairs])
    simulated.settle(theirs.min())
    reached = np.array(commanded["pose"]["position_m"]), rotation_of(commanded["pose"]["quaternion_wxyz"])
    moved = between(robot, simulated, *reached)
    table.row(robot.name, "MuJoCo", f"position after a command over {shift:.3f} m [m]", moved, POSITION_M)


def check_chains(robot, folder, table):
    """Compares cables as chains in MuJoCo with the sagging cables of `statics` and `modes`: each error falls with the pieces."""
    cables = robot.file["cables"]
    pose = robot.position, robot.rotation
    # The first modes, up to the first one that is not of the cables alone.
    upper, of_cables = 1.0, np.ones(1, bool)
    while len(of_cables) < FIRST_MODES or of_cables.all():
        listed = json.loads(robot.run("modes", "--below-hz", str(upper), "--format", "json"))["modes"]
        of_cables = np.array([mode["kind"] == "cable" for mode in listed])
        upper *= 2
    count = max(FIRST_MODES, int(of_cables.argmin()) + 1)
    ours = np.array([mode["frequency_hz"] for mode in listed[:count]])
    middles = middles_of(robot, folder)

    for pieces in PIECES:
        name = f"MuJoCo, {pieces} pieces"
        simulated = Simulated(robot, folder, "--cable-pieces", str(pieces))
        data, model = simulated.data, simulated.model
        pulls = np.array([np.linalg.norm(data.sensor(f"pull:{cable['name']}").data) for cable in cables])
        table.row(robot.name, name, "tensions at the platform / maximum tension", np.abs(pulls - robot.tensions[:, 0]).max() / robot.tensions.max(), TENSION_RATIO)
        weights = [9.81 * rope["mass_kg_per_m"] * row["unstrained_length_m"] / pieces for rope, row in zip(robot.ropes, robot.statics["cables"])]
        off = np.abs(simulated.tensions() - robot.tensions[:, 1]) / (0.5 * np.array(weights))
        table.row(robot.name, name, "tensions at the anchor / weight of half a piece", off.max(), 1.0)

        nodes = np.array([data.body(f"cable:{cable['name']}:{pieces // 2 + 1}").xpos for cable in cables])
        chords = 0.5 * (robot.anchors + robot.position + robot.attachments @ robot.rotation.T)
        sags = np.linalg.norm(middles - chords, axis=1)
        off = np.linalg.norm(nodes - middles, axis=1).max() / sags.max()
        table.row(robot.name, name, "middles of the cables / sag", off, CHAIN_SAG / pieces**2)

        theirs, _ = simulated.modes()
        off = np.abs(theirs[:count] / ours - 1.0).max()
        table.row(robot.name, name, f"first {count} frequencies, relative", off, CHAIN_FREQUENCY / pieces**2)

        for _ in range(int(1.0 / model.opt.timestep)):
            mujoco.mj_step(model, data)
        table.row(robot.name, name, "position after 1 s without a command [m]", between(robot, simulated, *pose), POSITION_M)
        # The lengths of a planar robot's pose are those of its lowest tensions, at which it hardly comes to rest.
        if pieces == PIECES[1] and not robot.motion.startswith("planar"):
            check_chained_command(robot, simulated, table, name, theirs[0])


def check_chained_command(robot, simulated, table, name, slowest_hz):
    """Compares the place that chains reach after commanded lengths with `statics` of sagging cables."""
    shift = 0.005 * np.linalg.norm(robot.anchors - robot.position, axis=1).mean()
    target = robot.position + shift * np.array(SHIFTS.get(robot.motion, (0.6, -0.48, 0.64)))
    angles = ",".join(str(angle) for angle in robot.statics["pose"]["roll_pitch_yaw_deg"])
    place = ",".join(str(x) for x in target) + ("" if robot.is_point else f",{angles}")
    commanded = json.loads(robot.run("statics", f"--pose={place}", "--format", "json"))
    simulated.command([new["unstrained_length_m"] - old for new, old in zip(commanded["cables"], robot.lengths, strict=True)])
    simulated.settle(slowest_hz)
    reached = np.array(commanded["pose"]["position_m"]), rotation_of(commanded["pose"]["quaternion_wxyz"])
    table.row(robot.name, name, f"place after a command over {shift:.3f} m / way", between(robot, simulated, *reached) / shift, CHAIN_COMMAND)


def middles_of(robot, folder):
    """Points in the middle of the free part of every rope, from the exported curves [m]."""
    path = folder / "middles.vtp"
    robot.export("vtk", path, "--segments", "2")
    reader = vtk.vtkXMLPolyDataReader()
    reader.SetFileName(str(path))
    reader.Update()
    return vtk_to_numpy(reader.GetOutput().GetPoints().GetData())[1 : 3 * len(robot.lengths) : 3]


def check_links(robot, folder, table):
    """Compares the world of Gazebo, read and computed by Drake, and the robot for viewers with straight springs."""
    told = json.loads(robot.run("statics", "--static-model", "spring", "--format", "json"))
    position, rotation = np.array(told["pose"]["position_m"]), rotation_of(told["pose"]["quaternion_wxyz"])
    attachments = position + robot.attachments @ rotation.T

    path = folder / "robot.urdf"
    robot.export("urdf", path)
    read = yourdfpy.URDF.load(str(path), load_meshes=False)
    links = [name for name in read.link_map if name.startswith("attachment_")]
    places = [read.get_transform(name, "frame")[:3, 3] for name in links]
    table.row(robot.name, "yourdfpy, URDF", "position of the attachments [m]", np.abs(places - attachments).max(), 1e-9)
    moved = abs(read.link_map["platform"].inertial.mass / robot.mass - 1.0) + len(set(read.link_map)) - 2 - 2 * len(places)
    table.row(robot.name, "yourdfpy, URDF", "mass and number of links", abs(moved), 1e-12)

    path = folder / "robot.sdf"
    path.unlink(missing_ok=True)
    if robot.motion.startswith("planar"):
        done = subprocess.run([robot.program, "export", robot.path, "--to", "sdf", "-o", path], capture_output=True, text=True)
        table.row(robot.name, "Drake, SDF", "planar platform: refused", abs(done.returncode - 2) + path.exists(), 0)
        return
    robot.export("sdf", path)
    plant = MultibodyPlant(0.0)
    Parser(plant).AddModels(str(path))
    plant.mutable_gravity_field().set_gravity_vector(robot.file.get("gravity_m_s2", [0.0, 0.0, -9.81]))
    plant.Finalize()
    context = plant.CreateDefaultContext()
    pose = plant.EvalBodyPoseInWorld(context, plant.GetBodyByName("platform"))
    theirs = pose.translation() + robot.attachments @ pose.rotation().matrix().T
    table.row(robot.name, "Drake, SDF", "position of the attachments [m]", np.abs(theirs - attachments).max(), 1e-9)
    springs = [plant.get_force_element(index) for index in map(ForceElementIndex, range(1, plant.num_force_elements()))]
    ends = zip(springs, attachments, told["cables"], strict=True)
    pulls = [of.stiffness() * (np.linalg.norm(end - of.p_AP()) - of.free_length()) for of, end, _ in ends]
    tensions = np.array([row["tension_platform_n"] for row in told["cables"]])
    table.row(robot.name, "Drake, SDF", "tensions / maximum tension", np.abs(pulls - tensions).max() / tensions.max(), TENSION_RATIO)
    # A load is not in the file.
    if not robot.wrench.any():
        acceleration = plant.get_generalized_acceleration_output_port().Eval(context)
        table.row(robot.name, "Drake, SDF", "acceleration at rest [m/s2, rad/s2]", np.abs(acceleration).max(), 1e-6)


# Directions in the plane of a planar robot.
SHIFTS = {"planar-xy": (0.6, 0.8, 0.0), "planar-xz": (0.6, 0.0, 0.8), "planar-yz": (0.0, 0.6, 0.8)}


def between(robot, simulated, position, rotation):
    """Largest distance of an attachment in MuJoCo from that at a pose [m]."""
    body = simulated.data.body("platform")
    theirs = body.xpos + robot.attachments @ body.xmat.reshape(3, 3).T
    return np.linalg.norm(theirs - position - robot.attachments @ rotation.T, axis=1).max()


# Models for units: options of `reduce`, and whether the inputs are lengths.
UNITS = {
    "yuan2014-4mm": ["--below-hz", "5", "--input", "fz", "--input", "mx", "--output", "z", "--output", "az", "--tolerance", "0.02"],
    "cogiro-winches": ["--below-hz", "4", "--input", "length:1", "--output", "z", "--output", "tension:1", "--tolerance", "0.02"],
    "kntu-planar": ["--below-hz", "30", "--input", "motion", "--output", "x", "--output", "vx", "--tolerance", "0.02"],
}


def check_fmu(robot, folder, table):
    """Compares a Functional Mock-up Unit, which FMPy runs, with the matrices, with python-control and with `frf`."""
    signals = [option.replace("motion", "base-x") for option in UNITS[robot.name]]
    path = folder / "model.fmu"
    robot.run("reduce", *signals, "--to", "fmu", "-o", str(path))
    told = json.loads(robot.run("reduce", *signals, "--format", "json"))
    given = [np.array(told[key]) for key in "abcd"]
    inputs, outputs, states = len(told["inputs"]), len(told["outputs"]), told["order"]

    description = fmpy.read_model_description(str(path), validate=True)
    names = [of["name"] for of in told["inputs"] + told["outputs"]]
    listed = [of.name for of in description.modelVariables[: inputs + outputs]]
    table.row(robot.name, "FMPy", "names of signals that differ", sum(a != b for a, b in zip(names, listed, strict=True)), 0)
    unpacked = fmpy.extract(str(path))
    robot_file = tomllib.loads((Path(unpacked) / "resources/robot.toml").read_text())
    table.row(robot.name, "FMPy", "robot file in the unit differs", int(robot_file != robot.file), 0)

    unit = fmi2.FMU2Slave(guid=description.guid, unzipDirectory=unpacked, modelIdentifier=description.coSimulation.modelIdentifier)
    unit.instantiate()
    unit.setupExperiment(startTime=0.0)
    unit.enterInitializationMode()
    unit.exitInitializationMode()
    known = [*range(inputs + outputs, inputs + outputs + states), *range(inputs)]
    unknown = [*range(inputs + outputs + states, inputs + outputs + 2 * states), *range(inputs, inputs + outputs)]
    columns = [unit.getDirectionalDerivative(unknown, [of], [1.0]) for of in known]
    jacobian, expected = np.array(columns).T, np.block([[given[0], given[1]], [given[2], given[3]]])
    table.row(robot.name, "FMPy", "matrices by directional derivatives", np.abs(jacobian - expected).max(), 0.0)

    a, b = jacobian[:states, :states], jacobian[:states, states:]
    c, d = jacobian[states:, :states], jacobian[states:, states:]
    top = float(told["below_hz"])
    options = [x for x in signals if x not in ("--below-hz", signals[1], "--tolerance", signals[-1])]
    response = ["frf", *options, "--from-hz", str(0.02 * top), "--to-hz", str(top), "--points", "300", "--format", "json"]
    found = json.loads(robot.run(*response))
    worst = 0.0
    peaks = {(of["input"], of["output"]): of["peak"] for of in told["responses"] if of["coupled"]}
    for pair in found.get("responses", [found]):
        place = [of["name"] for of in told["outputs"]].index(pair["output"]), [of["name"] for of in told["inputs"]].index(pair["input"])
        if (pair["input"], pair["output"]) in peaks:
            omega = 2j * np.pi * np.array(found["frequency_hz"])
            ours = np.array([(c @ np.linalg.solve(w * np.eye(states) - a, b) + d)[place] for w in omega])
            off = np.abs(ours - np.array(pair["real"]) - 1j * np.array(pair["imag"])).max()
            worst = max(worst, off / peaks[pair["input"], pair["output"]])
    table.row(robot.name, "FMPy", "responses against frf / peak", worst, told["error"] * 1.001)

    # Steps with a changing input, which is constant within a step.
    step = 1.0 / (20.0 * top)
    values = np.sin(np.outer(np.arange(1, inputs + 1), np.arange(200)) * 0.1)
    digital = control.sample_system(control.ss(*given), step, method="zoh")
    theirs = control.forced_response(digital, np.arange(200) * step, values, squeeze=False).outputs
    ours = []
    for k in range(200):
        unit.setReal(list(range(inputs)), values[:, k].tolist())
        ours.append(unit.getReal(list(range(inputs, inputs + outputs))))
        unit.doStep(currentCommunicationPoint=k * step, communicationStepSize=step)
    unit.terminate()
    unit.freeInstance()
    scale = np.abs(theirs).max(axis=1, keepdims=True)
    off = (np.abs(np.array(ours).T - theirs) / scale).max()
    table.row(robot.name, "FMPy, co-simulation", "outputs against python-control / maximum", off, 1e-9)

    # All inputs one from the start, because FMPy holds inputs over its steps; integrated by CVode.
    times = np.linspace(0.0, 4.0 / top, 400)
    signal = np.ones(2, dtype=[("time", float), *((of["name"], float) for of in told["inputs"])])
    signal["time"] = [0.0, times[-1]]
    written = [of.name for of in description.modelVariables[inputs : inputs + outputs]]
    result = fmpy.simulate_fmu(
        str(path), fmi_type="ModelExchange", solver="CVode", relative_tolerance=1e-11, input=signal, stop_time=times[-1],
        output_interval=times[1], output=written,
    )  # fmt: skip
    exact = control.sample_system(control.ss(*given), times[1], method="zoh")
    theirs = control.forced_response(exact, times, np.ones((inputs, len(times))), squeeze=False).outputs
    assert np.allclose(result["time"], times, rtol=1e-9)
    ours = np.array([result[name] for name in written])
    off = (np.abs(ours - theirs) / np.abs(theirs).max(axis=1, keepdims=True)).max()
    table.row(robot.name, "FMPy, model exchange", "outputs against python-control / maximum", off, 1e-6)

    # A step of a usual size of each input alone, with the importer's default settings, over twenty periods.
    sizes = {"m": 1e-3, "rad": 1e-3, "N": 10.0, "N m": 10.0}
    times = np.linspace(0.0, 20.0 / top, 2000)
    exact = control.sample_system(control.ss(*given), times[1], method="zoh")
    for place, of in enumerate(told["inputs"]):
        steps = np.zeros((inputs, len(times)))
        steps[place] = sizes[of["unit"]]
        signal = np.zeros(2, dtype=signal.dtype)
        signal["time"] = [0.0, times[-1]]
        signal[of["name"]] = sizes[of["unit"]]
        result = fmpy.simulate_fmu(
            str(path), fmi_type="ModelExchange", input=signal, stop_time=times[-1], output_interval=times[1], output=written
        )  # fmt: skip
        theirs = control.forced_response(exact, times, steps, squeeze=False).outputs
        size = np.abs(theirs).max(axis=1, keepdims=True)
        off = (np.abs(np.array([result[name] for name in written]) - theirs)[size[:, 0] > 0] / size[size[:, 0] > 0]).max()
        table.row(robot.name, "FMPy, model exchange", f"a step of {of['name']} by default settings / maximum", off, 0.01)


# Motion that a unit repeats: a push, and a winch that runs.
UNIT_MOTION = """
[[push]]
at_s = 0.02
duration_s = 0.1
force_n = [0.0, 4.0, 3.0]
point_m = [0.0, 0.0, 0.0]

[[lengths]]
at_s = 0.0
duration_s = 0.15
change_m = {"1" = -0.01}
"""


def check_motion_unit(robot, folder, table):
    """Compares units of the robot in motion, which FMPy runs, with `simulate` within its stated error."""
    scenario = folder / "unit.toml"
    scenario.write_text(UNIT_MOTION)
    run = ["--scenario", str(scenario), "--duration-s", "0.2", "--sample-time-s", "0.001", "--format", "json"]
    told = json.loads(robot.run("simulate", *run))
    bounds = {row["column"]: row["largest"] for row in told["errors"]}
    rows, cables = told["rows"], told["cables"]
    histories = []
    for form, version in (("fmu", fmi2), ("fmu3", fmi3)):
        path = folder / f"motion-{form}.fmu"
        robot.export(form, path)
        description = fmpy.read_model_description(str(path), validate=True)
        variables = {of.name: of for of in description.modelVariables}
        units = {"m": "_m", "m/s": "_m_s", "N": "_n", "N.m": "_n_m", "rad/s": "_rad_s", "J": "_j"}
        astray = [of for of in variables.values() if not of.name.endswith(units.get(of.unit, ""))]
        table.row(robot.name, f"FMPy, {form}", "names whose unit is another one", len(astray), 0)

        slave = version.FMU2Slave if version is fmi2 else version.FMU3Slave
        identifier = description.coSimulation.modelIdentifier
        unit = slave(guid=description.guid, unzipDirectory=fmpy.extract(str(path)), modelIdentifier=identifier)
        unit.instantiate()
        if version is fmi2:
            unit.setupExperiment(startTime=0.0)
            get, put = unit.getReal, unit.setReal
            keep, take, forget = unit.getFMUstate, unit.setFMUstate, unit.freeFMUstate
            pack, unpack = unit.serializeFMUstate, unit.deSerializeFMUstate
        else:
            get, put = unit.getFloat64, unit.setFloat64
            keep, take, forget = unit.getFMUState, unit.setFMUState, unit.freeFMUState
            pack, unpack = unit.serializeFMUState, unit.deserializeFMUState
        unit.enterInitializationMode()
        unit.exitInitializationMode()
        place = ["x_m", "y_m", "z_m"]
        wanted = [*place, *(f"tension_platform_{cable}_n" for cable in cables)]
        outputs = [variables[name].valueReference for name in wanted]

        def advance(k):
            now = rows[k]
            is_pushed = 0.02 - 1e-9 < rows[k - 1]["t_s"] < 0.12 - 1e-9
            given = {"force_y_n": 4.0 * is_pushed, "force_z_n": 3.0 * is_pushed}
            given |= {"length_1_m": now["unstrained_lengths_m"][0], "length_rate_1_m_s": now["length_rates_m_s"][0]}
            put([variables[name].valueReference for name in given], list(given.values()))
            unit.doStep(currentCommunicationPoint=rows[k - 1]["t_s"], communicationStepSize=now["t_s"] - rows[k - 1]["t_s"])
            return get(outputs)

        history = [get(outputs)]
        kept = None
        for k in range(1, len(rows)):
            if k == 100:
                kept = keep()
            history.append(advance(k))
        history = np.array(history)
        off = np.abs(history[:, :3] - np.array([row["position_m"] for row in rows])).max()
        table.row(robot.name, f"FMPy, {form}", "places against simulate / its stated error", off / bounds["position_m"], 1)
        worst = 0.0
        for i, cable in enumerate(cables):
            theirs = np.array([row["tensions_platform_n"][i] for row in rows])
            worst = max(worst, np.abs(history[:, 3 + i] - theirs).max() / bounds[f"tension_platform_{cable}_n"])
        table.row(robot.name, f"FMPy, {form}", "tensions against simulate / their stated errors", worst, 1)

        # A state that was kept goes on with the same bits, also by its bytes.
        again = unpack(pack(kept))
        for state in (kept, again):
            take(state)
            repeated = np.array([advance(k) for k in range(100, 120)])
            table.row(robot.name, f"FMPy, {form}", "outputs after a return to a state", np.abs(repeated - history[100:120]).max(), 0)
            forget(state)
        unit.terminate()
        unit.freeInstance()
        histories.append(history)
    table.row(robot.name, "FMPy", "outputs of versions 2.0 and 3.0", np.abs(histories[0] - histories[1]).max(), 0)


def check_vtk(robot, folder, table):
    """Compares the file read by VTK with the results of funicular."""
    path = folder / "vtk.vtp"
    modes = json.loads(robot.run("modes", "--below-hz", "4", "--format", "json"))["modes"]
    robot.export("vtk", path, "--modes-below-hz", "4", "--segments", str(BARS))
    reader = vtk.vtkXMLPolyDataReader()
    reader.SetFileName(str(path))
    reader.Update()
    shape = reader.GetOutput()
    points = vtk_to_numpy(shape.GetPoints().GetData())
    data = shape.GetPointData()
    tension = vtk_to_numpy(data.GetArray("tension_n"))
    at = np.arange(len(robot.lengths)) * (BARS + 1)
    ends = np.stack([tension[at], tension[at + BARS]], axis=1)
    off = np.linalg.norm(points[at + BARS] - robot.anchors, axis=1).max()
    table.row(robot.name, "VTK", "anchors [m]", off, 1e-12)
    table.row(robot.name, "VTK", "tensions / maximum tension", robot.off(ends), 1e-12)
    table.row(robot.name, "VTK", "cables and modes missing", abs(shape.GetNumberOfLines() - len(at)) + abs(data.GetNumberOfArrays() - 2 - len(modes)), 0)
    # The start of a cable moves with the platform; its end rests, unless it is on a wheel.
    worst = 0.0
    held = at[[i for i, drive in enumerate(robot.drives) if not drive]] + BARS
    arms = robot.attachments @ robot.rotation.T
    for i, mode in enumerate(modes):
        field = vtk_to_numpy(data.GetArray(2 + i))
        shift, turn = np.array(mode["shape"][:3]), np.array(mode["shape"][3:])
        rigid = shift + np.cross(turn, arms)
        worst = max(worst, np.abs(field[at] - rigid).max(), np.abs(field[at[-1] + BARS + 1 :] - rigid).max(), np.abs(field[held]).max(initial=0.0))
    table.row(robot.name, "VTK", "ends of cables in modes against the platform", worst, 1e-6)


def check_uff(robot, folder, table):
    """Compares the Universal Files read by pyuff with the results of funicular."""
    path = folder / "response.uff"
    request = ["--cable-model", "spring", "--from-hz", "0.5", "--to-hz", "4.5", "--points", "81", "--input", "fx"]
    request += ["--output", "ax", "--output", "x"]
    told = json.loads(robot.run("frf", *request, "--format", "json"))
    robot.run("frf", *request, "-o", str(path))
    sets = [found for found in pyuff.UFF(str(path)).read_sets() if found["type"] == 58]
    worst = abs(len(sets) - len(told["responses"]))
    for found, pair in zip(sets, told["responses"], strict=False):
        values = np.array(pair["real"]) + 1j * np.array(pair["imag"])
        worst = max(worst, np.abs(found["data"] / values - 1.0).max(), np.abs(found["x"] / told["frequency_hz"] - 1.0).max())
        worst = max(worst, abs(found["rsp_dir"] - 1), abs(found["ref_dir"] - 1))
    # Abscissae have six digits, ordinates thirteen.
    table.row(robot.name, "UFF", "responses", worst, 1e-6)

    path = folder / "modes.uff"
    modes = json.loads(robot.run("modes", "--below-hz", "4", "--format", "json"))["modes"]
    robot.run("modes", "--below-hz", "4", "-o", str(path))
    shapes = [found for found in pyuff.UFF(str(path)).read_sets() if found["type"] == 55]
    worst = abs(len(shapes) - len(modes))
    for found, mode in zip(shapes, modes, strict=False):
        # Node 1 is the origin of the platform; the file has platform axes and six digits.
        shift = robot.rotation.T @ np.array(mode["shape"][:3])
        written = np.array([found["r1"][0], found["r2"][0], found["r3"][0]])
        worst = max(worst, np.abs(written - shift).max(), abs(found["freq"] / mode["frequency_hz"] - 1.0))
    table.row(robot.name, "UFF", "mode shapes", worst, 1e-5)


def main():
    program, *options = sys.argv[1:]
    if options not in ([], ["--short"]):
        raise SystemExit(f"unknown options {options}: the only option is --short")
    table = Table()
    with tempfile.TemporaryDirectory() as name:
        folder = Path(name)
        for case in SHORT if options else ALL:
            robot = Robot(program, case, folder)
            if robot.components and not case.driven:
                check_moorpy(robot, table)
            check_opensees(robot, folder, table)
            if case.seconds:
                check_moordyn(robot, folder, table, case.seconds, case.segments)
            check_mujoco(robot, folder, table)
            if robot.name in CHAINED:
                check_chains(robot, folder, table)
            check_links(robot, folder, table)
            if robot.name in UNITS:
                check_fmu(robot, folder, table)
                check_motion_unit(robot, folder, table)
            check_vtk(robot, folder, table)
            if robot.components:
                check_uff(robot, folder, table)
        for name, seconds, loaded, scenario, limit in SCENARIOS:
            robot = Robot(program, Case(f"yuan2014-4mm, {name}", robot="yuan2014-4mm", options=loaded), folder)
            check_scenario(robot, folder, table, name, seconds, scenario, limit)
        for case in SIMULATED[:3] if options else SIMULATED:
            robot = Robot(program, case, folder)
            check_mujoco(robot, folder, table)
            if robot.name in CHAINED:
                check_chains(robot, folder, table)
            check_links(robot, folder, table)
            if robot.name in UNITS:
                check_fmu(robot, folder, table)
    print(f"{table.failed} outside their limits" if table.failed else "all within their limits")
    sys.exit(1 if table.failed else 0)


main()
