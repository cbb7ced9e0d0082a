// Request of a calibration, and its command, from the fields of the page.

import assert from "node:assert/strict";
import { test } from "node:test";
import { gridOf, requestOf, WrongField } from "../src/calibration_request.js";
import { calibrateCommand } from "../src/words.js";

const fields = {
  "calibrate-deviation": "0,5",
  "calibrate-held": "bl, br",
  "calibrate-frame": "",
  "calibrate-model": "ideal",
  "calibrate-propose": "2",
};
const given = (changed = {}) => ({
  robot: { name: "machine.toml", text: "", set: [{ path: "platform.mass_kg", value: 9 }] },
  readings: { length_bl_mm: [1] },
  unknowns: ["anchors", "offsets"],
  fields: { ...fields, ...changed },
  ranges: [
    [0, [0, 4.4]],
    [1, [0, 3.7]],
  ],
});

test("fields become the keys of a request, and empty ones are left out", () => {
  const { robot, readings, ...rest } = requestOf(given());
  assert.deepEqual(rest, {
    command: "calibrate",
    unknowns: ["anchors", "offsets"],
    hold_anchors: ["bl", "br"],
    length_std_m: 0.0005,
    static_model: "ideal",
    propose: 2,
    grid: [
      { axis: "x", from: 0.44, to: 3.96, count: 9 },
      { axis: "y", from: 0.37, to: 3.33, count: 9 },
    ],
  });
  const bare = requestOf(given({ "calibrate-deviation": " ", "calibrate-held": "", "calibrate-propose": "0" }));
  assert.ok(["hold_anchors", "length_std_m", "propose", "grid", "frame"].every((key) => !(key in bare)));
});

test("in space a proposal has 125 candidates", () => {
  const axes = gridOf([0, 1, 2].map((k) => [k, [-1, 1]]));
  assert.equal(
    axes.reduce((product, { count }) => product * count, 1),
    125,
  );
});

test("a field that is no number of its kind is named", () => {
  for (const [id, text] of [
    ["calibrate-deviation", "-1"],
    ["calibrate-deviation", "wide"],
    ["calibrate-propose", "2.5"],
    ["calibrate-propose", "101"],
  ]) {
    assert.throws(
      () => requestOf(given({ [id]: text })),
      (error) => error instanceof WrongField && error.id === id && error.message.includes(`“${text}”`),
    );
  }
});

test("the command has the same options", () => {
  const request = { ...requestOf(given()), leave_out: [2, 5] };
  assert.equal(
    calibrateCommand({ file: "machine.toml", readings: "my belts.csv", request }).replace(/ \\\n {2}/g, " "),
    "funicular calibrate machine.toml --readings 'my belts.csv' --unknowns anchors,offsets --leave-out 2,5 " +
      "--hold-anchors bl,br --length-std-m 0.0005 --static-model ideal --propose 2 --grid x=0.44:3.96:9 " +
      "--grid y=0.37:3.33:9 --set platform.mass_kg=9",
  );
});
