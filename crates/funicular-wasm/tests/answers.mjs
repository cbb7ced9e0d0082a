// Compares the answers of the module under Node with those of the native program. Run by scripts/web.
//
// FUNICULAR_WEB: folder with funicular.wasm and funicular.js. FUNICULAR_PROGRAM: the native program.

import assert from "node:assert/strict";
import { spawnSync } from "node:child_process";
import { mkdtempSync, readFileSync, rmSync, writeFileSync } from "node:fs";
import { tmpdir } from "node:os";
import { join, resolve } from "node:path";
import { after, test } from "node:test";
import { pathToFileURL } from "node:url";

const web = resolve(process.env.FUNICULAR_WEB);
const program = resolve(process.env.FUNICULAR_PROGRAM);
const { BrokenError, RequestError, load } = await import(pathToFileURL(join(web, "funicular.js")));
const bytes = readFileSync(join(web, "funicular.wasm"));
const funicular = await load(bytes);
const folder = mkdtempSync(join(tmpdir(), "funicular-web-"));
after(() => rmSync(folder, { recursive: true }));

const robots = Object.fromEntries(
  ["cogiro", "yuan2014-4mm"].map((name) => [name, readFileSync(new URL(`../../../robots/${name}.toml`, import.meta.url), "utf8")]),
);

// The answers differ by rounding for two reasons. The native program uses sin, cos, exp and log of the platform's
// mathematics library, and WebAssembly those of Rust. The native vector kernels multiply and add with one rounding, and
// WebAssembly with two. Differences are relative to the largest number beside a value. Equilibria and frequencies differ
// by some 1e-12. A response beside a resonance differs by 1e-10: the rounding of the frequency divided by the damping.
const ROUNDING = 1e-9;
// By first-order perturbation the error of a shape is the rounding of its matrix divided by the relative distance to the
// next frequency. Observed: 6e-12.
const ROUNDING_OF_SHAPES = 1e-10;
// Residuals, and the number of iterations until they are small, consist of rounding.
const LEFT_OVER = new Set(["residual", "iterations"]);
// Differences and correlations are fractions of one. Near zero their error is the rounding of the compared numbers.
const FRACTIONS = new Set(["relative_difference", "correlation"]);

let most = 0;

/** Compares two JSON values: texts and counts exactly, numbers to `limit` of `scale`, the largest number beside them. */
function compare(found, expected, path = "", scale = 0, limit = ROUNDING) {
  if (typeof expected === "number") {
    assert.equal(typeof found, "number", path);
    const key = path.split(".").pop();
    if (LEFT_OVER.has(key)) {
      return;
    }
    const difference = Math.abs(found - expected) / Math.max(FRACTIONS.has(key) ? 1 : scale, Math.abs(expected), Number.MIN_VALUE);
    most = Math.max(most, difference);
    assert.ok(difference <= limit, `${path}: ${found} here, ${expected} natively, differ by ${difference} > ${limit}`);
  } else if (Array.isArray(expected)) {
    assert.ok(Array.isArray(found), path);
    assert.equal(found.length, expected.length, `${path}: numbers of entries`);
    const numbers = expected.flat(Infinity).filter((value) => typeof value === "number").map(Math.abs);
    const limits = limitsOfShapes(expected);
    expected.forEach((value, i) => compare(found[i], value, `${path}[${i}]`, Math.max(scale, ...numbers), limits?.[i] ?? limit));
  } else if (expected !== null && typeof expected === "object") {
    assert.deepEqual(Object.keys(found), Object.keys(expected), path);
    for (const key of Object.keys(expected)) {
      const frequency = key === "frequency_hz" || key === "damping_ratio" || key === "eigenvalue_per_s";
      compare(found[key], expected[key], `${path}.${key}`, 0, frequency ? ROUNDING : limit);
    }
  } else {
    // A message names an option of the program by its key.
    const inKeys = (text) => text.replace(/--([a-z-]+)/g, (_, option) => `\`${option.replaceAll("-", "_")}\``);
    assert.equal(found, typeof expected === "string" ? inKeys(expected) : expected, path);
  }
}

/** Limits for a list of modes, one per mode, for its shape and the numbers computed from it; undefined for other lists. */
function limitsOfShapes(list) {
  if (!list.every((mode) => mode?.frequency_hz !== undefined && mode.shape !== undefined)) {
    return undefined;
  }
  const hz = list.map((mode) => mode.frequency_hz);
  const gap = (i) => Math.min(...[i - 1, i + 1].filter((j) => j in hz).map((j) => Math.abs(hz[j] / hz[i] - 1)), 1);
  return hz.map((_, i) => Math.max(ROUNDING, ROUNDING_OF_SHAPES / gap(i)));
}

function native(request) {
  const file = join(folder, "request.json");
  writeFileSync(file, JSON.stringify(request));
  return spawnSync(program, ["request", file, "--format", "json"], { encoding: "utf8", maxBuffer: 1 << 28 });
}

/** Asserts that work is refused with a status and a message. */
const refused = (work, status, message) =>
  assert.throws(work, (error) => error instanceof RequestError && error.status === status && message.test(error.message));

/** Time of the fastest of several runs [ms], as text. */
function fastest(work) {
  const times = Array.from({ length: 5 }, () => {
    const begin = performance.now();
    work();
    return performance.now() - begin;
  });
  return `${Math.min(...times).toFixed(1)} ms`;
}

const at = { pose: [1, 2, 1.5] };
const range = { from_hz: 1, to_hz: 30, points: 400 };
const requests = {
  "check": { command: "check" },
  "statics": { command: "statics", ...at },
  "statics, limits and wind": {
    command: "statics", ...at, tension_rule: "middle", max_tension_n: 2500, wind_m_s: [5, 0, 0],
  },
  "stiffness": { command: "stiffness", ...at },
  "stiffness at 10 Hz": { command: "stiffness", ...at, at_hz: 10 },
  "modes": { command: "modes", ...at, below_hz: 15 },
  "modes, undamped": { command: "modes", ...at, below_hz: 15, damped: false },
  "frf": { command: "frf", ...at, ...range, input: "fz", output: "z" },
  "compare": { command: "compare", ...at, below_hz: 8 },
};
for (const robot of Object.keys(robots)) {
  for (const [name, command] of Object.entries(requests)) {
    // A planar robot or a robot with few cables has its own state in the file.
    const { pose, ...own } = command;
    const request = robot === "cogiro" ? command : own;
    if (robot !== "cogiro" && command.tension_rule) {
      continue;
    }
    test(`${robot}: ${name}`, (t) => {
      const whole = { ...request, robot: { name: robot, text: robots[robot] } };
      const expected = native(whole);
      assert.equal(expected.status, 0, expected.stderr);
      const text = funicular.answerText(JSON.stringify(whole));
      if (text === expected.stdout) {
        t.diagnostic("bit for bit");
      } else {
        most = 0;
        compare(JSON.parse(text), JSON.parse(expected.stdout));
        t.diagnostic(`largest difference ${most.toExponential(1)}`);
      }
      assert.deepEqual(funicular.answer(request, robots[robot], robot), JSON.parse(text));

      const here = fastest(() => funicular.answerText(JSON.stringify(whole)));
      t.diagnostic(`${here}; the native program with its start ${fastest(() => native(whole))}`);
    });
  }
}

test("a map is statics at every point, those without solution among them", () => {
  let solved = 0;
  for (const x of [-4, 0, 4]) {
    for (const y of [-3, 0, 30]) {
      const request = { command: "statics", pose: [x, y, 1], robot: { name: "cogiro", text: robots.cogiro } };
      const expected = native(request);
      try {
        compare(funicular.answer(request), JSON.parse(expected.stdout || "null"));
        solved += 1;
      } catch (error) {
        assert.ok(error instanceof RequestError, error);
        assert.deepEqual([error.status, `error: ${error.message}\n`], [expected.status, expected.stderr]);
      }
    }
  }
  assert.equal(solved, 6);
});

test("errors are those of the program, with the same status", () => {
  const damaged = robots.cogiro.replace("[platform]", "[platfrom]").replace("mass_kg", "mass_kgg");
  for (const request of [
    { command: "check", robot: { name: "damaged.toml", text: damaged } },
    { command: "check", robot: { name: "cut.toml", text: robots.cogiro.slice(0, 700) } },
    { command: "statics", robot: { text: "" } },
    { command: "statics", robot: { text: "[".repeat(100000) } },
    { command: "statics", robot: { name: "", text: robots.cogiro }, poze: [0, 0, 1] },
    { command: "statics", robot: { name: "", text: robots.cogiro }, pose: [1e300, 0, 1] },
    { command: "modes" },
  ]) {
    const expected = native(request);
    assert.notEqual(expected.status, 0);
    assert.throws(() => funicular.answer(request), (error) => {
      assert.ok(error instanceof RequestError, String(error));
      assert.equal(error.status, expected.status);
      // The program's message names the file of the request and shows keys as its options.
      const words = expected.stderr.trimEnd().replace(/^error: /, "").replace(join(folder, "request.json") + ": ", "");
      const keys = words.replace(/--([a-z-]+)/g, (_, name) => "`" + name.replaceAll("-", "_") + "`");
      assert.equal(error.message.replace(/^error: /, ""), keys);
      return true;
    });
  }
  assert.throws(() => funicular.answerText("{"), { name: "RequestError", status: 2, message: /^the request is not valid JSON/ });
  assert.throws(() => funicular.answerText("[".repeat(100000)), { name: "RequestError", status: 2 });
  assert.throws(() => funicular.answer({ command: "paper" }), { status: 2, message: /writes a file/ });
  assert.throws(() => funicular.answer({ command: "validate" }), { status: 2, message: /this build leaves out/ });
});

test("what is refused leaves nothing of the state or robot before", async () => {
  const own = await load(bytes);
  const followers = [() => own.mode(0, 9), () => own.platform(), () => own.response({ input: "fz", output: "az", ...range })];
  const ready = () => {
    own.robot({ robot: { text: robots.cogiro } });
    assert.equal(own.frame(1, at.pose, 5, 9).numbers[2], 5);
    followers.forEach((work) => work());
  };
  for (const [state, status] of [[[99, 2, 1.5], 1], [[1, NaN, 1.5], 2], [[1, 2], 2]]) {
    ready();
    refused(() => own.frame(1, state, 5, 9), status, /./);
    followers.forEach((work) => refused(work, 2, /^there is no frame, or the last one was refused/));
  }
  for (const text of [robots.cogiro.slice(0, 700), ""]) {
    ready();
    refused(() => own.robot({ robot: { text } }), 2, /./);
    [() => own.frame(1, at.pose, 5, 9), ...followers].forEach((work) => refused(work, 2, /^there is no robot, or the last one was refused/));
  }
});

test("the search for the first mode of the platform gives the program's", () => {
  const text = readFileSync(new URL("hall.toml", import.meta.url), "utf8");
  const { check } = funicular.robot({ robot: { text } });
  funicular.frame(0, [], 20, 0);
  const { numbers, about } = funicular.platform();
  const { modes, first_platform_mode: first } = JSON.parse(native({ command: "modes", robot: { text }, below_hz: about.below_hz, damped: false }).stdout);
  const each = numbers.length / (about.index + 1);
  assert.deepEqual([about.index, each, first.index], [26, 12 + check.cables.length, 26]);
  modes.slice(0, 27).forEach((mode, i) => compare(numbers[i * each], mode.frequency_hz, `frequency ${i + 1}`));
});

test("a simulation gives the program's rows, and a picture whose cables end at their anchors", () => {
  const robot = { text: robots.cogiro };
  const request = { command: "simulate", robot, scenario: { release: [{ at_s: 0.01, mass_kg: 5 }] }, duration_s: 0.05, sample_time_s: 0.01, once: true };
  const found = funicular.answer(request);
  const expected = JSON.parse(native(request).stdout);
  found.rows.forEach((row, k) => {
    row.position_m.forEach((x, axis) => assert.ok(Math.abs(x - expected.rows[k].position_m[axis]) < 1e-7, `row ${k}`));
  });
  const { picture } = found;
  assert.deepEqual(picture.t_s, found.rows.map((row) => row.t_s));
  const { check } = funicular.robot({ robot });
  picture.curves_m.forEach((curves) => curves.forEach((curve, i) => {
    curve.slice(-3).forEach((x, axis) => assert.ok(Math.abs(x - check.cables[i].anchor_m[axis]) < 1e-9, `cable ${i}`));
  }));
  picture.poses.forEach((pose, k) => assert.deepEqual(pose.slice(0, 3), found.rows[k].position_m));
});

test("a calibration of a table gives the program's, and the linear equations of its rows", () => {
  const own = (path) => readFileSync(new URL(`../../../docs/calibration/${path}`, import.meta.url), "utf8");
  const readings = funicular.table(own("belts.csv"), "belts.csv");
  assert.ok(Math.abs(readings.length_bl_m[0] - 2.96058) < 1e-15, "lengths in millimetres become metres");
  const request = { command: "calibrate", robot: { text: own("machine.toml") }, readings, leave_out: [2] };
  const { refit, ...found } = funicular.answer(request);
  const expected = JSON.parse(native(request).stdout);
  // Two anchors are known worst by ±60 mm, and rounding moves them by as much more than a length as they are known worse.
  assert.deepEqual(found.rows.map(({ row }) => row), [1, 3, 4, 5, 6]);
  found.values.forEach(({ path, value }, k) => {
    assert.equal(path, expected.values[k].path);
    assert.ok(Math.abs(value - expected.values[k].value) < 1e-6, `${path}: ${value} ${expected.values[k].value}`);
  });
  assert.deepEqual([refit.rows, refit.linear.rows.length, refit.values.length], [[1, 3, 4, 5, 6], 5, 8]);
  refused(() => funicular.table("a,b\n1,x\n", "my table.csv"), 2, /^my table\.csv, line 2, column `b`/);
  refused(() => funicular.answer({ ...request, leave_out: [7] }), 2, /`leave_out` 7: there is no such row: give numbers from 1 to 6/);
});

test("the reach of a platform ends where its equilibria end", () => {
  funicular.robot({ robot: { text: robots.cogiro } });
  const at = [0.5, 0, 1.5, 1, 0, 0, 0];
  const level = (k) => funicular.reach(at, k);
  assert.deepEqual([0, 1, 2].map((k) => level(k).numbers.length / 5), [6, 12, 48]);
  const { numbers, about } = level(0);
  assert.deepEqual([about.is_inside, about.is_in_box], [true, true]);
  const rays = Array.from({ length: 6 }, (_, i) => numbers.subarray(5 * i, 5 * i + 5)).filter((ray) => ray[4] === 1);
  assert.ok(rays.length > 0);
  const poses = (factor) => rays.map((ray) => [...[0, 1, 2].map((k) => at[k] + factor * (ray[k] - at[k])), 0, 0, 0]);
  const feasible = (of) => JSON.parse(funicular.answerText(JSON.stringify({ command: "map", robot: { text: robots.cogiro }, quantities: ["tension-max"], poses: of }))).columns.feasible;
  assert.deepEqual(feasible(poses(0.98)), rays.map(() => true));
  assert.deepEqual(feasible(poses(1.02)), rays.map(() => false));
  refused(() => funicular.reach([0, 0, NaN, 1, 0, 0, 0], 0), 2, /finite numbers/);
});

test("the module needs nothing from outside", () => {
  assert.deepEqual(WebAssembly.Module.imports(new WebAssembly.Module(bytes)), []);
});

test("a panic leaves a message, and a new instance works", async () => {
  // A length that no memory can hold is a mistake of the caller. It panics like a mistake in the library.
  const { exports } = await WebAssembly.instantiate(new WebAssembly.Module(bytes));
  assert.throws(() => exports.funicular_input(-1), WebAssembly.RuntimeError);
  const text = new TextDecoder().decode(
    new Uint8Array(exports.memory.buffer, exports.funicular_output(), exports.funicular_output_length()),
  );
  assert.match(text, /^mistake in funicular \S+: capacity overflow \(.+\); please report it with the request/);

  // The loader makes the same call for a text that claims that length.
  const broken = await load(bytes);
  const encode = TextEncoder.prototype.encode;
  TextEncoder.prototype.encode = () => ({ length: 2 ** 32 - 1 });
  try {
    assert.throws(() => broken.answerText("{}"), (error) => error instanceof BrokenError && error.message === text);
  } finally {
    TextEncoder.prototype.encode = encode;
  }
  assert.ok(broken.broken);
  assert.throws(() => broken.answer({ command: "check" }, robots.cogiro), { name: "BrokenError", message: text });
  await broken.renew();
  assert.ok(!broken.broken);
  assert.equal(broken.answer({ command: "check" }, robots.cogiro).command, "check");
});

test("memory does not grow with the number of requests", async () => {
  const { exports } = await WebAssembly.instantiate(new WebAssembly.Module(bytes));
  const request = new TextEncoder().encode(
    JSON.stringify({ command: "modes", ...at, below_hz: 5, robot: { text: robots.cogiro } }),
  );
  const ask = () => {
    const address = exports.funicular_input(request.length);
    new Uint8Array(exports.memory.buffer, address, request.length).set(request);
    assert.equal(exports.funicular_answer(), 0);
    return exports.memory.buffer.byteLength;
  };
  for (let i = 0; i < 3; i++) {
    ask();
  }
  const settled = ask();
  for (let i = 0; i < 20; i++) {
    assert.equal(ask(), settled);
  }
});
