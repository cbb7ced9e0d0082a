// The state in the text of a saved robot file.

import assert from "node:assert/strict";
import { readFileSync } from "node:fs";
import { test } from "node:test";
import { withLengths, withPose } from "../src/state_text.js";

const robot = (name) => readFileSync(new URL(`../../../../robots/${name}.toml`, import.meta.url), "utf8");

test("a pose replaces lengths and an earlier pose, and everything else stays", () => {
  const text = robot("cogiro");
  const saved = withPose(text, [2, 0.5, 1.5, 0, 0, 10.25]);
  assert.ok(!/^unstrained_length_m/m.test(saved), "the lengths would contradict the pose");
  const state = "\n\n[state]\nposition_m = [2.0, 0.5, 1.5]\nroll_pitch_yaw_deg = [0.0, 0.0, 10.25]\n";
  assert.ok(saved.endsWith(state), saved.slice(-200));
  const kept = (of) => of.split("\n").filter((line) => !/^unstrained_length_m/.test(line));
  assert.deepEqual(kept(saved.slice(0, -state.length)), kept(text.trimEnd()));
  const again = withPose(saved, [0, 0, 1, 0, 0, 0]);
  assert.equal(again.match(/\[state\]/g).length, 1);
  assert.ok(again.endsWith("[state]\nposition_m = [0.0, 0.0, 1.0]\n"));
});

test("lengths replace a pose, one in each cable", () => {
  const text = withPose(robot("cogiro"), [0, 0, 1, 0, 0, 0]);
  const lengths = Array.from({ length: 8 }, (_, i) => 9 + i / 8);
  const saved = withLengths(text, lengths);
  assert.ok(!saved.includes("[state]"));
  const found = [...saved.matchAll(/^unstrained_length_m = (.*)$/gm)].map(([, value]) => Number(value));
  assert.deepEqual(found, lengths);
  assert.equal(withLengths(saved, lengths), saved);
});

test("small and whole numbers are floats", () => {
  const saved = withPose("name = 1\n", [1e-7, -2, 1e21, 0, 0, 0]);
  assert.match(saved, /position_m = \[1e-7, -2\.0, 1e21\]|position_m = \[1e-7, -2\.0, 1000000000000000000000\.0\]/);
});
