// Words on the reach of the platform.

import assert from "node:assert/strict";
import { test } from "node:test";
import { raysOf, words } from "../src/reach_words.js";

const rays = raysOf(Float64Array.from([3, 0, 1, 3, 0, 0, -0.5, 1, 0.5, 1, 0, 0, 3, 2, 1]));
const told = (of) =>
  words({ from: [0, 0, 1], rays, conditions: ["tensions within their limits"], isInBox: true, ...of });

test("the nearest border is named with its direction; the end of the box is none", () => {
  assert.deepEqual(rays[1], { end: [0, -0.5, 1], distance: 0.5, isBorder: true });
  assert.equal(told({}), "0.500 m to the nearest border, towards −y (tensions within their limits; 3 rays).");
  assert.equal(told({ rays: rays.slice(0, 1) }), "Everywhere in the box of the anchors: tensions within their limits.");
  assert.equal(told({ rays: [] }), "Not kept at this pose: tensions within their limits.");
  assert.match(told({ rays: [], isInBox: false }), /^The platform is beyond the box/);
});
