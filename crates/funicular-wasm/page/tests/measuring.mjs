// Calibration from a table of lengths and the reach of the platform, in headless Chromium against the native program. Run
// by scripts/test-web.
//
// FUNICULAR_WEB: folder of the page. FUNICULAR_PROGRAM: the native program. FUNICULAR_BROWSER: Chromium.

import assert from "node:assert/strict";
import { spawnSync } from "node:child_process";
import { mkdirSync, mkdtempSync, readFileSync, rmSync, writeFileSync } from "node:fs";
import { tmpdir } from "node:os";
import { join, resolve } from "node:path";
import { after, before, test } from "node:test";
import { fileURLToPath, pathToFileURL } from "node:url";
import { chromium } from "playwright-core";

const web = resolve(process.env.FUNICULAR_WEB);
const program = resolve(process.env.FUNICULAR_PROGRAM);
const address = pathToFileURL(join(web, "funicular.html")).href;
const pictures = join(web, "screenshots");
const folder = mkdtempSync(join(tmpdir(), "funicular-measuring-"));
const project = (path) => fileURLToPath(new URL(`../../../../${path}`, import.meta.url));
const MACHINE = project("docs/calibration/machine.toml");
const BELTS = project("docs/calibration/belts.csv");
const PATIENCE_MS = 120_000;

let browser, page;
const faults = [];

before(async () => {
  mkdirSync(pictures, { recursive: true });
  browser = await chromium.launch({
    executablePath: process.env.FUNICULAR_BROWSER,
    args: ["--no-sandbox", "--disable-dev-shm-usage", "--disable-gpu", "--enable-unsafe-swiftshader"],
  });
  page = await opened();
});

after(async () => {
  await browser?.close();
  rmSync(folder, { recursive: true });
});

async function opened(options = {}) {
  const context = await browser.newContext({ viewport: { width: 1440, height: 900 }, ...options });
  const made = await context.newPage();
  made.setDefaultTimeout(PATIENCE_MS);
  made.on("pageerror", (error) => faults.push(error.stack));
  made.on("console", (message) => message.type() === "error" && faults.push(message.text()));
  await made.goto(address);
  await idle(made);
  return made;
}

const idle = (of = page) => of.waitForFunction(() => window.funicular?.idle);
const text = (selector, of = page) => of.locator(selector).innerText();

function native(words, status = 0) {
  const done = spawnSync(program, words, { encoding: "utf8", cwd: folder, maxBuffer: 1 << 28 });
  assert.equal(done.status, status, done.stderr);
  return status ? done.stderr : JSON.parse(done.stdout);
}

/** Opens the machine whose belts were read. */
async function machine(of = page) {
  await of.setInputFiles("#files", MACHINE);
  await of.waitForFunction(() => window.funicular.content.robot.name === "machine.toml" && window.funicular.idle);
}

/** Waits for the answer of the search, or of the linear equations. */
const answered = (kind, of = page) =>
  of.waitForFunction((wanted) => document.getElementById("calibrate").dataset.shown === wanted, kind);

/** Columns of the table of values: path, value. */
const values = (of = page) =>
  of.evaluate(() =>
    [...document.querySelectorAll("#calibrate-values tbody tr")].map((row) => [
      row.cells[0].textContent,
      Number(row.cells[2].textContent.replace("−", "-")),
      row.cells[5].textContent,
    ]),
  );

/** Compares the table of values with those of the program, which are rounded to six digits in the page. */
function compare(shown, { values: expected }) {
  assert.deepEqual(
    shown.map(([path]) => path),
    expected.map(({ path }) => path),
  );
  expected.forEach(({ path, value }, k) => assert.ok(Math.abs(shown[k][1] - value) < 2e-5, `${path}: ${shown[k][1]}`));
}

/** Anchors of the view by the kind of their points. */
const placesOf = (kind, of = page) =>
  of.evaluate((name) => {
    const { group } = window.funicular.view.calibration;
    const found = group.children.find((part) => part.name === name);
    return found ? [...found.geometry.attributes.position.array] : [];
  }, kind);

const CANDIDATES = ["--propose", "3", "--grid", "x=0.44:3.96:9", "--grid", "y=0.37:3.33:9"];
const GIVEN = ["calibrate", MACHINE, "--readings", BELTS, ...CANDIDATES, "--format", "json"];

test("a table that is chosen calibrates the open robot as the program does", async () => {
  await machine();
  await page.setInputFiles("#calibrate-file", BELTS);
  await answered("search");
  const expected = native(GIVEN);
  compare(await values(), expected);
  const told = await text("#calibrate");
  for (const sentence of [expected.fit, expected.determined, expected.weak_combinations[0].words]) {
    assert.ok(told.includes(sentence), `${sentence} is not in ${told}`);
  }
  assert.equal(await page.locator("#calibrate-rows tbody tr").count(), 6);
  assert.equal(await page.locator("#calibrate-residuals circle").count(), 24);
  const residual = expected.rows[2].residuals[1].residual_m * 1000;
  const cell = await text("#calibrate-rows tbody tr:nth-child(3) td:nth-child(3)");
  assert.ok(Math.abs(Number(cell.replace("−", "-")) - residual) < 5e-3 * Math.abs(residual), cell);

  // The view has the calibrated anchors with their ellipsoids, and the proposed poses in their order.
  const near = (found, wanted, what) =>
    wanted.forEach((value, k) => assert.ok(Math.abs(found[k] - value) < 1e-5, `${what}: ${found} ${wanted}`));
  near(
    await placesOf("calibrated"),
    expected.anchors.flatMap(({ position_m: at }) => at),
    "anchors",
  );
  near(
    await placesOf("next"),
    expected.proposals.flatMap(({ position_m: at }) => at),
    "proposals",
  );
  const halfAxes = await page.evaluate(() => {
    const bodies = window.funicular.view.calibration.group.children.filter(({ name }) => name === "ellipsoid");
    return bodies.map(({ matrix: { elements: e } }) => Math.hypot(e[0], e[4], e[8]));
  });
  const deviations = expected.anchors.map(({ covariance_m2: of }) => Math.sqrt(of[0][0]));
  assert.equal(halfAxes.length, 4);
  halfAxes.forEach((half, i) => near([half / halfAxes[0]], [deviations[i] / deviations[0]], "ellipsoid"));
  await page.locator("#calibrate-fit").scrollIntoViewIfNeeded();
  await page.screenshot({ path: join(pictures, "calibration.png") });
});

test("a row that is clicked away is fitted again at once, and then by the whole search", async () => {
  const whole = await values();
  const anchors = await placesOf("calibrated");
  // The worker of the search answers later: until then the page shows the linear refit.
  const first = await page.evaluate(() => {
    const begin = performance.now();
    document.querySelector("[data-row='3']").click();
    const milliseconds = performance.now() - begin;
    const moved = document.querySelector("#calibrate-values tbody tr:nth-child(6) td:nth-child(6)").textContent;
    return { kind: document.getElementById("calibrate").dataset.shown, milliseconds, moved };
  });
  assert.equal(first.kind, "linear");
  // The program says how far a value moves in its linear equations: 70.2 mm.
  const largest = native(GIVEN).rows[2].shift_m;
  assert.ok(/^moves by/.test(first.moved) && largest > 0.05, `${first.moved} ${largest}`);
  assert.ok(first.milliseconds < 500, `the refit takes ${first.milliseconds} ms`);

  await answered("search");
  const expected = native([...GIVEN, "--leave-out", "3"]);
  compare(await values(), expected);
  assert.notDeepEqual(await placesOf("calibrated"), anchors);
  assert.equal((await placesOf("away")).length, 3);
  assert.ok((await text("#calibrate pre")).includes("--leave-out 3"));
  assert.equal(await page.locator("#calibrate-rows input:not(:checked)").count(), 1);

  // Taken in again, it is the fit of all rows, without a search.
  await page.click("[data-row='3']");
  assert.equal(await page.getAttribute("#calibrate", "data-shown"), "search");
  assert.deepEqual(await values(), whole);
});

test("rows without which nothing is determined are told in the program's words", async () => {
  for (const row of [1, 2, 3, 4, 5]) {
    await page.click(`[data-row='${row}']`);
  }
  await page.waitForSelector("#calibrate-fit [role=alert]");
  const refused = native([...GIVEN, "--leave-out", "1,2,3,4,5"], 2)
    .replace(/^error: /, "")
    .trim();
  const told = (await text("#calibrate-fit")).trim();
  assert.ok(refused.startsWith(told.slice(0, 60)), `${told}\n${refused}`);
  for (const row of [1, 2, 3, 4, 5]) {
    await page.click(`[data-row='${row}']`);
  }
  assert.equal(await page.getAttribute("#calibrate", "data-shown"), "search");
});

/** Waits for an alert of the calibration: the one before may still be there while the next answer is computed. */
async function alerted(message) {
  await page.waitForFunction(
    ({ source, flags }) => {
      const alert = document.querySelector("#calibrate [role=alert]");
      return alert && new RegExp(source, flags).test(document.getElementById("calibrate").textContent);
    },
    { source: message.source, flags: message.flags },
  );
}

test("a wrong table, field or choice is told at its place", async () => {
  await page.fill("#calibrate-deviation", "wide");
  await page.click("#calibrate-form button:not([type])");
  assert.match(await text("#calibrate-form .field-message"), /“wide” is not a deviation in millimetres/);
  await page.fill("#calibrate-deviation", "");

  for (const [table, message] of [
    ["length_bl_mm,length_br_mm\n1,x\n", /line 2, column `length_br_mm`.*x/s],
    ["length_bl_mm,length_xx_mm\n1,2\n", /there is a column `length_xx_m`.*did you mean/s],
    ["length_bl_mm,length_br_mm,length_tr_mm,length_tl_mm\n3000,3000,3000,3000\n", /at least|rows/],
  ]) {
    writeFileSync(join(folder, "wrong.csv"), table);
    await page.setInputFiles("#calibrate-file", join(folder, "wrong.csv"));
    await alerted(message);
    assert.deepEqual(await placesOf("calibrated"), []);
  }

  // A pasted table, and without any unknown.
  await page.evaluate(() => (document.querySelector(".small-part").open = true));
  await page.fill("#calibrate-text", readFileSync(BELTS, "utf8"));
  await page.locator("#calibrate-text").dispatchEvent("change");
  await page.waitForFunction(() => /pasted table: 6 rows/.test(document.getElementById("calibrate-name").textContent));
  await page.uncheck("[data-unknown='anchors']");
  await page.click("#calibrate-form button:not([type])");
  await alerted(/`unknowns` is empty: name at least one of anchors, attachments/);
  await page.check("[data-unknown='anchors']");
});

test("the calibrated robot is taken, and the calibration of a changed robot is old", async () => {
  await page.click("#calibrate-form button:not([type])");
  await answered("search");
  const expected = native(GIVEN);
  await page.click("#calibrate-take");
  await page.waitForFunction((y) => {
    const anchor = window.funicular.frame?.cables[2].anchor;
    return anchor && Math.abs(anchor[1] - y) < 1e-6;
  }, expected.anchors[2].position_m[1]);
  await idle();
  assert.equal(await text("#calibrate"), "", "another robot has no calibration yet");

  await page.click("#calibrate-form button:not([type])");
  await answered("search");
  await page.fill("[data-number='platform.mass_kg']", "9");
  await page.keyboard.press("Enter");
  await page.waitForFunction(() => document.getElementById("calibrate").classList.contains("stale"));
});

test("30 rows of a rigid platform with eight cables do not stop the page", async (t) => {
  // Readings of CoGiRo at turned poses, from its own lengths with cables that neither sag nor stretch.
  await page.selectOption("#library", "cogiro");
  await page.waitForFunction(() => window.funicular.content.robot.name === "cogiro" && window.funicular.idle);
  const poses = Array.from({ length: 30 }, (_, i) => {
    const turn = (k, size) => size * Math.sin(1.7 * (i + 1) * (k + 1) + k);
    return [turn(0, 4), turn(1, 3), 2 + turn(2, 1), turn(3, 8), turn(4, 8), turn(5, 8)];
  });
  const robot = project("robots/cogiro.toml");
  const rows = poses.map((pose) => {
    const found = native([
      "statics",
      robot,
      `--pose=${pose.map((value) => value.toFixed(6)).join(",")}`,
      "--static-model",
      "ideal",
      "--format",
      "json",
    ]);
    return [...found.cables.map((cable) => cable.unstrained_length_m), ...pose.map((value) => value.toFixed(6))];
  });
  const names = native(["check", robot, "--format", "json"]).cables.map(({ name }) => `length_${name}_m`);
  const head = [...names, "x_m", "y_m", "z_m", "roll_deg", "pitch_deg", "yaw_deg"];
  const table = join(folder, "cogiro.csv");
  // A millimetre of noise.
  const noisy = rows.map((row, i) =>
    row.map((value, k) => (k < 8 ? value + 1e-3 * Math.sin(7 * i + 3 * k * k) : value)),
  );
  writeFileSync(table, `${[head, ...noisy].map((row) => row.join(",")).join("\n")}\n`);

  await page.fill("#calibrate-propose", "2");
  const begin = Date.now();
  await page.setInputFiles("#calibrate-file", table);
  // While the search runs, the page says so and answers: a frame of the screen takes no longer than usual.
  const longest = await page.evaluate(async () => {
    let most = 0;
    let before = performance.now();
    for (let i = 0; i < 60 && document.getElementById("calibrate").dataset.shown !== "search"; i += 1) {
      await new Promise((done) => setTimeout(done, 20));
      most = Math.max(most, performance.now() - before - 20);
      before = performance.now();
    }
    return most;
  });
  await answered("search");
  t.diagnostic(`30 rows: ${Date.now() - begin} ms, the page waited for at most ${longest.toFixed(0)} ms`);
  assert.ok(longest < 1000, `the page stood still for ${longest} ms`);
  assert.equal(await page.locator("#calibrate-rows tbody tr").count(), 30);
  const refit = await page.evaluate(() => {
    const start = performance.now();
    document.querySelector("[data-row='7']").click();
    return performance.now() - start;
  });
  t.diagnostic(`linear refit of 24 values with its picture: ${refit.toFixed(0)} ms`);
  assert.equal(await page.getAttribute("#calibrate", "data-shown"), "linear");
  const again = Date.now();
  await answered("search");
  t.diagnostic(`search without row 7: ${Date.now() - again} ms`);
  await page.screenshot({ path: join(pictures, "calibration-space.png") });
});

/** Waits for the rays of a platform at rest: 258, or fewer on a machine that is slow. */
const rested = () =>
  page.waitForFunction(() => {
    const { done, rays: count } = document.getElementById("reach-note").dataset;
    return done === "rested" && Number(count) >= 66;
  });
const rays = (of = page) => of.evaluate(() => ({ ...document.getElementById("reach-note").dataset }));

test("the reach ends where the program says that the tensions end", async () => {
  await page.selectOption("#library", "cogiro");
  await rested();
  const note = await text("#reach-note");
  const [, metres, sign, axis] = /^([\d.]+) m to the nearest border, towards ([+−])([xyz])/.exec(note);
  assert.ok(Number(metres) > 0.1 && sign && axis, note);

  // Inside every end of a ray there is an equilibrium within the limits, and beyond it none.
  const ends = await page.evaluate(() => {
    const { view, frame } = window.funicular;
    return { points: [...view.reach.borders.geometry.attributes.position.array], from: frame.position };
  });
  const angles = await page.evaluate(() => window.funicular.frame.angles);
  const at = (i, factor) => {
    const end = ends.points.slice(3 * i, 3 * i + 3);
    return [...end.map((value, k) => ends.from[k] + factor * (value - ends.from[k])), ...angles];
  };
  const robot = { text: readFileSync(project("robots/cogiro.toml"), "utf8") };
  const feasible = async (poses) =>
    (
      await page.evaluate((request) => window.funicular.ask(request), {
        command: "map",
        robot,
        quantities: ["tension-max"],
        poses,
      })
    ).columns.feasible;
  const some = [0, 3, 9, 15, 22, 30];
  assert.deepEqual(
    await feasible(some.map((i) => at(i, 0.97))),
    some.map(() => true),
  );
  assert.deepEqual(
    await feasible(some.map((i) => at(i, 1.03))),
    some.map(() => false),
  );
});

test("while the platform is dragged few rays follow it, and they can be switched off", async (t) => {
  const start = await text("#reach-note");
  await page.evaluate(() => window.funicular.view.look("front"));
  await page.waitForTimeout(300);
  const from = await page.evaluate(() => {
    const { view } = window.funicular;
    const box = view.canvas.getBoundingClientRect();
    const point = view.handle.position.clone().project(view.camera);
    return { x: box.left + ((point.x + 1) * box.width) / 2, y: box.top + ((1 - point.y) * box.height) / 2 };
  });
  await page.mouse.move(from.x + 45, from.y, { steps: 4 });
  await page.waitForFunction(() => window.funicular.view.controls.axis === "X");
  await page.mouse.down();
  await page.mouse.move(from.x + 110, from.y, { steps: 10 });
  await page.waitForFunction((before) => document.getElementById("reach-note").textContent !== before, start);
  await page.waitForFunction(() => Number(document.getElementById("reach-note").dataset.rays) <= 18);
  const dragged = await rays();
  assert.ok(await page.evaluate(() => window.funicular.view.reach.group.visible && window.funicular.view.dragging));
  await page.screenshot({ path: join(pictures, "reach-dragged.png") });
  await page.mouse.up();
  await rested();
  t.diagnostic(`${dragged.rays} rays while dragged: the last level took ${dragged.milliseconds} ms`);
  await page.screenshot({ path: join(pictures, "reach.png") });

  await page.uncheck("#reach");
  assert.equal(await text("#reach-note"), "");
  assert.equal(await page.evaluate(() => window.funicular.view.reach.group.visible), false);
  await page.check("#reach");
  await rested();
});

test("a robot whose reach is not searched says why, and a planar one has rays in its plane", async () => {
  await page.selectOption("#library", "grab-3-cables");
  await page.waitForFunction(() => /fewer cables than degrees/.test(document.getElementById("reach-note").textContent));
  await page.selectOption("#library", "kntu-planar");
  await page.waitForFunction(() => /rays\)\.$|^Everywhere/.test(document.getElementById("reach-note").textContent));
});

test("on a phone the calibration fits into one column", async () => {
  const phone = await opened({ viewport: { width: 390, height: 844 }, hasTouch: true, isMobile: true });
  await machine(phone);
  await phone.setInputFiles("#calibrate-file", BELTS);
  await answered("search", phone);
  assert.ok((await phone.evaluate(() => document.documentElement.scrollWidth)) <= 390);
  await phone.locator("#calibrate-fit").scrollIntoViewIfNeeded();
  await phone.screenshot({ path: join(pictures, "calibration-phone.png") });
  await phone.screenshot({ path: join(pictures, "calibration-phone-whole.png"), fullPage: true });
  await phone.context().close();
});

test("nothing failed on the console", () => {
  assert.deepEqual(faults, []);
});
