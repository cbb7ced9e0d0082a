#!/usr/bin/env python3
"""A cable robot at equilibrium: statics and first natural frequencies by OpenSees, compared with those of funicular.

Written by `funicular export --to opensees`; needs openseespy from PyPI. SI units, world axes.

Cables are chains of {{ segments }} equal corotational truss bars, weight in the joints, mass half consistent and half lumped.
Such a chain cuts corners: its bars are a little shorter than the cable, and its weight differs a little, so that it pulls
at the platform with the force of the cable. The platform consists of points with its mass, centre of mass and inertia on a
frame of stiff bars. A guide holds each point along the normal of its plane; a moment is two couples of dead forces. At
a pulley or a winch a chain ends at the exit point. A pre-tensioned spring behind it stands for arc, drum side and winch:
its stiffness is that of slip along the cable, its length gives the stiffness of the swivelling wheel. The
relative difference of the frequencies falls with the square of the number of bars: `funicular export --segments`.
"""

import math

import openseespy.opensees as ops

NAME = {{ name }}
# Source of the robot: {{ source }}
GRAVITY = {{ gravity }}  # m/s2
# World axes of the coordinates used here, and the index of the coordinate that a guide holds.
AXES = {{ axes }}
GUIDED = {% if let Some(guided) = guided %}{{ guided }}{% else %}None{% endif %}
# Points of the platform [m] and their masses [kg]: the centre of mass, then pairs along axes at right angles.
PLATFORM = {{ platform }}
# Dead forces on the platform: point of application [m] and force [N].
LOADS = {{ loads }}
SIZE = {{ size }}  # of the platform [m]
TOUCHING = {{ touching|fmt("{:e}") }}  # points nearer than this count as one point [m]
FRAME_STIFFNESS = {{ frame_stiffness|fmt("{:e}") }}  # of each bar of the platform [N/m]
# Each cable from the platform to its anchor: mass [kg], weight and wind of the chain [N], EA [N], lengths [m], joints
# [m] where the chain is in equilibrium; at a pulley or a winch the support of the last joint: fixed point of the spring
# [m], stiffness [N/m], tension [N], directions in which the joint is held. Without a support the joint is fixed.
CABLES = [
{% for cable in cables -%}
{{ "    " }}{{ cable }},
{% endfor -%}
]
# Results of funicular.
POSITION = {{ position }}  # of the platform's origin [m]
TENSIONS_N = {{ tensions }}  # at the platform and at the anchor
FREQUENCIES_HZ = {{ frequencies }}  # with the cable model catenary-dynamic


def inward(vector):
    """Components of a world vector in the coordinates used here."""
    return [sum(a * x for a, x in zip(axis, vector)) for axis in AXES]


def outward(vector):
    """World components of a vector in the coordinates used here."""
    return [sum(axis[k] * x for axis, x in zip(AXES, vector)) for k in range(3)]


def node(point):
    tag = len(ops.getNodeTags()) + 1
    ops.node(tag, *inward(point))
    return tag


def place(tag):
    return outward(ops.nodeCoord(tag))


def displacement(tag):
    return outward(ops.nodeDisp(tag))


def bar(start, end, length, stiffness, mass):
    """Adds a bar between two nodes, with unstrained length [m], EA [N] and evenly distributed mass [kg]."""
    tag = len(ops.getEleTags()) + 1
    distance = math.dist(ops.nodeCoord(start), ops.nodeCoord(end))
    # The element measures strain from this distance. With these two materials its tension is EA (distance - length) /
    # length.
    ops.uniaxialMaterial("Elastic", 2 * tag, stiffness * distance / length)
    ops.uniaxialMaterial("InitStrainMaterial", 2 * tag + 1, 2 * tag, 1.0 - length / distance)
    ops.element("corotTruss", tag, start, end, 1.0, 2 * tag + 1, "-rho", mass / distance, "-cMass", 1)
    return tag


def spring(start, end, stiffness, tension):
    """Adds a bar between two nodes, with axial stiffness [N/m] and tension [N]."""
    tag = len(ops.getEleTags()) + 1
    modulus = stiffness * math.dist(ops.nodeCoord(start), ops.nodeCoord(end))
    ops.uniaxialMaterial("Elastic", 2 * tag, modulus)
    ops.uniaxialMaterial("InitStrainMaterial", 2 * tag + 1, 2 * tag, tension / modulus)
    ops.element("corotTruss", tag, start, end, 1.0, 2 * tag + 1)


def support(end, of):
    """Holds the last joint of a cable: fixed, or behind a pulley or a winch by a spring and stiff bars without tension."""
    if of is None:
        ops.fix(end, 1, 1, 1)
        return
    behind = node(of["behind"])
    ops.fix(behind, 1, 1, 1)
    spring(end, behind, of["stiffness"], of["tension"])
    for direction in of["held"]:
        far = node([x + SIZE * e for x, e in zip(place(end), direction)])
        ops.fix(far, 1, 1, 1)
        spring(end, far, FRAME_STIFFNESS, 0.0)


def add(where, tag, mass):
    where[tag] = where.get(tag, 0.0) + mass


ops.wipe()
ops.model("basic", "-ndm", 3, "-ndf", 3)
forces, masses = {}, {}  # on nodes [N], of nodes [kg]

# The platform: bars between all pairs of points.
frame = []
for point, mass in PLATFORM:
    frame.append(node(point))
    forces[frame[-1]] = [mass * g for g in GRAVITY]
    add(masses, frame[-1], mass)
points = list(frame)


def point_at(where):
    """Node of the platform at a place; adds a node if there is none."""
    near = [tag for tag in points if math.dist(place(tag), where) <= TOUCHING]
    if not near:
        points.append(node(where))
    return near[0] if near else points[-1]


held = [point_at(cable["attachment"]) for cable in CABLES]
loaded = [(point_at(where), force) for where, force in LOADS]
for i, start in enumerate(points):
    for end in points[i + 1 :]:
        distance = math.dist(ops.nodeCoord(start), ops.nodeCoord(end))
        bar(start, end, distance, FRAME_STIFFNESS * distance, 0.0)
for tag in points:
    ops.fix(tag, *(int(k == GUIDED) for k in range(3)))

# The cables.
cable_ends = []
for cable, first in zip(CABLES, held):
    tags = [first] + [node(point) for point in cable["nodes"]]
    support(tags[-1], cable.get("support"))
    mass = cable["mass"] / (len(tags) - 1)
    heavy = [force / (len(tags) - 1) for force in cable["load"]]
    half = [0.5 * force for force in heavy]
    bars = []
    for start, end in zip(tags, tags[1:]):
        # Consistent mass makes waves too fast, lumped mass makes them too slow by the same amount: half of each is
        # used.
        bars.append(bar(start, end, cable["bar_length"], cable["axial_stiffness"], 0.5 * mass))
        for tag in (start, end):
            forces[tag] = [a + b for a, b in zip(forces.get(tag, (0.0, 0.0, 0.0)), half)]
            add(masses, tag, 0.25 * mass)
    cable_ends.append([(bars[0], tags[0], tags[1], 1.0, half), (bars[-1], tags[-2], tags[-1], -1.0, half)])
for tag, mass in masses.items():
    ops.mass(tag, mass, mass, mass)

# Statics: the equilibrium of the bars by Newton's method, starting from funicular's equilibrium.
ops.timeSeries("Constant", 1)
ops.pattern("Plain", 1, 1)
for tag, force in forces.items():
    ops.load(tag, *inward(force))
for tag, force in loaded:
    ops.load(tag, *inward(force))
ops.constraints("Plain")
ops.numberer("RCM")
ops.system("BandGen")
ops.test("NormDispIncr", 1e-10 * SIZE, 50)
ops.algorithm("Newton")
ops.integrator("LoadControl", 1.0)
ops.analysis("Static")
if ops.analyze(1) != 0:
    raise SystemExit("OpenSees found no equilibrium")


def cross(a, b):
    return [a[1] * b[2] - a[2] * b[1], a[2] * b[0] - a[0] * b[2], a[0] * b[1] - a[1] * b[0]]


def moved(tag):
    return [x + u for x, u in zip(place(tag), displacement(tag))]


def direction(start, end):
    distance = math.dist(start, end)
    return [(b - a) / distance for a, b in zip(start, end)]


def motion():
    """Motion from funicular's pose to OpenSees': displacement of the platform's origin [m] and rotation vector [rad], both small."""
    turn = [0.0, 0.0, 0.0]
    for minus, plus in zip(frame[1::2], frame[2::2]):
        # Each of three axes gives two components, so each component is found twice: take half the sum. In the planar
        # case two axes give the component about the normal.
        part = cross(direction(place(minus), place(plus)), direction(moved(minus), moved(plus)))
        turn = [a + 0.5 * b for a, b in zip(turn, part)]
    arm = [a - b for a, b in zip(POSITION, place(frame[0]))]
    return [a + b for a, b in zip(displacement(frame[0]), cross(turn, arm))], turn


def tension(tag, start, end, sign, half):
    """Tension at a cable's end [N]: force of the adjacent bar plus half a bar's weight and wind."""
    force = ops.eleResponse(tag, "axialForce")[0]
    along = direction(moved(start), moved(end))
    return math.hypot(*(force * e + sign * w for e, w in zip(along, half)))


shift, rotation = motion()
tensions = [[tension(*end) for end in ends] for ends in cable_ends]
count = len(FREQUENCIES_HZ)
squares = ops.eigen("-genBandArpack", count) if count else []
frequencies = [math.copysign(math.sqrt(abs(square)), square) / (2.0 * math.pi) for square in squares]
result = {
    "position_m": [a + b for a, b in zip(POSITION, shift)],
    "displacement_m": shift,
    "rotation_rad": rotation,
    "tensions_n": tensions,
    "frequencies_hz": frequencies,
}

print(NAME)
print("\nplatform's origin [m]     funicular        OpenSees      difference")
for axis, ours, theirs, difference in zip("xyz", POSITION, result["position_m"], shift):
    print(f"{axis:>4}               {ours:16.9f} {theirs:15.9f} {difference:15.3e}")
print(f"rotation between them [rad]                          {math.hypot(*rotation):15.3e}")
print("\ntension [N]          funicular        OpenSees      difference")
for cable, ours, theirs in zip(CABLES, TENSIONS_N, tensions):
    for place, a, b in zip(("platform", "anchor"), ours, theirs):
        print(f"{cable['name']:>6} {place:8} {a:14.6f} {b:15.6f} {b - a:15.3e}")
print("\nnatural frequency [Hz]   funicular        OpenSees      relative")
for i, (ours, theirs) in enumerate(zip(FREQUENCIES_HZ, frequencies), 1):
    print(f"{i:6}          {ours:18.7f} {theirs:15.7f} {theirs / ours - 1.0:13.2e}")
