// The page as four kinds of visitors use it: a lecturer, a designer with an own robot, somebody on a phone, and a person
// with a keyboard and a screen reader. Run by scripts/test-web, as page.mjs.

import assert from "node:assert/strict";
import { createServer } from "node:http";
import { mkdirSync, mkdtempSync, readFileSync, rmSync } from "node:fs";
import { createRequire } from "node:module";
import { tmpdir } from "node:os";
import { join, resolve } from "node:path";
import { after, before, test } from "node:test";
import { pathToFileURL } from "node:url";
import { chromium } from "playwright-core";

const web = resolve(process.env.FUNICULAR_WEB);
const address = pathToFileURL(join(web, "funicular.html")).href;
const pictures = join(web, "screenshots");
const folder = mkdtempSync(join(tmpdir(), "funicular-visit-"));
const require = createRequire(import.meta.url);
const PATIENCE_MS = 60_000;
const PHONE = { viewport: { width: 390, height: 844 }, hasTouch: true, isMobile: true };

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

async function opened(options = {}, url = address) {
  const context = await browser.newContext({
    viewport: { width: 1440, height: 900 },
    acceptDownloads: true,
    ...options,
  });
  const made = await context.newPage();
  made.setDefaultTimeout(PATIENCE_MS);
  made.on("pageerror", (error) => faults.push(error.stack));
  made.on("console", (message) => message.type() === "error" && faults.push(message.text()));
  await made.goto(url);
  await idle(made);
  return made;
}

const idle = (of = page) => of.waitForFunction(() => window.funicular?.idle);
const text = (selector, of = page) => of.locator(selector).innerText();
const frame = (of = page) =>
  of.evaluate(() => {
    const { position, cables, modes } = window.funicular.frame;
    const plain = ({ highest, lowest, sagRatio, slack, length }) => ({ highest, lowest, sagRatio, slack, length });
    return { position, cables: cables.map(plain), hz: modes.map(({ hz }) => hz) };
  });
const settled = (of = page) =>
  of.waitForFunction(() => window.funicular.idle && !/…/.test(document.getElementById("hud").textContent));

async function choose(robot, of = page) {
  await of.selectOption("#library", robot);
  await of.waitForFunction((name) => window.funicular.content.robot.name === name && window.funicular.idle, robot);
}

test("a lecturer sees what this is, and three things to show", async () => {
  assert.match(await text("#welcome"), /^A platform that hangs on 8 cables\. Drag the platform/);
  await settled();
  assert.match(await text("#hud"), /Platform resonance\s+[\d.]+ Hz[\s\S]*Highest tension\s+[\d.]+ N\s+cable 6/);
  assert.match(
    await text("#hud"),
    /Maximum payload\s+\d+ kg\s+limited by cables 3, 6 and 8[\s\S]*Softest stiffness\s+[\d.]+ kN\/m/,
  );

  // A vibration, which Escape ends.
  await page.click("[data-show=mode]");
  await page.waitForFunction(() => window.funicular.view.playback.mode);
  assert.match(await text("#stop-mode"), /^Stop mode 17/);
  await page.keyboard.press("Escape");
  assert.ok(await page.isHidden("#stop-mode"));
  assert.equal(await page.evaluate(() => window.funicular.view.playback.mode), null);

  // A slack cable.
  await page.click("[data-show=slack]");
  await page.waitForFunction(() => /cm longer and hangs/.test(document.getElementById("message").textContent));
  const { cables } = await frame();
  assert.ok(
    cables.some(({ sagRatio, slack }) => slack === 1 || sagRatio >= 0.05),
    JSON.stringify(cables),
  );
  await page.click("#message-close");
  await page.click("#home");
  await idle();

  // The edge: the platform stays within, the way has its curve, and the words say why.
  const start = await frame();
  await page.click("[data-show=edge]");
  await page.waitForFunction(() => window.funicular.border && window.funicular.idle);
  assert.match(await text("#border"), /^Beyond the workspace: cables? .*\.$/);
  assert.ok((await frame()).position[0] > start.position[0] + 3);
  const way = await page.getAttribute("#curves .now", "d");
  assert.ok(way.split(/[ML]/).length > 10, way);
  await page.screenshot({ path: join(pictures, "edge.png") });
});

test("curves and the floor begin with the smooth frequency of the platform", async () => {
  assert.equal(await page.inputValue("#measure"), "platform-frequency");
  assert.match(await text("#measure-note"), /^The frequency of the platform is smooth/);
  // The dot at the platform is on the curve: both are the same measure.
  const of = await page.evaluate(async () => {
    const { content, frame } = window.funicular;
    const quantities = ["platform-frequency"];
    const { columns } = await window.funicular.ask({
      command: "map",
      robot: content.robot,
      quantities,
      poses: [[...frame.position, ...frame.angles]],
    });
    return [columns.platform_frequency_hz[0], frame.about.platform_frequency_hz];
  });
  assert.ok(Math.abs(of[0] / of[1] - 1) < 1e-9, `${of}`);
});

test("the key figure names modes that share the motion of the platform", async () => {
  // Along this line the lowest motion is split over two modes, and then over one again.
  let last = null;
  for (let x = 2.4; x <= 3.45; x += 0.1) {
    await page.fill("[data-pose='0']", x.toFixed(1));
    await page.fill("[data-pose='1']", "0");
    await page.fill("[data-pose='2']", "1.5");
    await page.keyboard.press("Enter");
    await page.waitForFunction(
      (to) => Math.abs(window.funicular.frame.position[0] - to) < 1e-9 && window.funicular.idle,
      Number(x.toFixed(1)),
    );
    await settled();
    const words = await text("#hud");
    const now = {
      hz: Number(/Platform resonance\s+([\d.]+) Hz/.exec(words)[1]),
      told: /move(s?) the platform, too/.test(words),
    };
    if (last && Math.abs(now.hz / last.hz - 1) > 0.05) {
      assert.ok(now.told || last.told, `${x.toFixed(1)}: ${last.hz} to ${now.hz} Hz without a word`);
    }
    last = now;
  }
  await page.click("#home");
  await settled();
});

test("curves and the floor belong to the state, and show the chosen measure", async () => {
  await choose("cogiro");
  await page.selectOption("#measure", "tension-max");
  await page.fill("[data-pose='2']", "2");
  await page.keyboard.press("Enter");
  await page.waitForFunction(() =>
    /^Highest tension at z = 2\.000 m/.test(document.getElementById("floor-legend").textContent),
  );
  const label = await page.getAttribute("#curves svg", "aria-label");
  assert.match(label, /^Highest tension \[N\]: .*along x \[m\]: \d+ to \d+, \d+ of 25 poses without.*along y.*along z/);
  // The value under the platform is that of the frame: the curves are of the same state.
  const found = await page.evaluate(async () => {
    const { content, frame: rest } = window.funicular;
    const poses = [content.pose];
    const asked = { command: "map", robot: content.robot, quantities: ["tension-max"], poses };
    const { columns } = await window.funicular.ask(asked);
    return [columns.tension_max_n[0], Math.max(...rest.cables.map(({ highest }) => highest))];
  });
  assert.ok(Math.abs(found[0] / found[1] - 1) < 1e-9, found.join());
  assert.ok(await page.evaluate(() => window.funicular.view.ground.plane.visible));

  // Another height has another floor; none is shown until it is computed.
  await page.evaluate(() => window.funicular.view.tell.dragBegin());
  await page.fill("[data-pose='2']", "1");
  await page.keyboard.press("Enter");
  await page.waitForFunction(() => window.funicular.frame.position[2] === 1);
  assert.ok(!(await page.evaluate(() => window.funicular.view.ground.plane.visible)), "the floor of another height");
  await page.selectOption("#measure", "");
  assert.equal(await page.locator("#curves svg").count(), 0);
  assert.ok(await page.isHidden("#floor-legend"));
  await page.selectOption("#measure", "platform-frequency");
});

test("the gallery has every robot with a picture, and no name twice", async () => {
  await page.click("#gallery-open");
  const count = await page.locator("#library option").count();
  await page.waitForFunction((of) => document.querySelectorAll("#gallery .picture svg").length === of, count);
  const names = await page.locator("#gallery li").allInnerTexts();
  assert.equal(new Set(names).size, count);
  await page.screenshot({ path: join(pictures, "gallery.png") });
  await page.click("[data-robot=caroca]");
  await page.waitForFunction(() => window.funicular.content.robot.name === "caroca" && window.funicular.idle);
  assert.ok(await page.isHidden("#gallery"));
});

const example = (name) => readFileSync(new URL(`../../../../docs/import/${name}`, import.meta.url), "utf8");
const asFiles = (names) => names.map((name) => ({ name, mimeType: "text/xml", buffer: Buffer.from(example(name)) }));

test("an import asks for the values that the files lack, and ends with figures", async () => {
  await page.setInputFiles("#files", asFiles(["tripod_bodies.xml", "tripod_cables.xml"]));
  await page.waitForSelector("#import[open]");
  assert.match(await text("#import"), /Mass of the ropes \[g\/m\][\s\S]*Axial stiffness EA of the ropes \[kN\]/);
  assert.equal(
    await page
      .locator("#import .assumed")
      .allInnerTexts()
      .then((all) => all.join()),
    "assumed,assumed",
  );
  await page.fill("[data-import=mass_kg_per_m]", "heavy");
  await page.click("#import-go");
  assert.match(await text("#import .field-message"), /“heavy” is not a positive number/);
  await page.fill("[data-import=mass_kg_per_m]", "50");
  await page.click("#import-go");
  await page.waitForFunction(
    () => window.funicular.content.robot.name === "tripod_bodies.toml" && window.funicular.idle,
  );
  const { content } = await page.evaluate(() => ({ content: window.funicular.content }));
  assert.match(content.robot.text, /mass_kg_per_m = 0\.05\b/);
  assert.match(content.robot.text, /^# Assumed on the page[^\n]*\n# - Axial stiffness EA of the ropes: 1700 kN\n#\n/);
  assert.ok((await frame()).cables.length > 0);
  await page.waitForFunction(() => /^Imported/.test(document.getElementById("message").textContent));
  assert.match(await text("#message"), /assumed on this page: Axial stiffness/);

  // Cancelled, the robot of before stays.
  await page.setInputFiles("#files", asFiles(["tripod_bodies.xml", "tripod_cables.xml"]));
  await page.waitForSelector("#import[open]");
  await page.keyboard.press("Escape");
  assert.ok(await page.isHidden("#import"));
  assert.equal(await page.evaluate(() => window.funicular.content.robot.text), content.robot.text);

  // A file without a pose is shown at one with an equilibrium.
  await page.setInputFiles("#files", asFiles(["tripod.wcrfx"]));
  await page.waitForFunction(
    () => document.querySelector("#import[open]") || window.funicular.content.robot.name === "tripod.toml",
  );
  if (await page.isVisible("#import")) {
    await page.click("#import-go");
  }
  await page.waitForFunction(() => /^Imported/.test(document.getElementById("message").textContent));
  await idle();
  assert.ok((await frame()).cables.every(({ highest }) => highest > 0));
});

test("values are found by words and have the units of engineers", async () => {
  await choose("cogiro");
  const modulus = "materials.wire-rope-4mm.youngs_modulus_pa";
  assert.equal(await text(`label[for="value-${modulus}"]`), "Young's modulus of wire-rope-4mm [GPa]");
  assert.equal(await page.inputValue(`[data-number="${modulus}"]`), "100");
  await page.fill(`[data-number="${modulus}"]`, "60");
  await page.keyboard.press("Enter");
  await page.waitForFunction(() => window.funicular.content.robot.set.length === 1 && window.funicular.idle);
  assert.equal((await page.evaluate(() => window.funicular.content.robot.set))[0].value, 60e9);

  await page.fill("#path", "anchor 3 z");
  assert.equal(await page.locator("#paths li").first().innerText(), "exit point of cable 3, z [m]");
  await page.press("#path", "Enter");
  await page.waitForSelector('[data-number="cables.3.anchor_m.z"]');
  await page.fill("#path", "colour");
  await page.press("#path", "Enter");
  assert.match(await text(".add .field-message"), /No value of this robot has “colour” in its name/);
  await page.fill("#path", "");
});

const saved = async (kind, of = page) => {
  await of.click(".menu summary");
  const [download] = await Promise.all([of.waitForEvent("download"), of.click(`[data-save=${kind}]`)]);
  const path = join(folder, download.suggestedFilename());
  await download.saveAs(path);
  return path;
};

test("a saved robot comes back with its state", async () => {
  await choose("cogiro");
  await page.fill("[data-pose='0']", "2");
  await page.keyboard.press("Enter");
  await page.waitForFunction(() => window.funicular.frame?.position[0] === 2 && window.funicular.idle);
  const there = await frame();
  const path = await saved("toml");
  await choose("ipanema2");
  await page.setInputFiles("#files", path);
  await page.waitForFunction(() => window.funicular.frame?.position[0] === 2 && window.funicular.idle);
  const again = await frame();
  there.cables.forEach((cable, i) => assert.ok(Math.abs(again.cables[i].length / cable.length - 1) < 1e-12));

  // Held lengths come back as lengths.
  await page.click("[data-hold=lengths]");
  await idle();
  await page.fill("#tensions tbody tr:first-child input", String(again.cables[0].length - 0.01));
  await page.keyboard.press("Enter");
  await page.waitForFunction((old) => window.funicular.frame.cables[0].length < old - 0.005, again.cables[0].length);
  const shorter = await frame();
  const second = await saved("toml");
  await choose("ipanema2");
  await page.setInputFiles("#files", second);
  await page.waitForFunction(() => window.funicular.content.robot.name.startsWith("cogiro") && window.funicular.idle);
  const last = await frame();
  shorter.cables.forEach(({ highest }, i) => assert.ok(Math.abs(last.cables[i].highest / highest - 1) < 1e-6));
});

test("the card has the link as a code that a camera can read", async () => {
  await choose("cogiro");
  await page.fill("[data-pose='1']", "1");
  await page.keyboard.press("Enter");
  await settled();
  const png = readFileSync(await saved("card"));
  const canvas = require("jsqr/dist/jsQR.js");
  const picture = await page.evaluate(async (base64) => {
    const blob = await (await fetch(`data:image/png;base64,${base64}`)).blob();
    const bitmap = await createImageBitmap(blob);
    const place = new OffscreenCanvas(bitmap.width, bitmap.height);
    const pen = place.getContext("2d");
    pen.drawImage(bitmap, 0, 0);
    const data = pen.getImageData(0, 0, bitmap.width, bitmap.height);
    return { width: data.width, height: data.height, data: Array.from(data.data) };
  }, png.toString("base64"));
  const read = (canvas.default ?? canvas)(Uint8ClampedArray.from(picture.data), picture.width, picture.height);
  assert.ok(read, "no code was found in the card");
  const other = await opened({}, read.data);
  assert.deepEqual((await frame(other)).position, (await frame()).position);
  await other.context().close();
});

test("`?view=only` shows the view with its figures alone", async () => {
  const slide = await opened({ viewport: { width: 800, height: 450 } }, `${address}?view=only`);
  for (const hidden of ["header", "#results", "#robot", "#pose", "footer"]) {
    assert.ok(await slide.locator(hidden).first().isHidden(), hidden);
  }
  const box = await slide.locator("#view").boundingBox();
  assert.ok(box.width >= 798 && box.height >= 448, JSON.stringify(box));
  assert.match(await text("#hud", slide), /Platform resonance/);
  assert.ok(!(await slide.getAttribute("#whole", "href")).includes("view=only"));
  await slide.screenshot({ path: join(pictures, "only.png") });
  await slide.context().close();
});

test("on a phone the view with its figures stays, the rest is folded, and everything can be reached", async () => {
  const phone = await opened({ ...PHONE, colorScheme: "dark" });
  await settled(phone);
  const inWindow = async (selector) => {
    const { y, height } = await phone.locator(selector).boundingBox();
    return y >= 0 && y + height <= 844;
  };
  assert.ok((await inWindow("#view")) && (await inWindow("#hud")));
  assert.equal(await phone.locator("[data-part][open]").count(), 0);
  await phone.evaluate(() => scrollTo(0, 1200));
  assert.ok((await inWindow("#view")) && (await inWindow("#hud")), "the view stays at the top");
  await phone.evaluate(() => scrollTo(0, 0));

  // Every entry of the menu is where a finger can press it.
  await phone.click(".menu summary");
  const covered = await phone.evaluate(() =>
    [...document.querySelectorAll("[data-save]")]
      .filter((button) => {
        const { left, top, width, height } = button.getBoundingClientRect();
        const on = document.elementFromPoint(left + width / 2, top + height / 2);
        return on !== button || left < 0 || left + width > innerWidth;
      })
      .map((button) => button.textContent),
  );
  assert.deepEqual(covered, []);
  await phone.touchscreen.tap(200, 700);
  assert.ok(!(await phone.evaluate(() => document.querySelector(".menu").open)), "a tap elsewhere closes the menu");

  // Targets of 44 pixels, also in the folded parts.
  await phone.evaluate(() => document.querySelectorAll("[data-part]").forEach((part) => (part.open = true)));
  const small = await phone.evaluate(() =>
    [...document.querySelectorAll("button, select, input, summary, [role=option]")]
      .map((one) => [one, one.type === "checkbox" ? one.closest("label") : one])
      .map(([one, place]) => [one, place.getBoundingClientRect()])
      .filter(([, { width, height }]) => width > 0 && (width < 43.9 || height < 43.9))
      .map(([one, { width, height }]) => `${one.id || one.textContent || one.outerHTML} ${width} × ${height}`),
  );
  assert.deepEqual(small, []);
  await phone.screenshot({ path: join(pictures, "phone-open.png"), fullPage: true });
  await phone.context().close();

  // A finger drags the body, and a second one lifts it.
  const touch = await opened(PHONE);
  const tools = await touch.context().newCDPSession(touch);
  const at = await touch.evaluate(() => {
    const { view } = window.funicular;
    const box = view.canvas.getBoundingClientRect();
    const point = view.handle.position.clone().project(view.camera);
    return { x: box.left + ((point.x + 1) * box.width) / 2, y: box.top + ((1 - point.y) * box.height) / 2 };
  });
  const send = (type, points) => tools.send("Input.dispatchTouchEvent", { type, touchPoints: points });
  const start = await frame(touch);
  await send("touchStart", [at]);
  await send("touchMove", [{ x: at.x + 20, y: at.y + 4 }]);
  await send("touchMove", [{ x: at.x + 40, y: at.y + 8 }]);
  await touch.waitForFunction((old) => Math.abs(window.funicular.frame.position[0] - old) > 0.2, start.position[0]);
  const flat = await frame(touch);
  assert.ok(Math.abs(flat.position[2] - start.position[2]) < 2e-3);
  const second = { x: at.x + 100, y: at.y + 60, id: 1 };
  await send("touchStart", [{ x: at.x + 40, y: at.y + 8, id: 0 }, second]);
  await send("touchMove", [{ x: at.x + 40, y: at.y - 12, id: 0 }, second]);
  await send("touchMove", [{ x: at.x + 40, y: at.y - 22, id: 0 }, second]);
  await touch.waitForFunction((old) => window.funicular.frame.position[2] > old + 0.1, flat.position[2]);
  await send("touchEnd", []);
  await idle(touch);
  await touch.context().close();

  // Twice as large, as with a zoom of 400 %: no scrolling sideways.
  const narrow = await opened({ viewport: { width: 320, height: 640 } });
  await narrow.evaluate(() => document.querySelectorAll("[data-part]").forEach((part) => (part.open = true)));
  assert.ok((await narrow.evaluate(() => document.documentElement.scrollWidth)) <= 320);
  await narrow.context().close();
});

test("results are spoken after a move, and the keyboard chooses values and robots", async () => {
  await choose("cogiro");
  await settled();
  await page.evaluate(() => window.funicular.view.canvas.focus());
  await page.keyboard.press("Shift+ArrowRight");
  await page.waitForFunction(() => /x 0\.1/.test(document.getElementById("spoken").textContent));
  assert.match(
    await page.locator("#spoken").textContent(),
    /^Platform at x 0\.1\d*, y 0, z 1\.5\d* metres\. Highest tension [\d.]+ newtons, cable \d\. First resonance of the platform [\d.]+ hertz\.$/,
  );
  await page.focus("#gallery-open");
  await page.keyboard.press("Enter");
  assert.ok(await page.isVisible("#gallery"));
  await page.keyboard.press("Escape");
  assert.ok(await page.isHidden("#gallery"));
  assert.equal(await page.evaluate(() => document.activeElement.id), "gallery-open");
});

for (const [name, options] of Object.entries({
  "in light": {},
  "in the dark": { colorScheme: "dark" },
  "on a phone": { ...PHONE, colorScheme: "dark" },
})) {
  test(`axe finds no violation of WCAG 2.2 AA ${name}`, async () => {
    const own = await opened(options);
    await settled(own);
    await own.evaluate(() => document.querySelectorAll("[data-part]").forEach((part) => (part.open = true)));
    await own.addScriptTag({ content: readFileSync(require.resolve("axe-core/axe.min.js"), "utf8") });
    const check = async (state) => {
      // A page that is scrolled has some control half under its head, and axe would call it too small. Parts that are
      // being computed anew are pale.
      await own.evaluate(() => scrollTo(0, 0));
      await own.waitForFunction(() => !document.querySelector(".stale"));
      const { violations } = await own.evaluate(() =>
        window.axe.run(document, {
          runOnly: ["wcag2a", "wcag2aa", "wcag21a", "wcag21aa", "wcag22aa", "best-practice"],
        }),
      );
      const told = violations.map(
        ({ id, nodes }) =>
          `${state}: ${id}: ${nodes
            .map(({ html }) => html)
            .slice(0, 3)
            .join(" | ")}`,
      );
      assert.deepEqual(told, []);
    };
    await check("at first");
    await own.click("#tab-file");
    await own.waitForSelector("#editor .cm-content");
    await check("with the editor");
    await own.click("#tab-words");
    await check("with the commands");
    await own.click("#tab-values");
    await own.fill("[data-pose='0']", "12");
    await own.keyboard.press("Enter");
    await own.waitForFunction(() => window.funicular.border && window.funicular.idle);
    await own.fill("#path", "nonsense");
    await own.press("#path", "Enter");
    await check("at the border, with a message");
    await own.click("#gallery-open");
    await check("with the gallery");
    await own.context().close();
  });
}

test("validation runs in the page, from its own module", async () => {
  const server = createServer((request, answer) => {
    const name = request.url.split("?")[0].slice(1) || "index.html";
    try {
      const content = readFileSync(join(web, name));
      answer.writeHead(200, name.endsWith(".html") ? { "content-type": "text/html" } : {}).end(content);
    } catch {
      answer.writeHead(404).end();
    }
  });
  await new Promise((done) => server.listen(0, "127.0.0.1", done));
  const own = await opened({}, `http://127.0.0.1:${server.address().port}/`);
  await own.click("#validate-run");
  await own.waitForSelector("#validate .advice", { timeout: 10 * PATIENCE_MS });
  assert.match(await text("#validate .advice", own), /^All \d{4} comparisons are within their tolerance, in [\d.]+ s/);
  assert.ok((await own.locator("#validate tbody tr").count()) > 10);
  await own.context().close();
  server.close();

  // Without a server the page says what to do.
  await page.click("#validate-run");
  assert.match(await text("#validate"), /a page without a server cannot load.*`funicular validate`/);
});

test("memory stays flat over a thousand drags", { skip: !process.env.FUNICULAR_MEASURE }, async (t) => {
  const own = await opened();
  const tools = await own.context().newCDPSession(own);
  await tools.send("HeapProfiler.enable");
  const used = async () => {
    await tools.send("HeapProfiler.collectGarbage");
    return (await tools.send("Runtime.getHeapUsage")).usedSize / 1e6;
  };
  const drags = (count) =>
    own.evaluate(async (of) => {
      const { view } = window.funicular;
      for (let i = 0; i < of; i += 1) {
        view.dragging = true;
        view.tell.dragBegin();
        view.tell.drag([Math.sin(i), Math.cos(1.7 * i), 1.5], [1, 0, 0, 0]);
        view.dragging = false;
        await view.tell.dragEnd();
      }
    }, count);
  await drags(300); // undo has its 200 steps
  const sizes = [await used()];
  for (let i = 0; i < 4; i += 1) {
    await drags(250);
    sizes.push(await used());
  }
  t.diagnostic(`heap after 300 drags and then every 250: ${sizes.map((size) => size.toFixed(1)).join(", ")} MB`);
  assert.ok(sizes.at(-1) - sizes[0] < 2, sizes.join());
  await own.context().close();
});

test("nothing failed on the console", () => assert.deepEqual(faults, []));
