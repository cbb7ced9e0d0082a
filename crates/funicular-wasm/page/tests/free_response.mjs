// The free response after a release, against an integration of its equation of motion.

import assert from "node:assert/strict";
import { test } from "node:test";
import { decay, startOf, summed, wrenchOf } from "../src/free_response.js";

/** Solution of q̈ + 2ζω q̇ + ω² q = 0 from q = 1, q̇ = 0, by steps of fourth order. */
function integrated({ hz, damping }, end) {
  const omega = 2 * Math.PI * hz;
  const slope = ([q, v]) => [v, -2 * damping * omega * v - omega * omega * q];
  const steps = Math.ceil(4000 * end * hz * Math.max(1, damping));
  const h = end / steps;
  let state = [1, 0];
  const moved = (by, factor) => state.map((value, k) => value + factor * by[k]);
  for (let i = 0; i < steps; i += 1) {
    const a = slope(state);
    const b = slope(moved(a, h / 2));
    const c = slope(moved(b, h / 2));
    const d = slope(moved(c, h));
    state = state.map((value, k) => value + (h / 6) * (a[k] + 2 * b[k] + 2 * c[k] + d[k]));
  }
  return state[0];
}

test("a mode decays as its equation of motion says, with little, critical and much damping", () => {
  for (const damping of [0, 0.003, 0.3, 0.999, 1, 1.001, 4]) {
    for (const end of [0.01, 0.37, 1.9]) {
      const mode = { hz: 2.1, damping };
      const [found, expected] = [decay(mode, end), integrated(mode, end)];
      assert.ok(Math.abs(found - expected) < 1e-8, `ζ = ${damping}, ${end} s: ${found} and ${expected}`);
    }
  }
});

test("the modes of two masses give the static displacement under a force", () => {
  // Masses 1 and 3 kg along x and y, springs 400 and 500 N/m, coupled by 100 N/m: K = [[500, −100], [−100, 600]].
  const [k, m] = [
    [
      [500, -100],
      [-100, 600],
    ],
    [1, 3],
  ];
  const mean = (k[0][0] / m[0] + k[1][1] / m[1]) / 2;
  const root = Math.sqrt(((k[0][0] / m[0] - k[1][1] / m[1]) / 2) ** 2 + k[0][1] ** 2 / (m[0] * m[1]));
  const modes = [mean - root, mean + root].map((square) => {
    const shape = [1, (k[0][0] - square * m[0]) / -k[0][1], 0, 0, 0, 0];
    return { hz: Math.sqrt(square) / (2 * Math.PI), mass: m[0] + m[1] * shape[1] ** 2, damping: 0, shape };
  });
  const force = [7, -2, 0, 0, 0, 0];
  const found = summed(
    modes.map(({ shape }) => shape),
    startOf(modes, force),
  );
  const determinant = k[0][0] * k[1][1] - k[0][1] ** 2;
  const expected = [
    (k[1][1] * force[0] - k[0][1] * force[1]) / determinant,
    (k[0][0] * force[1] - k[0][1] * force[0]) / determinant,
  ];
  expected.forEach((value, i) => assert.ok(Math.abs(found[i] - value) < 1e-12, `${found[i]} and ${value}`));
});

test("a payload at a point beside the origin has a moment", () => {
  const half = Math.SQRT1_2;
  // A quarter turn about z takes the point (1, 0, 0) to (0, 1, 0); weight along −z turns the platform about −x.
  const wrench = wrenchOf(2, [0, 0, -10], [half, 0, 0, half], [1, 0, 0]);
  [0, 0, -20, -20, 0, 0].forEach((value, k) => assert.ok(Math.abs(wrench[k] - value) < 1e-12, wrench.join()));
});
