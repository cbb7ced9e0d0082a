#!/usr/bin/env python3
"""Checks a certificate of `funicular prove` or `funicular workspace --prove` with rational numbers.

    scripts/check_certificate.py FILE.jsonl

It imports nothing of the program and solves nothing: each box is a few inequalities about numbers that the file gives.
Floating point only proposes an inverse matrix and a bound; all that decides are fractions, with roots enclosed by
fractions. docs/theory.md, section 10b, has the inequalities by their numbers. Exit code 0: every line is proved.
"""

import hashlib
import json
import sys
from fractions import Fraction
from math import isqrt

FORM = "funicular-certificate/1"
# Bits of a rounded number, with which fractions stay short.
BITS = 100
# Parts of tensions by which the true ones may differ when their sag is bounded.
NEAR = (Fraction(1, 20), Fraction(3, 10))
# Multiples of the minimum tension from which on sag is bounded at last, for cables that are too slack below.
FROM = tuple(Fraction(23, 20) ** k for k in range(12))


class Rejected(Exception):
    """Reason why a certificate proves nothing."""


def need(condition, reason):
    """Rejects the certificate if a condition does not hold."""
    if not condition:
        raise Rejected(reason)


# Numbers.


def exact(value):
    """Fraction of a number of the file."""
    need(isinstance(value, (int, float)) and not isinstance(value, bool), f"{value!r} is no number")
    need(value == value and abs(value) < 1e300, f"{value!r} is no finite number")
    return Fraction(value)


def vector(values, count):
    """Fractions of a list of so many numbers."""
    need(isinstance(values, list) and len(values) == count, f"{values!r} has not {count} numbers")
    return [exact(value) for value in values]


def up(value):
    """Short fraction that is not below a number."""
    return -down(-value)


def down(value):
    """Short fraction that is not above a number."""
    if value == 0:
        return Fraction(0)
    shift = BITS - (abs(value.numerator).bit_length() - value.denominator.bit_length())
    scale = Fraction(2) ** shift
    return Fraction((value * scale).__floor__()) / scale


def root_below(value):
    """Fraction that is not above a square root."""
    need(value >= 0, "a root of a negative number")
    scale = 1 << (2 * BITS)
    return Fraction(isqrt(value.numerator * scale * scale // value.denominator), scale)


def root_above(value):
    """Fraction that is not below a square root."""
    scale = 1 << (2 * BITS)
    return Fraction(isqrt(value.numerator * scale * scale // value.denominator) + 2, scale)


def dot(a, b):
    """Scalar product."""
    return sum((x * y for x, y in zip(a, b)), Fraction(0))


def cross(a, b):
    """Vector product."""
    return [a[1] * b[2] - a[2] * b[1], a[2] * b[0] - a[0] * b[2], a[0] * b[1] - a[1] * b[0]]


def plus(a, b, factor=1):
    """Sum of a vector and a multiple of another one."""
    return [x + factor * y for x, y in zip(a, b)]


def size(a):
    """Bound of the length of a vector."""
    return up(root_above(dot(a, a)))


def absolute(a):
    """Magnitudes of components."""
    return [abs(x) for x in a]


# Statement.


class Cable:
    """Cable of the statement."""

    def __init__(self, line):
        self.anchor = vector(line["anchor"], 3)
        self.arm = vector(line["arm"], 3)
        self.reach = size(self.arm)
        self.least = exact(line["least"])
        self.least_per_length = exact(line["least_per_length"])
        self.greatest = None if line["greatest"] is None else exact(line["greatest"])
        self.weight = exact(line["weight"]) if "weight" in line else None
        self.stiffness = exact(line["axial_stiffness"]) if "weight" in line else None
        need(self.least >= 0 and self.least_per_length >= 0, "a negative minimum tension")
        need(self.greatest is None or self.greatest >= self.least, "a minimum tension above the maximum")
        need(self.weight is None or (self.weight > 0 and self.stiffness > 0), "a cable without weight or stiffness")

    def least_at(self, length):
        """Minimum tension with a chord of a length."""
        return max(self.least, self.least_per_length * length)


class Statement:
    """Cables, loads and turns of a certificate."""

    def __init__(self, line):
        need(line.get("form") == FORM, f"not a certificate of the form {FORM}")
        self.cables = [Cable(cable) for cable in line["cables"]]
        self.rows = [vector(row, 6) for row in line["rows"]]
        self.count = len(self.rows)
        need(1 <= self.count <= 6 and len(self.cables) >= self.count, "too few cables for the degrees of freedom")
        need(line["loads"], "no load")
        self.loads = [vector(load, 6)[: self.count] for load in line["loads"]]
        self.turning = [[vector(part, 3) for part in force] for force in line["turning"]]
        self.turns = vector(line["turns"], 3)
        need(all(turn >= 0 for turn in self.turns), "a negative turn")
        self.turn = size(self.turns) if any(self.turns) else Fraction(0)
        self.up = vector(line["up"], 3)
        self.lower, self.upper = vector(line["lower"], 3), vector(line["upper"], 3)
        # Bounds of the reduced components of a force, and of a moment, of unit size.
        self.of_force = [size(row[:3]) for row in self.rows]
        self.of_moment = [size(row[3:]) for row in self.rows]
        need(all(any(row) for row in self.rows), "a degree of freedom without a direction")

    def reduced(self, force, moment):
        """Components of a wrench along the degrees of freedom."""
        return [dot(row[:3], force) + dot(row[3:], moment) for row in self.rows]


class Over:
    """Cable over a box: lengths, wrench per force density, and bounds of what is not linear."""

    def __init__(self, statement, cable, box):
        self.cable = cable
        arm, half = cable.arm, box.half
        self.from_origin = plus(cable.anchor, box.center, -1)
        chord = plus(self.from_origin, arm, -1)
        turn, reach, shift = statement.turn, cable.reach, size(half) if any(half) else Fraction(0)
        self.second, self.first = turn * turn * reach / 2, turn * reach
        self.moves, self.shift = shift + self.first + self.second, shift

        square = dot(chord, chord)
        need(square > 0, "an anchor in the box")
        self.length = [down(root_below(square)), up(root_above(square))]
        apart = [max(abs(x) - h, Fraction(0)) for x, h in zip(chord, half)]
        self.shortest = down(root_below(dot(apart, apart)) - self.first - self.second)
        need(self.shortest > 0 and self.length[0] > 0, "an anchor may be in the box")
        self.longest = self.length[1] + self.moves

        # Wrench [d; r x d] = [d; r x (B - p)]: at the centre, by each coordinate, and the bound of what is left.
        self.chord = chord
        self.center = statement.reduced(chord, cross(arm, self.from_origin))
        self.by, self.chord_by = [], []
        for step, theta in box.steps:
            turned = cross(theta, arm)
            force = plus([-x for x in step], turned, -1)
            moment = plus(cross(turned, self.from_origin), cross(arm, step), -1)
            self.by.append(statement.reduced(force, moment))
            self.chord_by.append(force)
        left = self.second * (size(self.from_origin) + shift) + shift * self.first
        self.rest = [f * self.second + m * left for f, m in zip(statement.of_force, statement.of_moment)]

        # 1/l = 1/l_0 - u.dd/l_0^2 with bounds above and below.
        low, high = self.length
        cubes = [low**3, high**3]
        along = [dot(chord, by) for by in self.chord_by]
        self.inverse_by = [down(-x / cubes[1]) for x in along]
        loose = sum((up(abs(x) * (1 / cubes[0] - 1 / cubes[1])) for x in along), Fraction(0))
        loose += sum((Fraction(1, 1 << 90) * abs(x) for x in self.inverse_by), Fraction(0))
        loose += up(self.second / low**2)
        curve = up(self.moves**2 / self.shortest**3)
        self.inverse = [down(1 / high) - loose - curve / 2, up(1 / low) + loose + curve]
        self.inverse_left = loose

        # Weight.
        self.lift = statement.reduced(statement.up, cross(arm, statement.up))
        self.lift_by = [
            statement.reduced([Fraction(0)] * 3, cross(cross(theta, arm), statement.up)) for _, theta in box.steps
        ]
        upright = size(statement.up)
        self.lift_change = [m * (self.first + self.second) * upright for m in statement.of_moment]
        self.lift_left = [m * self.second * upright for m in statement.of_moment]
        rise = abs(dot(chord, statement.up))
        lifts = dot(half, absolute(statement.up)) + (self.first + self.second) * upright
        self.steepest, self.flattest = rise + lifts, max(rise - lifts, Fraction(0))
        self.sine = min(up(self.steepest / self.shortest), Fraction(1))

    def sag(self, least, greatest):
        """Bounds of the sag for chord tensions of a range: of the end force, and of tensions below and above it."""
        cable, longest = self.cable, self.longest
        straight = cable.weight * longest
        varies, found = straight * 3 / 4, None
        for _ in range(3):
            lowest = least - varies
            if lowest <= varies:
                break
            part = up(varies / lowest)
            stretch = up(1 / root_below(1 - part * part))
            load = straight * stretch
            vertical = least * self.sine + varies
            curved = up(load * load / 12 * vertical * (least + varies) / lowest**3)
            longer = longest * (stretch - 1)
            shorter = longest * (greatest + varies) / cable.stiffness
            deviation = curved + cable.weight * max(longer, shorter) / 2
            now = load / 2 + curved
            if now > varies:
                break
            varies = now
            across = varies * varies / (2 * (least - varies))
            along = self.sine * curved + cable.weight * self.steepest * stretch / 2
            found = [up(deviation), up(along), up(along + across)]
        return found

    def chord_tensions(self):
        """Chord tensions of a cable whose tensions are within their limits, and the bound of its end force."""
        cable = self.cable
        least = cable.least_at(self.shortest)
        if cable.weight is None:
            return [least, cable.greatest], Fraction(0)
        need(cable.greatest is not None, "the sag of a cable without a maximum tension has no bound")
        bound = self.sag(least, cable.greatest)
        need(bound is not None, "a cable is too slack for a bound")
        half = cable.weight * self.longest / 2 + bound[0]
        by_slope = max(cable.weight * self.flattest / 2 - bound[0], Fraction(0))
        at_low_end = by_slope + root_below(max(least * least - half * half, Fraction(0)))
        return [max(least, at_low_end), cable.greatest - by_slope], bound[0]


class Box:
    """Box of positions with the turns of the statement."""

    def __init__(self, statement, line):
        self.statement = statement
        self.lower, self.upper = vector(line["lower"], 3), vector(line["upper"], 3)
        need(all(a <= b for a, b in zip(self.lower, self.upper)), "a box with a negative width")
        inside = zip(statement.lower, self.lower, self.upper, statement.upper)
        need(all(a <= b and c <= d for a, b, c, d in inside), "a box beyond the box of the statement")
        self.center = [(a + b) / 2 for a, b in zip(self.lower, self.upper)]
        self.half = [(b - a) / 2 for a, b in zip(self.lower, self.upper)]
        zero = [Fraction(0)] * 3
        axis = lambda k, width: [width if i == k else Fraction(0) for i in range(3)]  # noqa: E731
        self.steps = [(axis(k, h), zero) for k, h in enumerate(self.half) if h > 0]
        self.steps += [(zero, axis(k, t)) for k, t in enumerate(statement.turns) if t > 0]
        self.cables = [Over(statement, cable, self) for cable in statement.cables]

    def measure(self):
        """Product of the sides that are not zero."""
        product = Fraction(1)
        for a, b in zip(self.lower, self.upper):
            product *= (b - a) if b > a else 1
        return product

    # Inside.

    def inside(self, tensions):
        """Checks that tensions about those of the file hold every load at every pose of the box."""
        count = len(self.cables)
        need(len(tensions) == len(self.statement.loads), "tensions for another number of loads")
        witnesses = []
        for of_load in tensions:
            need(len(of_load) == 1 + len(self.steps), "tensions for another number of coordinates")
            parts = [[float(x) for x in vector(part, count)] for part in of_load]
            # Force densities; any will do, so that they are rounded first.
            lengths = [float(cable.length[0]) for cable in self.cables]
            witnesses.append([[Fraction(t / length) for t, length in zip(part, lengths)] for part in parts])
        inverse = self.right_inverse()
        unbalanced = self.unbalanced(inverse)
        reasons = []
        for near in NEAR + (None,) if any(cable.cable.weight is not None for cable in self.cables) else (None,):
            try:
                # The same bounds of the sag for all loads, so that their combinations are held as well.
                sags = [self.sag_range(i, witnesses, near) for i in range(count)]
                for number, witness in enumerate(witnesses):
                    self.load_is_held(number, witness, inverse, unbalanced, sags)
                return
            except Rejected as reason:
                reasons.append(str(reason))
        raise Rejected(reasons[-1])

    def right_inverse(self):
        """Rows of a right inverse of the wrenches at the centre, nearly: any will do that the checks accept."""
        n = self.statement.count
        # By unit tensions, as the program has it.
        lengths = [float(cable.length[0]) for cable in self.cables]
        columns = [[float(x) / length for x in cable.center] for cable, length in zip(self.cables, lengths)]
        gram = [[sum(c[i] * c[j] for c in columns) for j in range(n)] for i in range(n)]
        rows = [gram[i] + [float(i == j) for j in range(n)] for i in range(n)]
        for k in range(n):
            pivot = max(range(k, n), key=lambda i: abs(rows[i][k]))
            need(abs(rows[pivot][k]) > 0, "the wrenches of the cables are dependent")
            rows[k], rows[pivot] = rows[pivot], rows[k]
            rows[k] = [x / rows[k][k] for x in rows[k]]
            for i in range(n):
                if i != k:
                    rows[i] = [x - rows[i][k] * y for x, y in zip(rows[i], rows[k])]
        right = [row[n:] for row in rows]
        product = [[sum(right[i][j] * c[j] for j in range(n)) for i in range(n)] for c in columns]
        need(all(abs(x) < 1e300 for row in product for x in row), "the wrenches of the cables are dependent")
        return [[Fraction(x / length) for x in row] for row, length in zip(product, lengths)]

    def unbalanced(self, inverse):
        """Bound of M Y - 1 over the box."""
        n = self.statement.count
        bound = [[Fraction(0)] * n for _ in range(n)]
        parts = [[cable.center for cable in self.cables]]
        parts += [[cable.by[j] for cable in self.cables] for j in range(len(self.steps))]
        for number, columns in enumerate(parts):
            for a in range(n):
                for b in range(n):
                    of = sum((c[a] * row[b] for c, row in zip(columns, inverse)), Fraction(0))
                    bound[a][b] += abs(of - (1 if number == 0 and a == b else 0))
        for cable, row in zip(self.cables, inverse):
            for a in range(n):
                for b in range(n):
                    bound[a][b] += cable.rest[a] * abs(row[b])
        return [[up(x) for x in row] for row in bound]

    def sag_range(self, i, witnesses, near):
        """Bounds of the sag of a cable with the chord tensions to which they belong; `None` for a straight one."""
        over, cable = self.cables[i], self.cables[i].cable
        if cable.weight is None:
            return None
        least = cable.least_at(over.longest)
        if near is None:
            for multiple in FROM:
                low = least * multiple
                high = 1000 * low if cable.greatest is None else min(cable.greatest, 1000 * low)
                bound = over.sag(low, high)
                if bound is not None:
                    return bound, [low, high]
            raise Rejected("a cable is too slack for a bound of its sag")
        spreads = [(w[0][i], sum((abs(part[i]) for part in w[1:]), Fraction(0))) for w in witnesses]
        least = max(least, min(q - spread for q, spread in spreads) * (over.length[0] - over.moves) * (1 - near))
        greatest = max(least, max(q + spread for q, spread in spreads) * over.longest * (1 + near))
        bound = over.sag(least, greatest)
        need(bound is not None, "a cable is too slack for a bound of its sag")
        return bound, [least, greatest]

    def load(self, number):
        """Load with half of the weight of the cables: at the centre, by each coordinate, and the bound of the rest."""
        statement = self.statement
        center, by = list(statement.loads[number]), [[Fraction(0)] * statement.count for _ in self.steps]
        rest = [Fraction(0)] * statement.count
        for force, arm in statement.turning:
            for j, (_, theta) in enumerate(self.steps):
                by[j] = plus(by[j], statement.reduced([Fraction(0)] * 3, cross(cross(theta, arm), force)))
            left = statement.turn**2 / 2 * size(arm) * size(force)
            rest = [r + m * left for r, m in zip(rest, statement.of_moment)]
        for over in self.cables:
            weight = over.cable.weight
            if weight is None:
                continue
            low, high = over.length
            center = plus(center, over.lift, -weight / 2 * low)
            loose = high - low
            for j in range(len(self.steps)):
                along = dot(over.chord, over.chord_by[j])
                by[j] = plus(by[j], over.lift, -weight / 2 * down(along / high))
                by[j] = plus(by[j], over.lift_by[j], -weight / 2 * low)
                loose += up(abs(along) * (1 / low - 1 / high)) + abs(along) / (high * (1 << 90))
            longer = over.moves**2 / (2 * over.shortest) + over.second + loose
            for k in range(statement.count):
                turned = over.longest * over.lift_left[k] + (over.moves + loose) * over.lift_change[k]
                rest[k] += weight / 2 * (abs(over.lift[k]) * longer + turned)
        return center, by, [up(x) for x in rest]

    def load_is_held(self, number, witness, inverse, unbalanced, sags):
        """Checks (40y3) and the limits for a load."""
        n, coordinates = self.statement.count, range(len(self.steps))
        center, by, rest = self.load(number)
        sizes = [sum((abs(part[i]) for part in witness), Fraction(0)) for i in range(len(self.cables))]
        of_sag = [Fraction(0)] * n
        for i, over in enumerate(self.cables):
            center = plus(center, over.center, witness[0][i])
            for j in coordinates:
                by[j] = plus(plus(by[j], over.center, witness[1 + j][i]), over.by[j], witness[0][i])
            rest = plus(rest, over.rest, sizes[i])
            if sags[i] is not None:
                lifts = plus(absolute(over.lift), over.lift_change)
                of_sag = plus(of_sag, lifts, sags[i][0][0])
        linear = absolute(center)
        for j in coordinates:
            linear = plus(linear, absolute(by[j]))
        constant = [up(x) for x in plus(plus(linear, rest), of_sag)]

        total, below, above, crossed = list(constant), *([Fraction(0)] * len(self.cables) for _ in range(3))
        for j in coordinates:
            for k in range(j, len(self.steps)):
                left = [Fraction(0)] * n
                for i, over in enumerate(self.cables):
                    left = plus(left, over.by[j], witness[1 + k][i])
                    if j != k:
                        left = plus(left, over.by[k], witness[1 + j][i])
                total = plus(total, absolute(left))
                for i, row in enumerate(inverse):
                    change = -dot(row, left)
                    if j == k:
                        below[i] += min(change, 0)
                        above[i] += max(change, 0)
                    else:
                        crossed[i] += abs(change)

        # Brouwer: E x + rho <= x in every component.
        bound = [Fraction(x) for x in proposed(unbalanced, total)]
        mapped = [dot(row, bound) for row in unbalanced]
        need(all(m + t <= x for m, t, x in zip(mapped, total, bound)), "the cables come near to dependence")
        for i, over in enumerate(self.cables):
            others = dot(absolute(inverse[i]), plus(mapped, constant)) + crossed[i]
            density = (witness[0][i], [part[i] for part in witness[1:]], below[i] - others, above[i] + others)
            self.is_within(over, density, sags[i])

    def is_within(self, over, density, sag):
        """Checks the limits of a cable with a force density: at the centre, by each coordinate, and its corrections."""
        center, by, below, above = density
        cable = over.cable
        tension_below, tension_above = (sag[0][1], sag[0][2]) if sag is not None else (Fraction(0), Fraction(0))
        lowest = [cable.least_at(over.longest) + tension_below]
        highest = [] if cable.greatest is None else [cable.greatest - tension_above]
        if sag is not None:
            lowest.append(sag[1][0])
            highest.append(sag[1][1])
        for limit in lowest:
            differs = sum((abs(q - limit * k) for q, k in zip(by, over.inverse_by)), Fraction(0))
            need(center - differs + below > limit * over.inverse[1], "a tension may be below its minimum")
        for limit in highest:
            differs = sum((abs(q - limit * k) for q, k in zip(by, over.inverse_by)), Fraction(0))
            need(limit > 0, "a maximum tension below the weight of its cable")
            need(center + differs + above < limit * over.inverse[0], "a tension may be above its maximum")

    # Outside.

    def outside(self, load, direction):
        """Checks that the cables fall short along a direction at every position of the box."""
        statement = self.statement
        need(isinstance(load, int) and 0 <= load < len(statement.loads), "a load that does not exist")
        y = vector(direction, 6)[: statement.count]
        wrench = [sum((y[k] * row[c] for k, row in enumerate(statement.rows)), Fraction(0)) for c in range(6)]
        untwisted = [Over(statement.without_turns(), cable, self.without_turns()) for cable in statement.cables]
        tensions = [over.chord_tensions() for over in untwisted]
        corners = [[]]
        for low, high in zip(self.lower, self.upper):
            corners = [corner + [x] for corner in corners for x in ({low, high})]
        rest, pulls = Fraction(0), [False] * len(untwisted)
        worst = None
        along = [plus(wrench[:3], cross(wrench[3:], over.cable.arm)) for over in untwisted]
        curves = []
        for g, over in zip(along, untwisted):
            curves.append(size(g) * over.shift**2 / (root_below(Fraction(3)) * over.shortest**2) if any(g) else Fraction(0))
        for corner in corners:
            reach = dot(y, statement.loads[load])
            for i, over in enumerate(untwisted):
                chord = plus(plus(over.cable.anchor, corner, -1), over.cable.arm, -1)
                square = dot(chord, chord)
                length = [root_below(square), root_above(square)]
                force = dot(along[i], chord)
                force = up(force / (length[0] if force > 0 else length[1]))
                pulls[i] = pulls[i] or force + curves[i] > 0
                least, greatest = tensions[i][0]
                need(force <= 0 or greatest is not None, "a cable without a maximum tension pulls that way")
                reach += force * (greatest if force > 0 else least)
                if over.cable.weight is not None:
                    lift = dot(y, over.lift)
                    reach -= over.cable.weight / 2 * lift * (length[0] if lift > 0 else length[1])
            worst = reach if worst is None else max(worst, reach)
        for i, over in enumerate(untwisted):
            (least, greatest), deviation = tensions[i]
            need(greatest is not None or not pulls[i], "a cable without a maximum tension pulls that way")
            rest += (greatest if pulls[i] else least) * curves[i]
            if over.cable.weight is not None:
                lift = dot(y, over.lift)
                rest += over.cable.weight / 2 * max(lift, Fraction(0)) * over.shift**2 / (2 * over.shortest)
                rest += deviation * abs(lift)
        need(worst + rest < 0, "the cables may not fall short")

    def without_turns(self):
        """Box at the orientation of the statement alone."""
        box = object.__new__(Box)
        box.center, box.half = self.center, self.half
        zero = [Fraction(0)] * 3
        box.steps = [step for step in self.steps if step[1] == zero]
        return box


def without_turns(statement):
    """Statement at its orientation alone."""
    still = object.__new__(Statement)
    still.__dict__.update(statement.__dict__)
    still.turns, still.turn = [Fraction(0)] * 3, Fraction(0)
    return still


Statement.without_turns = without_turns


def proposed(unbalanced, total):
    """Numbers x with E x + rho <= x, nearly: the check itself is exact."""
    matrix = [[float(x) for x in row] for row in unbalanced]
    left = [float(x) for x in total]
    floor = 1e-12 * max(left)
    x = list(left)
    for _ in range(40):
        mapped = [sum(a * b for a, b in zip(row, x)) + r for row, r in zip(matrix, left)]
        tried = [1.02 * m + floor for m in mapped]
        again = [sum(a * b for a, b in zip(row, tried)) + r for row, r in zip(matrix, left)]
        if all(a * (1 + 1e-12) <= t for a, t in zip(again, tried)):
            return tried
        need(max(mapped) <= 1e6 * (max(left) + 1e-300), "the cables come near to dependence")
        x = mapped
    raise Rejected("the cables come near to dependence")


# Boxes together.


def are_apart(boxes, lower, upper, depth=0):
    """True if no two boxes have common points inside."""
    if len(boxes) < 2:
        return True
    axis = max(range(3), key=lambda k: upper[k] - lower[k])
    middle = (lower[axis] + upper[axis]) * 0.5
    first = [box for box in boxes if box[1][axis] <= middle]
    second = [box for box in boxes if box[1][axis] > middle and box[0][axis] >= middle]
    if len(first) + len(second) < len(boxes) or depth > 200 or lower[axis] >= upper[axis]:
        pairs = ((a, b) for k, a in enumerate(boxes) for b in boxes[:k])
        return not any(overlap(a, b) for a, b in pairs)
    low = [middle if k == axis else x for k, x in enumerate(lower)]
    high = [middle if k == axis else x for k, x in enumerate(upper)]
    return are_apart(first, lower, high, depth + 1) and are_apart(second, low, upper, depth + 1)


def overlap(a, b):
    """True if two boxes have common points inside; a side without a width counts as a point."""
    for k in range(3):
        low, high = max(a[0][k], b[0][k]), min(a[1][k], b[1][k])
        if low > high or (low == high and a[0][k] < a[1][k]):
            return False
    return True


def check(text, report=lambda done, total: None):
    """Checks a certificate; returns numbers and volumes by verdict.

    Raises Rejected with the line and the reason if anything is not proved."""
    need(text.endswith("\n"), "the last line is not complete")
    lines = text.split("\n")[:-1]
    need(len(lines) >= 3, "no line with the statement, or none with the end")
    try:
        parsed = [json.loads(line) for line in lines]
    except ValueError as reason:
        raise Rejected(f"not lines of JSON: {reason}") from None
    need(all(isinstance(line, dict) for line in parsed), "a line that is no object")
    end, digest = parsed[-2:]
    before = text[: len(text) - len(lines[-1]) - 1]
    need(digest.get("sha256") == hashlib.sha256(before.encode()).hexdigest(), "lines differ from those that were written")

    count, volume, known = {"inside": 0, "outside": 0}, {"inside": Fraction(0), "outside": Fraction(0)}, []
    place = "line 1"
    try:
        statement = Statement(parsed[0])
        for number, line in enumerate(parsed[1:-2]):
            place = f"line {number + 2}"
            box = Box(statement, line)
            need(line["verdict"] in count, f"the verdict {line['verdict']!r} does not exist")
            if line["verdict"] == "inside":
                box.inside(line["tensions"])
            else:
                box.outside(line["load"], line["direction"])
            count[line["verdict"]] += 1
            volume[line["verdict"]] += box.measure()
            known.append((line["lower"], line["upper"]))
            report(number + 1, len(parsed) - 3)
        place = f"line {len(parsed) - 1}"
        for verdict in count:
            need(end[verdict] == count[verdict], f"{end[verdict]} boxes {verdict}, and not {count[verdict]}")
            stated, found = exact(end[f"{verdict}_size"]), volume[verdict]
            need(abs(stated - found) <= found / 10**9, f"the size {verdict} is {float(found)}, and not {float(stated)}")
        need(are_apart(known, parsed[0]["lower"], parsed[0]["upper"]), "two boxes overlap")
    except Rejected as reason:
        raise Rejected(f"{place}: {reason}") from None
    except (KeyError, TypeError, ValueError, IndexError, AttributeError, ZeroDivisionError, OverflowError) as reason:
        raise Rejected(f"{place}: {type(reason).__name__}: {reason}") from None
    return {verdict: (count[verdict], float(volume[verdict])) for verdict in count}


def main(arguments):
    """Checks the file of the arguments."""
    if len(arguments) != 1 or arguments[0] in ("-h", "--help"):
        print(__doc__)
        return 0 if arguments in (["-h"], ["--help"]) else 2

    def report(done, total):
        if done % 100 == 0 and sys.stderr.isatty():
            print(f"\r{done} of {total} boxes", end="", file=sys.stderr)

    try:
        with open(arguments[0], encoding="utf-8") as file:
            found = check(file.read(), report)
    except OSError as reason:
        print(f"{arguments[0]}: {reason}", file=sys.stderr)
        return 2
    except Rejected as reason:
        print(f"rejected: {reason}", file=sys.stderr)
        return 1
    for verdict, (count, volume) in found.items():
        print(f"proved {verdict}: {count} boxes, {volume:.6g} together")
    return 0


if __name__ == "__main__":
    sys.exit(main(sys.argv[1:]))
