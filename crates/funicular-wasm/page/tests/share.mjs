// Links of the page: every damaged one is told from a whole one, and no part of a state has another form than the page needs.

import assert from "node:assert/strict";
import { test } from "node:test";
import { checked, LinkError, packed, unpacked } from "../src/share.js";

const STATE = {
  version: 1,
  robot: { name: "cogiro", set: [{ path: "platform.mass_kg", value: 120 }] },
  hold: "pose",
  pose: [1, 2, 1.5, 0, 0.25, 0],
  lengths: null,
  start: null,
  rule: "middle",
  pinned: ["platform.mass_kg"],
  more: { force_n: [0, 0, -200] },
  model: {},
  mode: 3,
  modes: 20,
  response: { input: "fz", output: "az", from: 0.05, to: 10, log: false },
  exaggeration: 1,
  camera: [10, -20, 8, 0, 0, 2],
};

const refused = (state, words) =>
  assert.throws(
    () => checked(state),
    (error) => error instanceof LinkError && words.test(error.message),
    JSON.stringify(state),
  );

test("a link has its state", async () => {
  assert.deepEqual(await unpacked(await packed(STATE)), STATE);
});

test("a link of the first versions, without a checksum, is read", async () => {
  const stream = new Blob([JSON.stringify(STATE)]).stream().pipeThrough(new CompressionStream("deflate-raw"));
  const bytes = Buffer.from(await new Response(stream).arrayBuffer());
  assert.deepEqual(await unpacked(bytes.toString("base64url")), STATE);
});

test("a link that was cut or changed at any place is damaged", async () => {
  const link = await packed(STATE);
  for (let i = 0; i < link.length; i += 1) {
    const other = link[i] === "A" ? "B" : "A";
    const changed = `${link.slice(0, i)}${other}${link.slice(i + 1)}`;
    for (const damaged of [link.slice(0, i), changed]) {
      // The last character has bits that belong to no byte.
      const found = await unpacked(damaged).catch((error) => error);
      const same = i === link.length - 1 && JSON.stringify(found) === JSON.stringify(STATE);
      assert.ok(
        same || (found instanceof LinkError && /damaged|no link of this page/.test(found.message)),
        `${i}: ${damaged} gives ${found}`,
      );
    }
  }
  for (const text of ["robot=cogiro", "x", "%20", "ü", "a".repeat(5000)]) {
    await assert.rejects(
      unpacked(text),
      (error) => error instanceof LinkError && error.message.length < 250 && !/atob|fetch|JSON/.test(error.message),
      text,
    );
  }
});

test("a state with a part of another form is refused", () => {
  checked(STATE);
  checked({ version: 1, robot: { name: "", text: "" } });
  const parts = {
    hold: ["poses", 3],
    pose: [[1, 2], "1,2,3", [1, 2, 3, 4, 5, null], {}],
    lengths: [[], ["1"], 3],
    start: [[1, 2, 3]],
    rule: [3],
    pinned: ["a", [1]],
    more: [[], "a", 1],
    model: [[]],
    mode: [-2, 1.5, "1"],
    modes: [0, 201, 1e9, "20"],
    exaggeration: ["1", -1, 1e9],
    camera: [[1], "a"],
    response: [{}, { ...STATE.response, from: "1" }, { ...STATE.response, log: 1 }],
    robot: [
      null,
      "cogiro",
      [],
      {},
      { name: 3 },
      { name: "a", text: 3 },
      { name: "a", set: {} },
      { name: "a", set: [{ value: 1 }] },
    ],
  };
  for (const [key, values] of Object.entries(parts)) {
    values.forEach((value) => refused({ ...STATE, [key]: value }, /damaged/));
  }
  refused({ ...STATE, pose: null }, /damaged/);
  refused({ ...STATE, hold: "lengths" }, /damaged/);
  [null, 3, "a", []].forEach((state) => refused(state, /damaged/));
  refused({ ...STATE, version: 2 }, /another version/);
});
