// The page in headless Chromium, as a person meets it. Run by scripts/test-web.
//
// FUNICULAR_WEB: folder of the page. FUNICULAR_PROGRAM: the native program. FUNICULAR_BROWSER: Chromium.

import assert from "node:assert/strict";
import { spawnSync } from "node:child_process";
import { createServer } from "node:http";
import { mkdirSync, mkdtempSync, readdirSync, readFileSync, rmSync, statSync, writeFileSync } from "node:fs";
import { tmpdir } from "node:os";
import { join, resolve } from "node:path";
import { after, before, test } from "node:test";
import { pathToFileURL } from "node:url";
import { chromium } from "playwright-core";

const web = resolve(process.env.FUNICULAR_WEB);
const program = resolve(process.env.FUNICULAR_PROGRAM);
const address = pathToFileURL(join(web, "funicular.html")).href;
const library = new URL("../../../../robots/", import.meta.url);
const robots = readdirSync(library)
  .filter((name) => name.endsWith(".toml") && name !== "Cargo.toml")
  .map((name) => name.replace(".toml", ""));
const pictures = join(web, "screenshots");
const folder = mkdtempSync(join(tmpdir(), "funicular-page-"));
const PATIENCE_MS = 60_000;

let browser, context, page;
const faults = []; // errors on the console, exceptions, and requests to anything but the file itself

before(async () => {
  mkdirSync(pictures, { recursive: true });
  browser = await chromium.launch({
    executablePath: process.env.FUNICULAR_BROWSER,
    // As on a computer without a graphics card: the 3D view is drawn by software, and the page itself without it.
    args: [
      "--no-sandbox",
      "--disable-dev-shm-usage",
      "--disable-gpu",
      "--enable-unsafe-swiftshader",
      "--proxy-server=127.0.0.1:9",
    ],
  });
  page = await opened(address);
});

after(async () => {
  await browser?.close();
  rmSync(folder, { recursive: true });
});

/** Opens the page in a new window. */
async function opened(url, options = {}) {
  context = await browser.newContext({ viewport: { width: 1440, height: 900 }, acceptDownloads: true, ...options });
  const made = await context.newPage();
  made.setDefaultTimeout(PATIENCE_MS);
  made.on("console", (message) => {
    if (["error", "warning"].includes(message.type()) && !/GPU stall|GL Driver/.test(message.text())) {
      faults.push(`console: ${message.text()}`);
    }
  });
  made.on("pageerror", (error) => faults.push(`exception: ${error.stack}`));
  made.on("request", (request) => {
    if (!/^(blob:|data:)/.test(request.url()) && request.url().split("#")[0] !== url.split("#")[0]) {
      faults.push(`request: ${request.url()}`);
    }
  });
  await made.goto(url);
  await idle(made);
  return made;
}

/** Waits until everything that the last action asked for is computed. */
async function idle(of = page) {
  await of.waitForFunction(() => window.funicular?.idle);
}

/** Does something and waits for the frame that follows from it. */
async function framed(work, of = page) {
  const old = await of.evaluate(() => {
    window.funicular.old = window.funicular.frame;
    return true;
  });
  assert.ok(old);
  await work();
  await of.waitForFunction(() => window.funicular.frame !== window.funicular.old && window.funicular.idle);
}

const frame = (of = page) =>
  of.evaluate(() => {
    const { frame: found } = window.funicular;
    const plain = (cable) => ({ ...cable, points: undefined, attachment: undefined, anchor: undefined });
    return { ...found, cables: found.cables.map(plain) };
  });
const text = (selector, of = page) => of.locator(selector).innerText();
const choose = (robot) => framed(() => page.selectOption("#library", robot));
const near = (a, b, limit, what) =>
  assert.ok(Math.abs(a - b) <= limit * Math.max(Math.abs(b), 1e-300), `${what}: ${a} in the page, ${b} natively`);

function native(request) {
  const file = join(folder, "request.json");
  writeFileSync(file, JSON.stringify(request));
  const done = spawnSync(program, ["request", file, "--format", "json"], { encoding: "utf8", maxBuffer: 1 << 28 });
  assert.equal(done.status, 0, done.stderr);
  return JSON.parse(done.stdout);
}

// Rounding differs for the reasons that docs/web.md gives: sin, exp and log, and multiply-add with one rounding or two.
// Observed over the library: lengths and tensions equal bit for bit, frequencies within 7e-13. With fewer cables than
// degrees of freedom the pose is the result of a longer iteration, whose rounding adds up: tensions within 9e-13 there.
const STATICS = 1e-12;
const FREQUENCY = 1e-12;
const FEW_CABLES = 1e-11;

for (const robot of robots) {
  test(`${robot}: the page shows the numbers of the native program`, async (t) => {
    if ((await page.inputValue("#library")) !== robot) {
      await choose(robot);
    }
    const found = await frame();
    const few = await page.evaluate(() => window.funicular.freedoms > window.funicular.frame.cables.length);
    const [statics, frequency] = few ? [FEW_CABLES, FEW_CABLES] : [STATICS, FREQUENCY];
    const whole = { robot: { name: robot, text: readFileSync(new URL(`${robot}.toml`, library), "utf8") } };
    const rest = native({ command: "statics", ...whole });
    const most = { length: 0, frequency: 0, tension: 0 };
    const compare = (a, b, limit, what) => {
      const [kind] = what.split(" ");
      most[kind] = Math.max(most[kind], Math.abs(a - b) / Math.max(Math.abs(b), 1e-300));
      near(a, b, limit, what);
    };
    const largest = Math.max(...rest.cables.map((cable) => cable.tension_platform_n));
    rest.cables.forEach((cable, i) => {
      compare(found.cables[i].length, cable.unstrained_length_m, statics, `length of ${cable.name}`);
      const [a, b] = [found.cables[i].tension, cable.tension_platform_n];
      most.tension = Math.max(most.tension, Math.abs(a - b) / largest);
      assert.ok(Math.abs(a - b) <= statics * largest, `tension of ${cable.name}: ${a} and ${b}`);
    });
    // When the page has rested, its list goes on beyond the limit of the frame, up to the first mode of the platform.
    const below_hz = Math.max(found.belowHz, 1.0001 * (found.modes.at(-1)?.hz ?? 0));
    const modes = native({ command: "modes", ...whole, below_hz, damped: false }).modes;
    assert.ok(found.modes.length >= Math.min(20, modes.length), `${found.modes.length} modes`);
    found.modes.forEach((mode, i) => {
      compare(mode.hz, modes[i].frequency_hz, frequency, `frequency ${i + 1}`);
      // The damping of a mode is the mean of that of its parts, weighed with its shape: of the first order in the error of
      // the shape, which is the rounding divided by the distance to the next frequency.
      near(mode.damping, modes[i].damping_ratio, 1e-6, `damping ${i + 1}`);
    });
    // Neighbours with close frequencies may share energy differently; their kinds are compared where they are apart.
    found.modes.forEach((mode, i) => {
      const apart = Math.min(
        ...[i - 1, i + 1].filter((k) => modes[k]).map((k) => Math.abs(modes[k].frequency_hz / mode.hz - 1)),
        1,
      );
      if (apart > 1e-4) {
        assert.equal(mode.kind, modes[i].kind, `kind of mode ${i + 1}`);
      }
    });
    t.diagnostic(
      `largest differences ${Object.entries(most)
        .map(([kind, value]) => `${kind} ${value.toExponential(1)}`)
        .join(", ")}`,
    );

    // The response of the page at its own range.
    const shown = await page.evaluate(() => ({
      ...window.funicular.asked,
      curve: Array.from(window.funicular.response?.numbers ?? []),
    }));
    assert.ok(shown.curve.length === 3000, `${shown.curve.length / 3} frequencies`);
    const { input, output, from, to, log } = shown.response;
    const curve = native({ command: "frf", ...whole, input, output, from_hz: from, to_hz: to, points: 1000, log });
    const height = Math.max(...curve.real.map((value, i) => Math.hypot(value, curve.imag[i])));
    curve.frequency_hz.forEach((hz, i) => {
      const off = Math.hypot(shown.curve[3 * i + 1] - curve.real[i], shown.curve[3 * i + 2] - curve.imag[i]);
      // Beside a resonance the rounding of its frequency counts divided by the damping.
      assert.ok(off <= 1e-8 * height, `${off / height} at ${hz} Hz`);
    });
    assert.equal(await page.locator("#message").isVisible(), false);
    await page.screenshot({ path: join(pictures, `${robot}.png`) });
  });
}

test("dragging a handle moves the platform, and everything follows", async () => {
  await choose("cogiro");
  const start = await frame();
  await page.evaluate(() => window.funicular.view.look("front"));
  await page.waitForTimeout(300);
  // The handle of x points to the right in the front view, from the origin of the platform.
  const at = await page.evaluate(() => {
    const { view } = window.funicular;
    const box = view.canvas.getBoundingClientRect();
    const point = view.handle.position.clone().project(view.camera);
    return { x: box.left + ((point.x + 1) * box.width) / 2, y: box.top + ((1 - point.y) * box.height) / 2 };
  });
  await page.mouse.move(at.x + 45, at.y, { steps: 4 });
  await page.waitForFunction(() => window.funicular.view.controls.axis === "X");
  await page.mouse.down();
  await framed(() => page.mouse.move(at.x + 120, at.y, { steps: 12 }));
  await page.mouse.up();
  await idle();
  const moved = await frame();
  assert.ok(moved.position[0] - start.position[0] > 0.3, `moved by ${moved.position[0] - start.position[0]} m`);
  assert.ok(Math.abs(moved.position[2] - start.position[2]) < 0.01);
  assert.notEqual(moved.modes[0].hz, start.modes[0].hz);
  const content = await page.evaluate(() => window.funicular.content);
  assert.equal(content.hold, "pose");
  const rest = native({ command: "statics", robot: content.robot, pose: content.pose });
  rest.cables.forEach((cable, i) => near(moved.cables[i].tension, cable.tension_platform_n, STATICS, cable.name));
  assert.equal(Number(await page.inputValue("[data-pose='0']")), content.pose[0]);

  await framed(() => page.click("#undo"));
  const back = await frame();
  assert.ok(Math.abs(back.position[0] - start.position[0]) < 1e-9, "undo");
  await framed(() => page.click("#redo"));
  assert.equal((await frame()).position[0], moved.position[0], "redo");
});

test("a wrong value is refused at its place, and the state stays", async () => {
  const start = await frame();
  await page.fill("[data-pose='2']", "abc");
  await page.keyboard.press("Enter");
  assert.equal(await page.getAttribute("[data-pose='2']", "aria-invalid"), "true");
  assert.match(await text("#pose .field-message"), /“abc” is not a number/);
  assert.equal(await page.locator("#message").isVisible(), false, "one message, at its place");
  assert.deepEqual((await frame()).position, start.position);
  await framed(async () => {
    await page.fill("[data-pose='2']", "1.2");
    await page.keyboard.press("Enter");
  });
  assert.equal(await page.locator("#message").isVisible(), false);
  assert.equal((await frame()).position[2], 1.2);
  assert.equal(await page.locator(".field-message").count(), 0);

  // A value out of its range in a slider's field.
  await page.fill("[data-number='platform.mass_kg']", "-3");
  await page.keyboard.press("Enter");
  await page.waitForFunction(() => !document.getElementById("message").hidden);
  assert.match(await text("#message"), /^A value of the robot is refused: `mass_kg` is -3/);
  await nothingShown();
  await framed(() => page.click("#undo"));
  assert.match(await text("#key"), /N\b/);
});

/** Asserts that no part of the page has a result. */
async function nothingShown(of = page) {
  await of.waitForFunction(() => window.funicular.idle && window.funicular.frame === null);
  await of.waitForTimeout(400); // longer than until the long computations begin
  const found = await of.evaluate(() => {
    const text = (id) => document.getElementById(id).innerText.trim();
    const key = [...document.querySelectorAll("#key dd")].map((one) => one.innerText.trim());
    const cells = [...document.querySelectorAll("#tensions tbody tr")].flatMap((row) =>
      [...row.cells].slice(1).map((cell) => cell.innerText.trim()),
    );
    return {
      key: key.filter((one) => one !== "–"),
      cells: cells.filter((one) => !["", "–"].includes(one)),
      modes: text("modes").split("\n").length > 2 ? document.querySelectorAll("#modes tbody tr").length : 0,
      figures: document.querySelectorAll("#bode svg, #release svg, #influence .bars, #compare table").length,
      warnings: text("warnings"),
      influence: text("influence"),
      legend: text("legend"),
      commands: document.getElementById("commands").textContent,
      python: document.getElementById("python").textContent,
      moving: window.funicular.view.playback.mode !== null,
      drawn: window.funicular.view.frame !== null,
      response: window.funicular.response,
      play: document.getElementById("play").offsetParent !== null,
      first: document.getElementById("influence-first").disabled,
      names: [...document.querySelectorAll("#view .names span")].filter((one) => one.offsetParent !== null).length,
    };
  });
  const { commands, python, ...rest } = found;
  assert.deepEqual(rest, {
    key: [],
    cells: [],
    modes: 0,
    figures: 0,
    warnings: "–",
    influence: "–",
    legend: "",
    moving: false,
    drawn: false,
    response: null,
    play: false,
    first: true,
    names: 0,
  });
  [commands, python].forEach((one) => assert.match(one, /^There are no results: /));
}

const OWN = readFileSync(new URL("../../tests/hall.toml", import.meta.url), "utf8");

/** Opens a file that the reader or the statics refuses. */
async function openRefused(name, content) {
  const file = join(folder, name);
  writeFileSync(file, content);
  await page.setInputFiles("#files", file);
  await page.waitForFunction(() => window.funicular.idle && window.funicular.frame === null);
}

test("a robot that is refused, or has no equilibrium, leaves nothing of the robot before", async () => {
  const cases = {
    "no-equilibrium.toml": [
      OWN.replace("0.5, 3.0]", "0.5, 9.5]"),
      /^No equilibrium here/,
      "Hall crane, 6 cables, 20 m",
    ],
    "negative.toml": [
      OWN.replace("mass_kg = 250", "mass_kg = -250"),
      /^The robot file has an error: line 3: /,
      "negative.toml",
    ],
    "cut.toml": [OWN.slice(0, 300), /^The robot file has/, "cut.toml"],
    "empty.toml": ["", /^The robot file has/, "empty.toml"],
  };
  for (const [name, [content, words, title]] of Object.entries(cases)) {
    await choose("cogiro");
    // Everything that the page can show of a state.
    await page.click("#modes tbody tr:nth-child(17) button");
    await page.click("#compare-run");
    await page.waitForSelector("#compare tbody tr");
    await page.waitForSelector("#influence .bars");
    await page.waitForFunction(() => /limited by cable/.test(document.getElementById("key").textContent));
    await page.click("#remember");
    await openRefused(name, content);
    await nothingShown();
    assert.match(await text("#message"), words, name);
    assert.equal(await text("#name"), title);
    assert.ok((await page.title()).startsWith(title), await page.title());
    assert.equal(await page.getAttribute("#remember", "aria-pressed"), "false");
    assert.ok(!(await page.locator("#space canvas").getAttribute("aria-label")).includes("8 cables"));

    // What is pressed now says that there is nothing.
    for (const kind of ["csv", "json", "png", "svg", "response", "release"]) {
      await page.click(".menu summary");
      await page.click(`[data-save=${kind}]`);
      assert.match(await text("#message"), /There is nothing to save: /, kind);
    }
    await page.click("#remember");
    await page.click("#compare-run");
    await page.click("#slice-run");
    await page.fill("#release-mass", "5");
    await page.click("#release-form button");
    await page.click("[data-hold=lengths]");
    assert.match(await text("#message"), /The cable lengths cannot be held/);
    assert.equal(await page.getAttribute("#remember", "aria-pressed"), "false");
    if (name !== "no-equilibrium.toml") {
      assert.equal(await page.evaluate(() => document.querySelectorAll("#tensions tbody tr, #map svg").length), 0);
    } else {
      await page.waitForFunction(() => document.getElementById("slice-run").textContent === "Compute");
      assert.equal(await page.locator("#tensions tbody tr").count(), 6);
      await page.screenshot({ path: join(pictures, "no-equilibrium.png") });
      // The platform can be moved to where there is one.
      await framed(async () => {
        await page.fill("[data-pose='2']", "3");
        await page.keyboard.press("Enter");
      });
      assert.equal((await frame()).cables.length, 6);
    }
  }
  // Undo goes back through the refused ones.
  await framed(() => page.click("#undo"));
  assert.match(await text("#name"), /^CoGiRo/);
});

/** Place of the platform in the view on the screen. */
const onScreen = (of = page) =>
  of.evaluate(() => {
    const { view } = window.funicular;
    const box = view.canvas.getBoundingClientRect();
    const point = view.handle.position.clone().project(view.camera);
    return { x: box.left + ((point.x + 1) * box.width) / 2, y: box.top + ((1 - point.y) * box.height) / 2 };
  });
const border = (of = page) =>
  of.evaluate(() => ({ ...window.funicular.border, ghost: window.funicular.view.ground.ghost.visible }));

test("beyond the workspace the last pose holds, and the view says why", async () => {
  await choose("cogiro");
  await framed(() => page.fill("[data-pose='0']", "1").then(() => page.keyboard.press("Enter")));
  await page.waitForFunction(() => /limited by cable/.test(document.getElementById("hud").textContent));
  const [start, key] = [await frame(), await text("#key")];

  // Typed.
  await page.fill("[data-pose='0']", "12");
  await page.keyboard.press("Enter");
  await page.waitForFunction(() => window.funicular.border && window.funicular.idle);
  assert.match(await text("#border"), /^Beyond the workspace: cables? .* would have to push\.$/);
  assert.deepEqual((await border()).pose.slice(0, 3), [12, ...start.position.slice(1)]);
  assert.ok((await border()).ghost, "the wanted pose is shown");
  assert.deepEqual((await frame()).position, start.position);
  assert.equal(await page.inputValue("[data-pose='0']"), "1");
  assert.equal(await page.locator("#message").isVisible(), false);
  await page.waitForFunction((before) => document.getElementById("key").innerText === before, key);
  await page.screenshot({ path: join(pictures, "border.png") });

  // Dragged by the body: nothing moves under the pointer, and at the end the worker has the frame that is shown.
  const top = () => page.evaluate(() => window.funicular.view.canvas.getBoundingClientRect().top);
  const [at, above] = [await onScreen(), await top()];
  await page.mouse.move(at.x, at.y);
  await page.mouse.down();
  await page.mouse.move(at.x + 60, at.y, { steps: 6 });
  await page.mouse.move(at.x + 420, at.y + 30, { steps: 12 });
  await page.waitForFunction(() => window.funicular.border);
  const during = await frame();
  assert.equal(await top(), above);
  await page.mouse.up();
  await idle();
  const held = await frame();
  assert.deepEqual(held.position, during.position);
  assert.notDeepEqual(held.position, start.position);
  const { content } = await page.evaluate(() => ({ content: window.funicular.content }));
  const rest = native({ command: "statics", robot: content.robot, pose: content.pose });
  rest.cables.forEach((cable, i) => near(held.cables[i].tension, cable.tension_platform_n, STATICS, cable.name));
  await page.click("#modes tbody tr:nth-child(3) button");
  await page.waitForFunction(() => window.funicular.view.playback.mode);
  await page.click("#modes tbody tr:nth-child(3) button");

  // Undo goes to valid poses only, and the next valid pose takes the words away.
  await framed(() => page.click("#undo"));
  assert.deepEqual((await frame()).position, start.position);
  assert.equal(await text("#border"), "");
  assert.ok(!(await border()).ghost);
});

test("the body is the large handle, and a miss turns no camera", async () => {
  await choose("cogiro");
  await page.click("[data-look=oblique]");
  const camera = () => page.evaluate(() => window.funicular.view.camera6.join());
  const [start, look] = [await frame(), await camera()];
  const drag = async (from, to, keys = []) => {
    await page.mouse.move(from.x, from.y);
    await Promise.all(keys.map((key) => page.keyboard.down(key)));
    await page.mouse.down();
    await page.mouse.move(to.x, to.y, { steps: 8 });
    await page.mouse.up();
    await Promise.all(keys.map((key) => page.keyboard.up(key)));
    await idle();
  };
  const at = await onScreen();
  await framed(() => drag(at, { x: at.x + 60, y: at.y + 20 }));
  const flat = await frame();
  assert.ok(Math.hypot(flat.position[0] - start.position[0], flat.position[1] - start.position[1]) > 0.3);
  assert.ok(Math.abs(flat.position[2] - start.position[2]) < 1e-3, "in the horizontal plane");
  const next = await onScreen();
  await framed(() => drag(next, { x: next.x, y: next.y - 40 }, ["Shift"]));
  const lifted = await frame();
  assert.ok(lifted.position[2] > flat.position[2] + 0.2, `${lifted.position[2]}`);
  assert.ok(Math.abs(lifted.position[0] - flat.position[0]) < 1e-3);

  // A little beside it nothing happens; far away the camera turns.
  const place = await onScreen();
  await drag({ x: place.x - 62, y: place.y + 55 }, { x: place.x - 140, y: place.y + 20 });
  assert.equal(await camera(), look);
  assert.deepEqual((await frame()).position, lifted.position);
  await drag({ x: place.x - 240, y: place.y + 90 }, { x: place.x - 140, y: place.y + 90 });
  assert.notEqual(await camera(), look);
  // One button gives one view, whatever was before.
  for (let i = 0; i < 3; i += 1) {
    await page.click("[data-look=top]");
    await page.click("[data-look=oblique]");
    assert.equal(await camera(), look);
  }
});

test("a file that is typed by half leaves nothing, and everything comes back", async () => {
  await choose("cogiro");
  const shown = await text("#key");
  // A file that is typed by half, while it has an error.
  await page.click("#tab-file");
  await page.locator("#editor .cm-content").click();
  await page.keyboard.press("Control+End");
  await page.keyboard.type("\nmass = 3");
  await page.waitForFunction(() => document.querySelector("#issues li"));
  await nothingShown();
  await page.click(".menu summary");
  const [download] = await Promise.all([page.waitForEvent("download"), page.click("[data-save=toml]")]);
  const path = join(pictures, "half.toml");
  await download.saveAs(path);
  assert.match(readFileSync(path, "utf8"), /\nmass = 3$/, "the file is saved as it was typed");
  await page.locator("#editor .cm-content").click();
  await page.keyboard.press("Control+End");
  await framed(async () => {
    for (let i = 0; i < 9; i += 1) {
      await page.keyboard.press("Backspace");
    }
  });
  await page.click("#tab-values");
  assert.equal(await text("#key").then((found) => found.split("\n")[1]), shown.split("\n")[1]);
});

test("a comparison and a slice of an earlier state are not taken for those of the present one", async () => {
  await choose("cogiro");
  await page.click("#compare-run");
  await page.waitForSelector("#compare tbody tr");
  await page.click("#slice-run");
  await page.waitForFunction(
    () =>
      document.getElementById("slice-run").textContent === "Compute" &&
      document.querySelectorAll("#map svg rect").length > 1000,
  );
  // In the plane of the slice it stays; its cross moves.
  await framed(async () => {
    await page.fill("[data-pose='0']", "1");
    await page.keyboard.press("Enter");
  });
  assert.match(await text("#compare"), /The state has changed: compare again/);
  assert.ok(!((await page.getAttribute("#map", "class")) ?? "").includes("stale"));
  await framed(async () => {
    await page.fill("[data-number='platform.mass_kg']", "150");
    await page.keyboard.press("Enter");
  });
  assert.match(await page.getAttribute("#map", "class"), /stale/);
  assert.match(await text("#map"), /of an earlier state: compute it again/);
  await page.click(".menu summary");
  await page.click("[data-save=map]");
  assert.match(await text("#message"), /of an earlier state/);
  await framed(() => page.click("#undo"));
  assert.doesNotMatch(await text("#map"), /of an earlier state/);
});

test("the first mode of the platform is found above the listed ones", async () => {
  const file = join(folder, "hall-crane.toml");
  writeFileSync(file, OWN);
  await framed(() => page.setInputFiles("#files", file));
  await page.waitForFunction(() => /7\.085 Hz\s*mode 27/.test(document.getElementById("key").innerText));
  assert.equal(await page.locator("#modes tbody tr").count(), 21);
  assert.match(await text("#modes tbody tr:last-child"), /^27\s+7\.0849/);
  await page.click("#influence-first");
  await page.waitForSelector("#influence .bars");
  assert.match(await text("#influence"), /Change of 7\.0849 Hz/);
  assert.equal(await page.evaluate(() => document.getElementById("influence").dataset.mode), "26");
  await page.waitForFunction(() => window.funicular.view.playback.mode);
  await page.screenshot({ path: join(pictures, "platform.png") });

  // While the platform moves, the list reaches it, and no search is needed.
  await framed(async () => {
    await page.fill("[data-pose='0']", "0.9");
    await page.keyboard.press("Enter");
  });
  const near27 = await frame();
  assert.ok(near27.first.index > 20 && near27.modes.length > near27.first.index, JSON.stringify(near27.first));

  // The release has the modes of the platform.
  await page.fill("#release-mass", "100");
  await page.click("#release-form button");
  await page.waitForFunction(() =>
    /The complete static model moves/.test(document.getElementById("release").textContent),
  );
  const [complete, linear] = /by ([\d.]+) mm under this payload, the listed modes by ([\d.]+) mm/
    .exec(await text("#release p"))
    .slice(1)
    .map(Number);
  near(linear, complete, 0.1, "displacement under 100 kg");
});

// One gram in ropes of one kilogram per metre: up to 1000 Hz the ropes vibrate, and the platform goes with them.
const SPECK =
  `
name = "Speck on heavy ropes"
[platform]
motion = "point-mass"
mass_kg = 0.001
[materials.rope]
axial_stiffness_n = 2e6
mass_kg_per_m = 1.0
minimum_tension_n = 1000
maximum_tension_n = 9000
[state]
position_m = [0.0, 0.1, 1.0]
` +
  [
    [2, 2, 3],
    [-2, 2, 3],
    [-2, -2, 3],
    [2, -2, 3],
    [0, 0, -2],
  ]
    .map(
      (anchor, i) => `[[cables]]
name = "${i + 1}"
material = "rope"
anchor_m = [${anchor.map((value) => value.toFixed(1)).join(", ")}]
`,
    )
    .join("");

test("a robot without a mode of the platform says so, and its button is disabled", async () => {
  const file = join(folder, "speck.toml");
  writeFileSync(file, SPECK);
  await framed(() => page.setInputFiles("#files", file));
  // Until the search ends, the figure is marked, and the button waits.
  assert.match(await text("#key"), /First resonance of the platform\s*…\s*above the 20 lowest; searching/);
  assert.ok(await page.isDisabled("#influence-first"));
  await page.waitForFunction(() =>
    /no mode below 1000 Hz has at least 50 %/.test(document.getElementById("key").innerText),
  );
  assert.match(await text("#key"), /First resonance of the platform\s*–\s*no mode/);
  assert.ok(await page.isDisabled("#influence-first"));
  assert.match(await page.getAttribute("#influence-first", "title"), /no mode below 1000 Hz/);
  assert.match(await text("#influence"), /There is no first one of the platform: no mode below 1000 Hz/);

  // A search that is given up is told.
  await framed(async () => {
    await page.fill("[data-pose='0']", "0.1");
    await page.keyboard.press("Enter");
  });
  await page.click("#busy p:has-text('Searching the first resonance') button");
  assert.match(await text("#key"), /the search was cancelled/);
});

test("a file that is too large is refused at once, and a message is not hidden by a note", async () => {
  await choose("cogiro");
  for (const name of ["large.toml", "large.xml"]) {
    await page.evaluate((of) => {
      const files = new DataTransfer();
      files.items.add(new File([new Uint8Array(60e6)], of));
      document.dispatchEvent(new DragEvent("drop", { bubbles: true, dataTransfer: files }));
    }, name);
    assert.match(await text("#message"), new RegExp(`^${name} has 60.0 MB, which is more than the 5 MB`));
  }
  assert.equal((await frame()).cables.length, 8);
  const bad = join(folder, "picture.png");
  writeFileSync(bad, Buffer.from([137, 80, 78, 71, 13, 10, 26, 10]));
  await page.setInputFiles("#files", bad);
  await page.waitForFunction(() => /picture\.png/.test(document.getElementById("message").textContent));
  assert.equal((await text("#message")).split("picture.png").length, 2, await text("#message"));
});

test("sliders change values, and undo brings them back", async () => {
  await choose("cogiro");
  const start = await frame();
  await framed(async () => {
    await page.fill("[data-number='platform.mass_kg']", "150");
    await page.keyboard.press("Enter");
  });
  // The names are words with their unit, and the path is their tip.
  const label = page.locator("label[for='value-platform.mass_kg']");
  assert.equal(await label.innerText(), "mass of the platform [kg]");
  assert.match(await label.getAttribute("title"), /^platform\.mass_kg: /);
  const heavy = await frame();
  assert.match(await text("#legend"), /Tension: [\s\S]*\d N[\s\S]*\d N/);
  assert.ok(heavy.cables[2].tension > 1.2 * start.cables[2].tension);
  const rest = native({
    command: "statics",
    robot: {
      text: readFileSync(new URL("cogiro.toml", library), "utf8"),
      set: [{ path: "platform.mass_kg", value: 150 }],
    },
  });
  near(heavy.cables[2].tension, rest.cables[2].tension_platform_n, STATICS, "tension with 150 kg");
  await page.waitForFunction(() =>
    document.getElementById("commands").textContent.includes("--set platform.mass_kg=150"),
  );
  await framed(() => page.click("#undo"));
  near((await frame()).cables[2].tension, start.cables[2].tension, 1e-12, "undo");
  assert.equal(await page.inputValue("[data-number='platform.mass_kg']"), "91.058");

  // Lengths held: the platform sinks under a heavier mass.
  await framed(() => page.click("[data-hold=lengths]"));
  await framed(async () => {
    await page.fill("[data-number='platform.mass_kg']", "300");
    await page.keyboard.press("Enter");
  });
  const sunk = await frame();
  assert.ok(sunk.position[2] < start.position[2] - 1e-3, `${sunk.position[2]}`);
  sunk.cables.forEach((cable, i) => near(cable.length, start.cables[i].length, 1e-12, "held length"));
});

test("the editor shows the errors of the reader at their place", async () => {
  await choose("cogiro");
  await page.click("#tab-file");
  const editor = page.locator("#editor .cm-content");
  await editor.click();
  await page.keyboard.press("Control+Home");
  for (let i = 0; i < 6; i += 1) {
    await page.keyboard.press("ArrowDown");
  }
  await page.keyboard.press("End");
  await page.keyboard.type("x");
  await page.waitForFunction(() => document.querySelector("#issues li"));
  assert.match(await text("#issues"), /line 7, column/);
  assert.match(await text("#message"), /The robot file has an error: line 7/);
  await page.waitForSelector("#editor .cm-lint-marker-error");
  await framed(() => page.keyboard.press("Backspace"));
  assert.equal(await page.locator("#message").isVisible(), false);
  await page.click("#tab-values");
});

test("the message says which cable limits the payload, and the workspace is computed in workers", async () => {
  await choose("cogiro");
  await page.waitForFunction(() => /limited by cable/.test(document.getElementById("key").textContent));
  const rest = native({ command: "payload", robot: { text: readFileSync(new URL("cogiro.toml", library), "utf8") } });
  assert.ok(
    (await text("#key")).replace(/\s/g, "").includes(`${Math.round(rest.maximum.payload_kg)}kg`),
    await text("#key"),
  );

  // Cancelled by the next change, then complete.
  await page.click("#slice-run");
  await page.waitForSelector("#map svg");
  await framed(async () => {
    await page.fill("[data-pose='2']", "1.4");
    await page.keyboard.press("Enter");
  });
  await page.waitForFunction(() => document.getElementById("slice-run").textContent === "Compute");
  await page.click("#slice-run");
  await page.waitForFunction(
    () =>
      document.getElementById("slice-run").textContent === "Compute" &&
      document.querySelectorAll("#map svg rect").length > 1000,
  );
  const cross = () => page.getAttribute("#map .here", "d");
  const there = await cross();
  await framed(async () => {
    await page.fill("[data-pose='0']", "0.5");
    await page.keyboard.press("Enter");
  });
  assert.notEqual(await cross(), there, "the cross follows the platform");
  assert.match(await page.getAttribute("#map svg", "aria-label"), /^Highest tension at \d+ poses/);
  await page.locator("#map").scrollIntoViewIfNeeded();
  await page.screenshot({ path: join(pictures, "workspace.png") });
});

test("a mode is shown in motion, and “before” is compared", async () => {
  await choose("cogiro");
  await page.click("#modes tbody tr:nth-child(17) button");
  await page.waitForFunction(() => window.funicular.view.playback.mode);
  const picture = () =>
    page.evaluate(() =>
      window.funicular.view.lines[2].geometry.attributes.instanceStart.data.array.slice(0, 60).join(),
    );
  const first = await picture();
  await page.waitForTimeout(300);
  assert.notEqual(await picture(), first, "the cables do not move");
  await page.click("#remember");
  await framed(async () => {
    await page.fill("[data-number='platform.mass_kg']", "120");
    await page.keyboard.press("Enter");
  });
  assert.match(await page.locator("#modes tbody tr:nth-child(17) .before").innerText(), /^[+−]\d/);
  await page.waitForSelector("#bode .past");
  await page.screenshot({ path: join(pictures, "before.png") });
  await page.click("#remember");
  await page.click("#modes tbody tr:nth-child(17) button");
});

test("the commands in the page run as they stand", async () => {
  await choose("cogiro");
  await framed(async () => {
    await page.fill("[data-number='platform.mass_kg']", "150");
    await page.keyboard.press("Enter");
  });
  await framed(async () => {
    await page.fill("[data-pose='2']", "1.7");
    await page.keyboard.press("Enter");
  });
  await page.click("#modes tbody tr:nth-child(1) button");
  await page.waitForFunction(() => /funicular gradient/.test(document.getElementById("commands").textContent));
  const lines = (await page.locator("#commands").textContent()).split("\n\n");
  assert.equal(lines.length, 4);
  const shown = (await frame()).cables[0].tension;
  for (const line of lines) {
    const done = spawnSync("sh", ["-c", line.replace(/^funicular/, `"$PROGRAM"`)], {
      encoding: "utf8",
      cwd: new URL(".", library),
      env: { ...process.env, PROGRAM: program },
    });
    assert.equal(done.status, 0, `${line}\n${done.stderr}`);
    if (line.startsWith("funicular statics")) {
      assert.ok(done.stdout.includes(shown.toFixed(3)), `${shown} is not in ${done.stdout}`);
    }
  }
  await page.click("#modes tbody tr:nth-child(1) button");
});

test("the models are compared on demand", async () => {
  await choose("kntu-planar");
  await page.click("#compare-run");
  await page.waitForSelector("#compare tbody tr");
  assert.equal(
    await page.locator("#compare tbody tr").count(),
    native({
      command: "compare",
      below_hz: (await frame()).belowHz,
      robot: { text: readFileSync(new URL("kntu-planar.toml", library), "utf8") },
    }).models.length,
  );
});

test("a link has the robot and the state", async () => {
  await choose("ipanema2");
  await framed(async () => {
    await page.fill("[data-number='platform.mass_kg']", "31");
    await page.keyboard.press("Enter");
  });
  await framed(async () => {
    await page.fill("[data-pose='0']", "0.25");
    await page.keyboard.press("Enter");
  });
  await page.click("#share");
  await page.waitForFunction(() => location.hash.length > 20);
  const link = page.url();
  const expected = await frame();
  const other = await opened(link);
  await other.waitForFunction(() => window.funicular.frame.position[0] === 0.25);
  const found = await frame(other);
  assert.deepEqual(found.position, expected.position);
  found.modes.forEach((mode, i) => near(mode.hz, expected.modes[i].hz, 1e-9, "frequency"));
  assert.equal(await other.inputValue("[data-number='platform.mass_kg']"), "31");
  await other.close();
  const broken = await opened(`${link.slice(0, -30)}`);
  await broken.waitForFunction(() => !document.getElementById("message").hidden);
  assert.match(
    await text("#message", broken),
    /This link is damaged.* This is not its robot, but the first one of the library, CoGiRo/,
  );
  // Another link in the same window, without a part, and one that is none: the robot stays, and the page says so.
  for (const [hash, words] of [
    [link.split("#")[1].slice(5), /damaged.*The robot on the page is still the one before, CoGiRo/],
    ["robot=cogiro", /“#robot=cogiro” at the end of the address is no link of this page.*still the one before/],
  ]) {
    await broken.evaluate((to) => {
      document.getElementById("message").textContent = "";
      location.hash = to;
    }, hash);
    await broken.waitForFunction(() => document.getElementById("message").textContent !== "");
    const told = await text("#message", broken);
    assert.ok(words.test(told) && !/atob|fetch|JSON|undefined/i.test(told), told);
  }
  // The link to the results at the beginning of the page is a place, and not a robot.
  await broken.evaluate(() => {
    document.getElementById("message").textContent = "";
    location.hash = "results";
  });
  await broken.waitForTimeout(300);
  assert.equal(await broken.locator("#message").textContent(), "");
  await broken.close();
});

test("a page that `funicular live` has made begins with its robot and state", async () => {
  const text = readFileSync(new URL("caroca.toml", library), "utf8");
  const start = {
    version: 1,
    robot: { name: "own.toml", text, set: [{ path: "platform.mass_kg", value: 300 }] },
    hold: "pose",
    pose: [0.5, 0, 1, 0, 0, 0],
    lengths: null,
    rule: "middle",
    more: { force_n: [0, 0, -200] },
    model: { cable_model: "catenary-static" },
  };
  const place = '<script id="start" type="application/json">null</script>';
  const whole = readFileSync(join(web, "funicular.html"), "utf8");
  assert.equal(whole.split(place).length, 2, "the place where `funicular live` writes the robot");
  const file = join(folder, "live.html");
  writeFileSync(
    file,
    whole.replace(place, () => place.replace("null", JSON.stringify(start).replaceAll("<", "\\u003c"))),
  );
  const made = await opened(pathToFileURL(file).href);
  const found = await frame(made);
  const common = { robot: start.robot, pose: start.pose, force_n: [0, 0, -200], tension_rule: "middle" };
  native({ command: "statics", ...common }).cables.forEach((cable, i) =>
    near(found.cables[i].tension, cable.tension_platform_n, STATICS, cable.name),
  );
  const modes = native({ command: "modes", ...common, ...start.model, below_hz: found.belowHz }).modes;
  found.modes.forEach((mode, i) => near(mode.hz, modes[i].frequency_hz, FREQUENCY, `frequency ${i + 1}`));
  assert.equal(await made.inputValue("#rule"), "middle");
  // The commands follow when nothing has changed for a while.
  await made.waitForFunction(() => document.getElementById("commands").textContent.startsWith("funicular "));
  const [statics, listing] = (await made.locator("#commands").textContent()).split("\n\n");
  assert.ok(/--tension-rule middle.*--force-n 0,0,-200/s.test(statics) && !statics.includes("--cable-model"), statics);
  assert.ok(listing.includes("--force-n 0,0,-200") && listing.includes("--cable-model catenary-static"), listing);
  await made.close();
});

test("a robot file without a state starts between its anchors", async () => {
  const text = readFileSync(new URL("cogiro.toml", library), "utf8").replace(/^unstrained_length_m.*$/gm, "");
  const file = join(folder, "stateless.toml");
  writeFileSync(file, text);
  await framed(() => page.setInputFiles("#files", file));
  const { content } = await page.evaluate(() => ({ content: window.funicular.content }));
  assert.equal(content.hold, "pose");
  assert.equal((await frame()).cables.length, 8);
});

test("files of other programs are imported, and files are saved", async () => {
  const moordyn = join(folder, "robot.txt");
  const made = spawnSync(program, ["export", "robots/yuan2014-4mm.toml", "--to", "moordyn", "-o", moordyn], {
    encoding: "utf8",
    cwd: new URL("../../../../", import.meta.url),
  });
  assert.equal(made.status, 0, made.stderr);
  await framed(() => page.setInputFiles("#files", moordyn));
  assert.equal((await frame()).cables.length, 6);
  const bad = join(folder, "notes.txt");
  writeFileSync(bad, "no robot");
  await page.setInputFiles("#files", bad);
  await page.waitForFunction(() =>
    /notes\.txt: it is neither XML/.test(document.getElementById("message").textContent),
  );

  await choose("cogiro");
  await framed(async () => {
    await page.fill("[data-number='platform.mass_kg']", "150");
    await page.keyboard.press("Enter");
  });
  const saved = async (kind) => {
    await page.click(".menu summary");
    const [download] = await Promise.all([page.waitForEvent("download"), page.click(`[data-save=${kind}]`)]);
    const path = join(pictures, download.suggestedFilename());
    await download.saveAs(path);
    return readFileSync(path);
  };
  assert.match((await saved("toml")).toString(), /mass_kg = 150/);
  const json = JSON.parse(await saved("json"));
  assert.equal(json.statics.mass_kg, 150);
  assert.ok(json.modes.modes.length >= 20 && json.frf.real.length === 1000);
  assert.match((await saved("csv")).toString(), /^name,unstrained_length_m,tension_platform_n/);
  assert.equal((await saved("png")).subarray(1, 4).toString(), "PNG");
  const svg = (await saved("svg")).toString();
  assert.ok(svg.startsWith("<svg") && svg.split("<polyline").length > 16);
  assert.match((await saved("response")).toString(), /<path/);
});

test("the keyboard is enough", async () => {
  await choose("cogiro");
  await page.evaluate(() => window.funicular.view.canvas.focus());
  const start = await frame();
  await framed(() => page.keyboard.press("PageUp"));
  await framed(() => page.keyboard.press("ArrowRight"));
  const moved = await frame();
  assert.ok(moved.position[2] > start.position[2] && moved.position[0] > start.position[0]);
  await page.waitForTimeout(700);
  await framed(() => page.keyboard.press("Control+z"));
  // Every control can be reached with Tab and shows where the focus is.
  await page.evaluate(() => document.activeElement.blur());
  const reached = new Set();
  for (let i = 0; i < 130; i += 1) {
    await page.keyboard.press("Tab");
    reached.add(
      await page.evaluate(() => {
        const { id, dataset, tagName } = document.activeElement;
        return id || Object.values(dataset).join() || tagName;
      }),
    );
  }
  for (const id of [
    "gallery-open",
    "measure",
    "remember",
    "library",
    "open",
    "share",
    "tab-values",
    "reset",
    "count",
    "input",
    "output",
    "from",
    "slice-run",
    "compare-run",
    "home",
  ]) {
    assert.ok(reached.has(id), `${id} is not reached: ${[...reached].join(" ")}`);
  }
});

test("a screen reader is told the name of every control, and figures have a text", async () => {
  await choose("cogiro");
  await page.click("#tab-file");
  const tools = await page.context().newCDPSession(page);
  const { nodes } = await tools.send("Accessibility.getFullAXTree");
  const controls = [
    "button",
    "textbox",
    "combobox",
    "slider",
    "spinbutton",
    "checkbox",
    "tab",
    "link",
    "image",
    "progressbar",
  ];
  const of = nodes.filter(({ ignored, role }) => !ignored && controls.includes(role?.value));
  assert.ok(of.length > 60, `${of.length} controls`);
  const nameless = of.filter(({ name }) => !name?.value?.trim());
  assert.deepEqual(
    nameless.map(({ role, properties }) => `${role.value} ${JSON.stringify(properties)}`),
    [],
  );
  assert.ok(
    of.some(({ role, name }) => role.value === "image" && /^Frequency response\. Highest peak/.test(name.value)),
  );
  await page.click("#tab-values");
});

test("on a phone everything is in one column", async () => {
  const phone = await opened(address, {
    viewport: { width: 390, height: 844 },
    hasTouch: true,
    isMobile: true,
    colorScheme: "dark",
  });
  const wide = await phone.evaluate(() => document.documentElement.scrollWidth);
  assert.ok(wide <= 390, `the page is ${wide} pixels wide`);
  await phone.screenshot({ path: join(pictures, "phone.png"), fullPage: true });
  await phone.close();
});

test("bars say which value moves a frequency most, as differences of the native program do", async () => {
  await choose("cogiro");
  await page.click("#influence-first");
  await page.selectOption("#influence-hold", "lengths");
  await page.waitForSelector("#influence .bars");
  const mode = await page.evaluate(() => Number(document.getElementById("influence").dataset.mode));
  const bars = await page.evaluate(() =>
    [...document.querySelectorAll("#influence li")].map((row) => ({
      path: row.dataset.path,
      text: row.querySelector("b").textContent,
    })),
  );
  assert.equal(bars.length, 10);
  const { hz } = (await frame()).modes[mode];
  const original = readFileSync(new URL("cogiro.toml", library), "utf8");
  const values = native({ command: "parameters", robot: { text: original } }).parameters;
  const nearest = (set) =>
    native({ command: "modes", robot: { text: original, set }, below_hz: 1.1 * hz, damped: false })
      .modes.map((found) => found.frequency_hz)
      .reduce((a, b) => (Math.abs(b - hz) < Math.abs(a - hz) ? b : a));
  for (const { path, text: shown } of bars.slice(0, 3)) {
    const { value } = values.find((one) => one.path === path);
    const [low, high] = [-1, 1].map((side) => nearest([{ path, value: value * (1 + side * 1e-5) }]));
    const percent = (high - low) / hz / 2e-5; // of the frequency, per 1 % of the value
    // Three digits are printed; a difference over 2e-5 of the value has an error of about 1e-4.
    near(Number(shown.replace("−", "-").replace("+", "").replace(" %", "")), percent, 6e-3, path);
  }
  // At a held pose the bars follow the tension rule, as the sliders do.
  await framed(async () => {
    await page.fill("[data-pose='2']", "2");
    await page.keyboard.press("Enter");
  });
  await page.waitForFunction(() => /rule `lowest`/.test(document.getElementById("influence").textContent));
  assert.equal(await page.inputValue("#influence-hold"), "rule");
  const own = await page.evaluate(() =>
    [...document.querySelectorAll("#influence li")].map((row) => ({
      path: row.dataset.path,
      text: row.querySelector("b").textContent,
    })),
  );
  const { hz: there } = (await frame()).modes[mode];
  const { pose } = await page.evaluate(() => window.funicular.content);
  const { path, text: effect } = own[0];
  const { value } = values.find((one) => one.path === path);
  const [low, high] = [-1, 1].map((side) =>
    native({
      command: "modes",
      robot: { text: original, set: [{ path, value: value + side * 1e-5 * Math.abs(value) }] },
      below_hz: 1.1 * there,
      damped: false,
      pose,
      tension_rule: "lowest",
    })
      .modes.map((found) => found.frequency_hz)
      .reduce((a, b) => (Math.abs(b - there) < Math.abs(a - there) ? b : a)),
  );
  near(
    Number(effect.replace("−", "-").replace("+", "").replace(" %", "")),
    (high - low) / there / 2e-5,
    6e-3,
    `${path} by the rule`,
  );

  // A bar adds its slider.
  await page.click("#influence li:first-child");
  await page.waitForSelector(`[data-number="${own[0].path}"]`);
  await page.click("#modes tr[aria-current] button");
});

test("a stop is computed with and without a shaper, as the program does it", async () => {
  await choose("cogiro");
  await page.fill("#stop-speed", "0.5");
  await page.fill("#stop-time", "0.2");
  await page.selectOption("#stop-shaper", "zv");
  await page.click("#stop-form button");
  await page.waitForFunction(() => /without it \(broken line\)/.test(document.getElementById("stop").textContent));
  const told = await text("#stop p");
  const [shaped, without] = /([\d.e-]+) s after the end of the stop; without it \(broken line\) after ([\d.e-]+) s/
    .exec(told)
    .slice(1)
    .map(Number);
  const robot = { text: readFileSync(new URL("cogiro.toml", library), "utf8") };
  const answer = native({ command: "settle", robot, stop_m_s: [0.5, 0, 0], profile_s: [0.2], shaper: "zv" });
  near(shaped, answer.settled_s, 0.01, "with the shaper");
  near(without, answer.shaping.settled_without_s, 0.01, "without");
  assert.ok(shaped < without, told);
  assert.equal(await page.locator("#stop path.now, #stop path.past").count(), 2);
  await page.screenshot({ path: join(pictures, "stop.png") });
  await page.fill("#stop-speed", "fast");
  await page.click("#stop-form button");
  assert.match(await text("#stop-form .field-message"), /“fast” is not a speed in metres per second/);
  await page.fill("#stop-speed", "0.5");
});

test("a simulated release and a simulated stop move the robot as the program says", async () => {
  await choose("yuan2014-4mm");
  await page.fill("#simulate-value", "1");
  await page.fill("#simulate-time", "0.3");
  await page.click("#simulate-form button:first-of-type");
  await page.waitForFunction(() => /run with a finer mesh/.test(document.getElementById("simulate").textContent));
  const place = () => page.evaluate(() => window.funicular.view.platform.position.toArray().join());
  const start = await place();
  await page.waitForFunction((at) => window.funicular.view.platform.position.toArray().join() !== at, start);
  const robot = { text: readFileSync(new URL("yuan2014-4mm.toml", library), "utf8") };
  const scenario = { release: [{ at_s: 0, mass_kg: 1 }] };
  const answer = native({ command: "simulate", robot, scenario, duration_s: 0.3, sample_time_s: 0.3 / 700 });
  const told = Number(/is at most ([\d.e-]+) mm/.exec(await text("#simulate p"))[1]);
  const position = answer.errors.find(({ column }) => column === "position_m");
  near(told, 1000 * position.largest, 0.05, "difference of the finer run");
  await page.screenshot({ path: join(pictures, "simulation.png") });

  await page.selectOption("#simulate-what", "stop");
  assert.equal(await text("#simulate-unit"), "m");
  await page.fill("#simulate-value", "-1");
  await page.click("#simulate-form button:first-of-type");
  assert.match(await text("#simulate-form .field-message"), /“-1” is not a length/);
  await page.fill("#simulate-value", "0.01");
  await page.fill("#simulate-time", "1");
  await page.click("#simulate-form button:first-of-type");
  await page.waitForFunction(() => /over 1(\.0+)? seconds/.test(document.getElementById("simulate").innerHTML));
  await page.click("#simulate-end");
  assert.equal(await page.locator("#simulate svg").count(), 0);
});

test("a released payload swings from the static displacement of the complete model", async () => {
  for (const robot of ["cogiro", "ipanema2", "cogiro-winches"]) {
    await choose(robot);
    await page.fill("#release-mass", "2");
    await page.click("#release-form button");
    await page.waitForFunction(() =>
      /The complete static model moves/.test(document.getElementById("release").textContent),
    );
    const told = await text("#release p");
    const [complete, linear] = /by ([\d.]+) mm under this payload, the listed modes by ([\d.]+) mm/
      .exec(told)
      .slice(1)
      .map(Number);
    // Both models are different: nonlinear statics of held lengths, and a sum over twenty modes, whose rest moves little.
    near(linear, complete, 0.02, robot);
    const place = () => page.evaluate(() => window.funicular.view.platform.position.toArray().join());
    const start = await place();
    await page.waitForFunction((at) => window.funicular.view.platform.position.toArray().join() !== at, start);
  }
  await page.screenshot({ path: join(pictures, "release.png") });
  await page.fill("#release-mass", "-1");
  await page.click("#release-form button:first-of-type");
  assert.match(await text("#release-form .field-message"), /“-1” is not a payload/);
  await page.fill("#release-mass", "2");
  await page.click("#release-stop");
  assert.equal(await page.locator("#release svg").count(), 0);
});

const HALL =
  `
name = "Hall"
[platform]
motion = "point-mass"
mass_kg = 12
[materials.rope]
axial_stiffness_n = 60e3
mass_kg_per_m = 0.03
minimum_tension_n = 20
maximum_tension_n = 900
[pulleys.top]
radius_m = 0.4
entry_direction = [0.0, 0.0, 1.0]
[winches.ground]
drum_side_length_m = 5.5
drum_radius_m = 0.06
[guide_wheels.small]
winch = "ground"
distance_m = 2.0
inertia_kg_m2 = 0.001
radius_m = 0.05
[supports.post]
stiffness_n_per_m = [40e3, 40e3, 5e6]
mass_kg = 40
` +
  [
    [10, 8, ' support = "post"'],
    [-10, 8, ""],
    [-10, -8, ""],
    [10, -8, ""],
  ]
    .map(
      ([x, y, more], i) => `[[cables]]
name = "${i + 1}"
material = "rope"
pulley = "top"
winch = "ground"
anchor_m = [${x}.0, ${y}.0, 6.0]
${more}
`,
    )
    .join("");

test("pulleys, drums, guide wheels and supports stand where they are", async () => {
  const file = join(folder, "hall.toml");
  writeFileSync(file, HALL);
  await framed(() => page.setInputFiles("#files", file));
  assert.match(await text("#legend"), /drum[\s\S]*pulley, guide wheel[\s\S]*flexible support/);
  const found = await page.evaluate(() => {
    const { drives } = window.funicular.view;
    drives.group.updateMatrixWorld(true);
    const { frame } = window.funicular;
    return drives.cables.map((own, i) => {
      const center = own.wheel.getWorldPosition(own.place.clone());
      const normal = own.place.clone().set(0, 0, 1).applyQuaternion(own.wheel.quaternion);
      const at = (list) => own.place.clone().set(...list);
      const exit = at(frame.cables[i].anchor);
      const next = at(frame.cables[i].points.slice(-6, -3));
      return {
        radius: center.distanceTo(exit),
        entry: center.distanceTo(own.place),
        plane: normal.dot(at(frame.cables[i].attachment).sub(own.place)),
        tangent: exit.clone().sub(center).normalize().dot(next.sub(exit).normalize()),
        end: own.arc.geometry.getAttribute("position").array.slice(-3),
        exit: exit.sub(own.place).toArray(),
      };
    });
  });
  found.forEach((wheel, i) => {
    // The anchor of cable 1 has moved with its support by some millimetres; wheels are drawn at the anchor of the file.
    const limit = i === 0 ? 5e-3 : 1e-9;
    assert.ok(
      Math.abs(wheel.radius - 0.4) < limit,
      `cable ${i + 1} leaves its wheel at ${wheel.radius} m from the centre`,
    );
    assert.ok(
      Math.abs(wheel.entry - 0.4) < 1e-9 && Math.abs(wheel.plane) < 20 * limit,
      `${wheel.entry} ${wheel.plane}`,
    );
    // The cable leaves along the rim: the last of 32 pieces of the sagging curve is nearly a tangent.
    assert.ok(Math.abs(wheel.tangent) < (i === 0 ? 0.02 : 5e-3), `${wheel.tangent}`);
    wheel.exit.forEach((value, k) => assert.ok(Math.abs(value - wheel.end[k]) < Math.max(limit, 1e-6)));
  });

  // The anchor on the support moves with the mode in which the support moves, and the other anchors stay.
  const modes = (await frame()).modes.map(({ kind }) => kind);
  const drive = modes.indexOf("drive");
  assert.ok(drive >= 0, modes.join());
  await page.click(`#modes tbody tr:nth-child(${drive + 1}) button`);
  await page.waitForFunction(() => {
    const [first, ...others] = window.funicular.view.drives.cables.map(({ body, place }) =>
      body.position.distanceTo(place),
    );
    return first > 1e-3 && others.every((distance) => distance === 0);
  });
  await page.screenshot({ path: join(pictures, "drives.png") });
  await page.click(`#modes tbody tr:nth-child(${drive + 1}) button`);
});

test("obstacles stand in the view, and the nearest pair is named and drawn", async () => {
  const file = join(folder, "column.toml");
  const column = `
[obstacles.column]
shape = "cylinder"
position_m = [3.0, 2.0, 1.5]
diameter_m = 0.4
length_m = 3.0
[obstacles.floor]
shape = "half-space"
position_m = [0.0, 0.0, -0.5]
`;
  writeFileSync(file, HALL + column);
  await framed(() => page.setInputFiles("#files", file));
  assert.match(await text("#state"), /(Nearest|Too near): .+ m \(0 m required\)/);
  const found = await page.evaluate(() => {
    const { obstacles } = window.funicular.view;
    const bodies = obstacles.group.children.filter((child) => child.isMesh);
    const { clearance } = window.funicular.frame.about;
    const drawn = Array.from(obstacles.near.geometry.getAttribute("position").array.slice(0, 6));
    return {
      names: bodies.map(({ name }) => name),
      shown: obstacles.near.visible,
      drawn,
      points: clearance.points_m.flat(),
    };
  });
  assert.deepEqual(found.names, ["column"]);
  assert.ok(found.shown);
  found.drawn.forEach((value, k) => assert.ok(Math.abs(value - found.points[k]) < 1e-5, `${value} ${found.points[k]}`));
  await page.screenshot({ path: join(pictures, "obstacles.png") });
});

test("keys are completed in the editor", async () => {
  await choose("cogiro");
  await page.click("#tab-file");
  await page.locator("#editor .cm-content").click();
  await page.keyboard.press("Control+End");
  const offered = async (typed) => {
    await page.keyboard.type(typed);
    await page.waitForSelector(".cm-tooltip-autocomplete li");
    const found = await page.locator(".cm-tooltip-autocomplete li").allInnerTexts();
    await page.keyboard.press("Escape");
    return found.join(" ");
  };
  // The last table is a cable: its keys, not those of the platform or of a rope. Then a table, and its keys.
  const cable = await offered("\nma");
  assert.ok(/material/.test(cable) && !/mass_kg/.test(cable), cable);
  assert.match(await offered("\n[[ca"), /^cables/);
  await page.keyboard.press("Control+Shift+k");
  assert.match(await offered("\n[wi"), /winches.*wind|wind.*winches/);
  await page.keyboard.press("Control+Shift+k");
  const wind = await offered("\n[wind]\na");
  assert.ok(/air_density_kg_m3/.test(wind) && !/anchor_m/.test(wind), wind);
  await page.click("#tab-values");
  await choose("cogiro-winches");
});

test("a robot that is chosen after a change of the text replaces it", async () => {
  await choose("cogiro");
  await page.click("#tab-file");
  const typed = async () => {
    await page.locator("#editor .cm-content").click();
    await page.keyboard.press("Control+End");
    await page.keyboard.type("\n[wi");
  };

  // The text that is not read yet is forgotten.
  await typed();
  await choose("ipanema2");
  await page.waitForTimeout(500);
  const { name, text: kept } = await page.evaluate(() => window.funicular.content.robot);
  assert.ok(name.startsWith("ipanema2") && !kept.includes("\n[wi"), name);

  // One that is being read is refused without harm to the next, here chosen as soon as the text has gone to the worker.
  await page.evaluate(() => {
    const { content } = window.funicular;
    let { robot } = content;
    const choose = () => {
      Object.defineProperty(content, "robot", { value: robot, writable: true });
      const library = document.getElementById("library");
      library.value = "cogiro";
      library.dispatchEvent(new Event("change"));
    };
    Object.defineProperty(content, "robot", {
      configurable: true,
      enumerable: true,
      get: () => robot,
      set: (value) => {
        robot = value;
        queueMicrotask(choose);
      },
    });
  });
  await typed();
  await page.waitForFunction(() => window.funicular.content.robot.name === "cogiro" && window.funicular.idle);
  assert.ok(await page.locator("#message").isHidden());
  assert.equal((await frame()).cables.length, 8);
  await page.click("#tab-values");
});

test("a long computation says so and can be cancelled", async () => {
  await choose("cogiro");
  // The worker of frames is kept busy by a map of many poses.
  await page.evaluate(() => {
    const poses = Array.from({ length: 4000 }, (_, i) => [0.001 * i - 2, 0, 1.5, 0, 0, 0]);
    window.funicular
      .ask({ command: "map", robot: window.funicular.content.robot, quantities: ["first-frequency"], poses })
      .catch(() => {});
  });
  await page.fill("[data-pose='2']", "1.3");
  await page.keyboard.press("Enter");
  await page.click("#busy button");
  await page.waitForFunction(() => /^Cancelled/.test(document.getElementById("message").textContent));
  await nothingShown();
  await framed(async () => {
    await page.fill("[data-pose='2']", "1.4");
    await page.keyboard.press("Enter");
  });
  assert.equal((await frame()).position[2], 1.4);
  assert.equal(await page.locator("#message").isVisible(), false);
});

test("a server needs no settings, and a missing module is told", async () => {
  // Without types of files, as the plainest servers answer; the second time without the module.
  for (const withModule of [true, false]) {
    const asked = [];
    const server = createServer((request, answer) => {
      const name = request.url.split("?")[0].slice(1);
      asked.push(name);
      if (
        !["index.html", "page.js", "page.css", "funicular.wasm"].includes(name) ||
        (name === "funicular.wasm" && !withModule)
      ) {
        answer.writeHead(404).end();
        return;
      }
      answer
        .writeHead(200, name.endsWith(".html") ? { "content-type": "text/html" } : {})
        .end(readFileSync(join(web, name)));
    });
    await new Promise((done) => server.listen(0, "127.0.0.1", done));
    const own = await browser.newContext().then((of) => of.newPage());
    own.setDefaultTimeout(PATIENCE_MS);
    await own.goto(`http://127.0.0.1:${server.address().port}/index.html`);
    if (withModule) {
      await idle(own);
      assert.equal((await frame(own)).cables.length, 8);
    } else {
      await own.waitForFunction(() => !document.getElementById("message").hidden);
      assert.match(await text("#message", own), /funicular\.wasm is missing: the server answers with 404/);
    }
    assert.deepEqual([...new Set(asked)].sort(), ["funicular.wasm", "index.html", "page.css", "page.js"]);
    await own.close();
    server.close();
  }
});

test("a page around this one is told every change", async () => {
  const script = readFileSync(new URL("../../../funicular-py/python/funicular/_live.js", import.meta.url), "utf8");
  const outer = join(folder, "notebook.html");
  writeFileSync(
    outer,
    `<!DOCTYPE html><div id="cell"></div><script type="module">${script.replace("export default { render };", "window.render = render;")}</script>`,
  );
  const cell = await browser.newContext().then((of) => of.newPage());
  cell.setDefaultTimeout(PATIENCE_MS);
  await cell.goto(pathToFileURL(outer).href);
  // The part of a notebook's model that the script uses.
  const whole = readFileSync(join(web, "funicular.html"), "utf8");
  await cell.exposeFunction("pageOf", () => whole);
  await cell.evaluate(() => {
    const heard = {};
    const model = {
      state: null,
      saved: 0,
      get: () => model.state,
      set: (_, value) => {
        model.state = value;
      },
      save_changes: () => {
        model.saved += 1;
      },
      on: (name, work) => {
        heard[name] = work;
      },
      off: () => {},
      send: async () => heard["msg:custom"]({ page: await window.pageOf() }),
    };
    window.model = model;
    window.render({ model, el: document.getElementById("cell") });
  });
  const inner = await cell.waitForSelector("iframe").then((handle) => handle.contentFrame());
  await inner.waitForFunction(() => window.funicular?.idle);
  assert.equal(await inner.locator("#share").isVisible(), false);
  await inner.fill("[data-pose='2']", "1.3");
  await inner.press("[data-pose='2']", "Enter");
  await cell.waitForFunction(() => window.model.state?.pose?.[2] === 1.3);
  const state = await cell.evaluate(() => window.model.state);
  assert.ok(state.hold === "pose" && state.robot.text.includes("CoGiRo"));
  await cell.close();
});

test("a mistake in the core is told, and the page lives on", async () => {
  // A request of more memory than there is ends the instance like a mistake in the library.
  const told = await page.evaluate(async () => {
    try {
      await window.funicular.crash();
      return "no error";
    } catch (error) {
      return error.message;
    }
  });
  assert.match(told, /mistake in funicular|memory or stack ran out/);
  await choose("caroca");
  assert.equal((await frame()).cables.length, 8);

  // The same instead of a frame: the page shows what happened and how to report it, and the next change is computed.
  await page.evaluate(() => {
    const { engine } = window.funicular;
    const own = engine.call;
    engine.call = (name, more) => {
      if (name !== "frame") {
        return own.call(engine, name, more);
      }
      delete engine.call;
      return own.call(engine, "crash");
    };
  });
  await page.fill("[data-pose='0']", "0.1");
  await page.keyboard.press("Enter");
  await page.waitForFunction(() => /started again/.test(document.getElementById("message").textContent));
  assert.match(
    await text("#message"),
    /mistake in funicular[\s\S]*please report it with the request[\s\S]*The page has started again with the last robot/,
  );
  await nothingShown();
  await framed(async () => {
    await page.fill("[data-pose='0']", "0.2");
    await page.keyboard.press("Enter");
  });
  assert.equal((await frame()).position[0], 0.2);
  assert.equal(await page.locator("#message").isVisible(), false);
});

test("nothing failed on the console, and nothing was requested from a network", () => {
  assert.deepEqual(faults, []);
});

test("the page is as small as promised", (t) => {
  const { all, served, servedWithoutEditor, file } = JSON.parse(readFileSync(join(web, "sizes.json"), "utf8"));
  t.diagnostic(
    `compressed ${all} bytes with gzip, ${served} with Brotli, of it without the editor ${servedWithoutEditor}; funicular.html ${statSync(join(web, "funicular.html")).size}`,
  );
  assert.equal(file, statSync(join(web, "funicular.html")).size);
  if (process.env.FUNICULAR_MEASURE) {
    assert.ok(all <= 2.2e6 && servedWithoutEditor <= 1.5e6);
  }
});

const part = (list, fraction) => [...list].sort((a, b) => a - b)[Math.floor(fraction * (list.length - 1))];

test("the page loads fast enough", { skip: !process.env.FUNICULAR_MEASURE }, async (t) => {
  const loads = [];
  for (let i = 0; i < 5; i += 1) {
    const own = await browser.newContext({ viewport: { width: 1440, height: 900 } });
    const made = await own.newPage();
    const tools = await own.newCDPSession(made);
    await tools.send("Performance.enable", { timeDomain: "threadTicks" });
    await made.goto(address, { waitUntil: "commit" });
    await made.waitForFunction(() => performance.getEntriesByName("complete").length > 0 && window.funicular.idle);
    const marks = await made.evaluate(() =>
      Object.fromEntries(performance.getEntriesByType("mark").map((mark) => [mark.name, mark.startTime])),
    );
    const { metrics } = await tools.send("Performance.getMetrics");
    const of = (name) => metrics.find((one) => one.name === name)?.value ?? NaN;
    loads.push({ ...marks, thread: 1000 * of("TaskDuration"), process: 1000 * of("ProcessTime") });
    await own.close();
  }
  for (const name of ["ready", "frame", "complete"]) {
    t.diagnostic(
      `${name}: median ${part(
        loads.map((one) => one[name]),
        0.5,
      ).toFixed(0)} ms after the address was opened`,
    );
  }
  t.diagnostic(
    `processor time, median: main thread ${part(
      loads.map((one) => one.thread),
      0.5,
    ).toFixed(0)} ms, all threads of the page ${part(
      loads.map((one) => one.process),
      0.5,
    ).toFixed(0)} ms`,
  );
  assert.ok(
    part(
      loads.map((one) => one.frame),
      0.5,
    ) <= 1500,
  );
});

test("a frame is fast enough to drag", { skip: !process.env.FUNICULAR_MEASURE }, async (t) => {
  const own = await opened(address);
  const tools = await own.context().newCDPSession(own);
  await tools.send("Performance.enable", { timeDomain: "threadTicks" });
  const used = async () => {
    const { metrics } = await tools.send("Performance.getMetrics");
    return ["TaskDuration", "ProcessTime"].map(
      (name) => 1000 * (metrics.find((one) => one.name === name)?.value ?? NaN),
    );
  };
  const before = await used();
  const times = await own.evaluate(async () => {
    const { view } = window.funicular;
    const { position, quaternion } = { position: view.handle.position.toArray(), quaternion: [1, 0, 0, 0] };
    window.funicular.times.length = 0;
    view.dragging = true;
    const frames = [];
    let last = performance.now();
    for (let i = 0; i < 300; i += 1) {
      view.tell.drag(
        [position[0] + 2 * Math.sin(i / 30), position[1] + Math.sin(i / 17), position[2] + 0.3 * Math.sin(i / 40)],
        quaternion,
      );
      await new Promise((done) => requestAnimationFrame(done));
      frames.push(performance.now() - last);
      last = performance.now();
    }
    view.dragging = false;
    const responses = [];
    for (let i = 0; i < 30; i += 1) {
      responses.push(await window.funicular.timeOfResponse());
    }
    return { frames, computed: [...window.funicular.times], responses };
  });
  const [thread, whole] = (await used()).map((value, i) => (value - before[i]) / times.computed.length);
  t.diagnostic(
    `processor time per computed frame: main thread ${thread.toFixed(1)} ms, all threads of the page ${whole.toFixed(1)} ms`,
  );
  for (const [name, list] of Object.entries(times)) {
    t.diagnostic(
      `${name}: median ${part(list, 0.5).toFixed(1)} ms, 95th percentile ${part(list, 0.95).toFixed(1)} ms of ${list.length}`,
    );
  }
  assert.ok(part(times.computed, 0.5) <= 16 && part(times.computed, 0.95) <= 33);
  assert.ok(part(times.responses, 0.5) <= 30);
  await own.close();
});
