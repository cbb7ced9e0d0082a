#!/usr/bin/env python3
"""A cable robot in motion by MoorDyn.

Written by `funicular export --to moordyn` with a scenario; needs moordyn from PyPI. SI units, world axes. Writes
the input file of MoorDyn and the result beside this script, as NAME.moordyn.txt and NAME.moordyn.csv. The columns have the names
of `funicular simulate`: place of the platform, tensions at the platform and at the anchors, unstretched lengths of the lines.
"""

import bisect
import csv
import ctypes
import math
from pathlib import Path

import moordyn

# Time at which the motion begins [s]; until then the robot rests.{% if released > 0.0 %} A payload of {{ released }} kg is released then: the platform
# in the input file has the mass, the centre of mass and the inertia after it, and the place before it.{% endif %}
START_S = {{ start }}
END_S = {{ end }}
# Time between rows of the result [s].
ROW_S = {{ row }}
# Longest time for which a length has a constant rate [s].
COMMAND_S = 1e-3
CABLES = [{{ cables|join(", ") }}]
# Lines that winches move, and their commands: time [s], changes of the unstretched lengths since the start [m], rates [m/s].
# Between two rows a length is the cubic with these values and rates. MoorDyn lengthens all segments of a line alike.
MOVED = {{ moved }}
COMMANDS = [
{% for of in commands -%}
{{ "    " }}{{ of }},
{% endfor -%}
]
TIMES = [row[0] for row in COMMANDS]
# Cables that fail: time [s], line, and its point at the platform.
CUTS = {{ cuts }}
INPUT = [
{% for line in input -%}
{{ "    " }}{{ line }},
{% endfor -%}
]


def changes(time):
    """Changes of the lengths of the moved lines at a time [m]."""
    k = min(max(bisect.bisect(TIMES, time) - 1, 0), len(TIMES) - 2)
    (begin, before, rates_before), (end, after, rates_after) = COMMANDS[k : k + 2]
    gap = end - begin
    x = min(max((time - begin) / gap, 0.0), 1.0)
    of_before, of_after = (1 + 2 * x) * (1 - x) ** 2, x * x * (3 - 2 * x)
    of_rates = gap * x * (1 - x) ** 2, gap * x * x * (x - 1)
    rows = zip(before, after, rates_before, rates_after)
    return [of_before * a + of_after * b + of_rates[0] * c + of_rates[1] * d for a, b, c, d in rows]


def command(lines, begin, end):
    """Gives the moved lines the rates with which they have their lengths at the end."""
    for number, before, after in zip(MOVED, changes(begin), changes(end)):
        # moordyn 2.7 returns None without counting it, so that Python before 3.12 would end when all are used up.
        ctypes.pythonapi.Py_IncRef(ctypes.py_object(None))
        moordyn.SetLineUnstretchedLengthVel(lines[number - 1], (after - before) / (end - begin))


def steps(begin, end):
    """Times between two rows: where a rate changes and where a line breaks."""
    parts = math.ceil((end - begin) / COMMAND_S - 1e-9) if MOVED else 1
    times = {begin + (end - begin) * part / parts for part in range(parts)}
    return [*sorted(times | {time for time, _, _ in CUTS if begin < time < end}), end]


def row_of(time, system, lines):
    """Row of the result: the forces at the ends of a line, with the weight of half a segment, are its tensions."""
    {% if is_body %}place = moordyn.GetBodyPos(moordyn.GetBody(system, 1)){% else %}place = moordyn.GetPointPos(moordyn.GetPoint(system, len(CABLES) + 1)){% endif %}
    ends = [[moordyn.GetLineNodeForce(line, node) for line in lines] for node in (0, moordyn.GetLineN(lines[0]))]
    tensions = [math.hypot(*force) for forces in ends for force in forces]
    return [time, *place, *tensions, *(moordyn.GetLineUnstretchedLength(line) for line in lines)]


def run(path):
    """Runs the input file; the rows of the result. The first is a time step after the start."""
    system = moordyn.Create(str(path))
    moordyn.SetVerbosity(system, moordyn.LEVEL_ERR)
    moordyn.Init(system, [], [])
    lines = [moordyn.GetLine(system, 1 + i) for i in range(len(CABLES))]
    rows = []
    cuts = list(CUTS)
    for k in range(round((END_S - START_S) / ROW_S)):
        times = steps(START_S + k * ROW_S, START_S + (k + 1) * ROW_S)
        for begin, end in zip(times, times[1:]):
            while cuts and cuts[0][0] <= begin + 1e-12:
                _, line, point = cuts.pop(0)
                moordyn.BreakLine(system, moordyn.GetPoint(system, point), lines[line - 1])
            if MOVED:
                command(lines, begin, end)
            moordyn.Step(system, [], [], begin, end - begin)
        rows.append(row_of(START_S + (k + 1) * ROW_S, system, lines))
    moordyn.Close(system)
    return rows


if __name__ == "__main__":
    here = Path(__file__)
    path = here.with_suffix(".moordyn.txt")
    path.write_text("\n".join(INPUT) + "\n", encoding="utf-8")
    rows = run(path)
    names = [f"tension_{end}_{name}_n" for end in ("platform", "anchor") for name in CABLES]
    lengths = [f"unstrained_length_{name}_m" for name in CABLES]
    with here.with_suffix(".moordyn.csv").open("w", newline="", encoding="utf-8") as file:
        csv.writer(file, lineterminator="\n").writerows([["t_s", "x_m", "y_m", "z_m", *names, *lengths], *rows])
    print(f"\nwrote {here.with_suffix('.moordyn.csv')}")
