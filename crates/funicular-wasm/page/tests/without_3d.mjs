// The page in a browser without WebGL: everything but the view. Run by scripts/test-web.
//
// FUNICULAR_WEB: folder of the page. FUNICULAR_BROWSER: Chromium.

import assert from "node:assert/strict";
import { join, resolve } from "node:path";
import { after, before, test } from "node:test";
import { pathToFileURL } from "node:url";
import { chromium } from "playwright-core";

const address = pathToFileURL(join(resolve(process.env.FUNICULAR_WEB), "funicular.html")).href;
let browser, page;
const faults = [];

before(async () => {
  browser = await chromium.launch({
    executablePath: process.env.FUNICULAR_BROWSER,
    args: [
      "--no-sandbox",
      "--disable-dev-shm-usage",
      "--disable-gpu",
      "--disable-3d-apis",
      "--proxy-server=127.0.0.1:9",
    ],
  });
  page = await browser.newPage({ viewport: { width: 1440, height: 900 } });
  page.setDefaultTimeout(60_000);
  page.on("console", (message) => message.type() === "error" && faults.push(message.text()));
  page.on("pageerror", (error) => faults.push(error.stack));
  await page.goto(address);
  await page.waitForFunction(() => window.funicular?.idle && window.funicular.frame);
});

after(() => browser?.close());

test("without WebGL the page computes, and says what to do instead of dragging", async () => {
  assert.match(await page.locator("#view").innerText(), /No 3D here: type a pose/);
  assert.ok(await page.isHidden("#view canvas"));
  const tensions = await page.evaluate(() => window.funicular.frame.cables.map(({ highest }) => highest));
  assert.ok(tensions.length === 8 && tensions.every((tension) => tension > 0), `${tensions}`);
  assert.equal(await page.locator("#tensions tbody tr").count(), 8);
  assert.match(await page.locator("#hud").innerText(), /Highest tension\s+[\d.]+ N/);
});

test("without WebGL a typed pose, a vibration and the picture of lines work", async () => {
  await page.fill("[data-pose='0']", "0.5");
  await page.keyboard.press("Enter");
  await page.waitForFunction(() => window.funicular.frame.position[0] === 0.5 && window.funicular.idle);
  await page.click("#modes tbody button >> nth=0");
  await page.waitForFunction(() => window.funicular.idle);
  await page.keyboard.press("Escape");
  await page.selectOption("#library", "ipanema2");
  await page.waitForFunction(() => window.funicular.content.robot.name === "ipanema2" && window.funicular.idle);
  assert.equal(await page.locator("#tensions tbody tr").count(), 8);
  assert.deepEqual(faults, []);
});
