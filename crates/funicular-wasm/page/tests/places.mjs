// Where a pose with an equilibrium is searched.

import assert from "node:assert/strict";
import { test } from "node:test";
import { candidates, innermost } from "../src/candidates.js";

const CEILING = [
  [5, 4, 6],
  [-5, 4, 6],
  [-5, -4, 6],
  [5, -4, 6],
];

test("poses are between the anchors and below them", () => {
  const poses = candidates({ anchors: CEILING, motion: { name: "rigid" } });
  assert.ok(poses.length > 200 && poses.every(([x, y, z]) => Math.abs(x) < 5 && Math.abs(y) < 4 && z < 6));
  assert.ok(Math.min(...poses.map(([, , z]) => z)) < -3, "a robot on a ceiling hangs below its anchors");
});

test("a planar robot stays in its plane", () => {
  const square = CEILING.map(([x, , z], i) => [x, 0, i < 2 ? z : 0]);
  const poses = candidates({ anchors: square, motion: { name: "planar", normal: [0, 1, 0] } });
  assert.ok(poses.length > 20 && poses.every(([, y]) => y === 0));
});

test("the innermost pose with a value is chosen", () => {
  const poses = [0, 1, 2, 3, 4, 5].map((x) => [x, 0, 0, 0, 0, 0]);
  assert.equal(
    innermost(
      poses,
      [NaN, 1, 1, 1, 1, NaN].map((value, i) => (i === 4 ? NaN : value)),
    )[0],
    2,
  );
  assert.equal(
    innermost(
      poses,
      poses.map(() => NaN),
    ),
    null,
  );
});
