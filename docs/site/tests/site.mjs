// The documentation site in headless Chromium, opened from its files. Run by scripts/test-docs.
//
// FUNICULAR_SITE: folder of the site. FUNICULAR_PROGRAM: the program. FUNICULAR_BROWSER: Chromium.

import assert from "node:assert/strict";
import { spawnSync } from "node:child_process";
import { existsSync, mkdirSync, mkdtempSync, readFileSync, readdirSync, rmSync, symlinkSync } from "node:fs";
import { tmpdir } from "node:os";
import { join, resolve } from "node:path";
import { after, before, test } from "node:test";
import { pathToFileURL } from "node:url";
import { chromium } from "playwright-core";

const site = resolve(process.env.FUNICULAR_SITE);
const program = resolve(process.env.FUNICULAR_PROGRAM);
const repository = resolve(import.meta.dirname, "../../..");
const pictures = resolve(site, "../site-screenshots");
const PATIENCE_MS = 60_000;
const DESKTOP = { width: 1280, height: 900 };
const A4_PIXELS = 672; // 178 mm between the margins
const PHONE = { width: 390, height: 844 };

let browser;
const faults = []; // errors on the console, exceptions, and requests to anything but files

before(async () => {
  mkdirSync(pictures, { recursive: true });
  browser = await chromium.launch({
    executablePath: process.env.FUNICULAR_BROWSER,
    args: [
      "--no-sandbox",
      "--disable-dev-shm-usage",
      "--disable-gpu",
      "--enable-unsafe-swiftshader",
      "--proxy-server=127.0.0.1:9",
    ],
  });
});

after(async () => {
  await browser?.close();
});

/** Opens a page of the site in a new window. */
async function opened(name, { viewport = DESKTOP, colorScheme = "light" } = {}) {
  const context = await browser.newContext({ viewport, colorScheme });
  const page = await context.newPage();
  page.setDefaultTimeout(PATIENCE_MS);
  page.on("console", (message) => {
    if (message.type() === "error") faults.push(`${name}: console: ${message.text()}`);
  });
  page.on("pageerror", (error) => faults.push(`${name}: exception: ${error.message}`));
  page.on("request", (request) => {
    if (!/^(file|data|blob):/.test(request.url())) faults.push(`${name}: request to ${request.url()}`);
  });
  const [file, more = ""] = name.split("?");
  await page.goto(pathToFileURL(join(site, file)).href + (more && `?${more}`));
  return page;
}

async function closed(page) {
  await page.context().close();
  assert.deepEqual(faults, []);
}

/** Addresses of the pages that a search finds, the first ones. */
async function found(words) {
  const page = await opened(`search.html?q=${encodeURIComponent(words)}`);
  await page.locator("#search-results ul.search li a").first().waitFor();
  const links = await page.locator("#search-results ul.search li a").evaluateAll((all) => all.map((one) => one.href));
  await closed(page);
  return links.slice(0, 10).map((link) => link.replace(pathToFileURL(site).href + "/", ""));
}

/** Pages that have to be among the first three of a search, as patterns of their addresses. */
const FIRST = {
  "pulley radius": /^(pulleys|robot-file)\.html/,
  "negative tension": /^(conventions|reference\/messages)\.html/,
  "natural frequency": /^(first-result|quick-start)\.html/,
  K_11: /^(glossary|conventions)\.html/,
  Kxx: /^(glossary|conventions)\.html/,
  moment: /^conventions\.html/,
  "sign moment": /^conventions\.html/,
  CASPR: /^coming-from\.html#caspr/,
};

test("search shows first where a reader has to look, with an excerpt", async () => {
  for (const [words, wanted] of Object.entries(FIRST)) {
    const links = await found(words);
    assert.ok(
      links.slice(0, 3).some((link) => wanted.test(link)),
      `${words}: ${links.join(" ")}`,
    );
  }
  const page = await opened("search.html?q=K_11");
  await page.locator("#search-results .excerpt").nth(1).waitFor();
  assert.match(await page.locator("#search-results .excerpt").first().innerText(), /K_11 or Kxx is force along x/);
  await page.screenshot({ path: join(pictures, "search-K_11-desktop.png") });
  await closed(page);
});

/** Plain questions of newcomers, with pages of which one has to be among the first two. */
const QUESTIONS = {
  jupyter: /^jupyter/,
  cite: /^cite/,
  "install windows": /^install/,
  "how do I install it on a mac": /^install/,
  "google colab": /^jupyter/,
  bibtex: /^cite/,
  "cable lengths for a path CSV": /trajectory|trajectories|export/,
  "how exact is the tension in simulate": /^simulation|^validation/,
  "what is the heaviest load my robot can carry": /^workspace|payload|what-can-it-carry/,
  "what happens if a cable breaks": /^simulation|simulate/,
  "can I use it in gazebo": /^export|^import/,
  "run on slurm": /^tutorials\/cluster|^sweeps/,
  "how strong must the motors be": /^workspace|winches|speeds/,
  "do the cables collide": /^workspace|clearance/,
  "how accurate must the anchors be": /^uncertainty|^calibration|^tutorials\/anchors/,
  "why does the camera shake": /settle|gust|first-result|measuring|commands|quick-start/,
  "use with chatgpt": /^python/,
  "excel table of tensions": /commands|export|conventions|sweeps|robot-file|statics/,
  "my robot from matlab": /^matlab|^coming-from/,
  "where are the pulleys of my machine": /^pulleys|^tutorials\/anchors|^calibration/,
  "wind on a stadium camera": /gust|robots|commands|gallery|theory/,
};

test("search answers plain questions among its first two pages", async () => {
  const missed = [];
  for (const [words, wanted] of Object.entries(QUESTIONS)) {
    const links = await found(words).catch(() => ["nothing"]);
    if (!links.slice(0, 2).some((link) => wanted.test(link))) missed.push(`${words}: ${links.slice(0, 4).join(" ")}`);
  }
  assert.deepEqual(missed, []);
});

test("search finds what a reader looks for, from files alone", async () => {
  const negative = await found("negative tension");
  assert.ok(
    negative.some((link) => link.startsWith("reference/messages.html")),
    negative.join(" "),
  );
  const entry = await found("K_11");
  assert.ok(
    entry.some((link) => link.startsWith("theory/")),
    entry.join(" "),
  );
  assert.ok((await found("sign moment")).some((link) => link.startsWith("conventions.html")));
  assert.ok((await found("CASPR")).some((link) => link.startsWith("coming-from.html")));
});

test("equations are typeset by the fonts of the site", async () => {
  const page = await opened("theory/2-static-cable.html");
  await page.evaluate(() => document.fonts.ready);
  const seen = await page.evaluate(() => ({
    equations: document.querySelectorAll(".katex-display").length,
    numbered: [...document.querySelectorAll(".katex-display .katex-html")].some((one) =>
      one.textContent.includes("(4)"),
    ),
    left: document.body.innerText.match(/\\(frac|begin|mathrm|tfrac)/g),
    fonts: [...document.fonts].filter((font) => font.family.startsWith("KaTeX") && font.status === "loaded").length,
  }));
  assert.ok(seen.equations > 10 && seen.numbered && seen.fonts >= 2, JSON.stringify(seen));
  assert.equal(seen.left, null);
  await closed(page);
});

test("figures and notebooks show their pictures", async () => {
  const wanted = { "gallery/index.html": 12, "conventions.html": 6, "quick-start.html": 1 };
  for (const name of ["quick-start", "paper", "identification"]) {
    const notebook = JSON.parse(readFileSync(join(repository, `docs/notebooks/${name}.ipynb`), "utf8"));
    wanted[`notebooks/${name}.html`] = notebook.metadata.funicular.pictures;
  }
  for (const [name, least] of Object.entries(wanted)) {
    const page = await opened(name);
    const sizes = await page.locator("article img").evaluateAll((all) =>
      Promise.all(
        all.map(
          (one) => (
            (one.loading = "eager"),
            one.decode().then(
              () => one.naturalWidth,
              () => 0,
            )
          ),
        ),
      ),
    );
    assert.ok(sizes.length >= least, `${name}: ${sizes.length} pictures, expected ${least}`);
    assert.ok(
      sizes.every((width) => width > 0),
      `${name}: ${sizes}`,
    );
    await closed(page);
  }
});

test("pages fit a phone, in light and dark", async () => {
  const names = ["index.html", "first-result.html", "conventions.html", "theory/7-natural-frequencies.html"];
  names.push(
    "reference/messages.html",
    "reference/commands/modes.html",
    "notebooks/paper.html",
    "tutorials/drawing.html",
  );
  for (const colorScheme of ["light", "dark"]) {
    for (const name of names) {
      const page = await opened(name, { viewport: PHONE, colorScheme });
      const seen = await page.evaluate(() => ({
        wide: document.documentElement.scrollWidth - window.innerWidth,
        background: getComputedStyle(document.body).backgroundColor,
      }));
      assert.ok(seen.wide <= 1, `${name} is ${seen.wide} pixels wider than a phone`);
      const [red] = seen.background.match(/\d+/g).map(Number);
      assert.ok(
        colorScheme === "dark" ? red < 80 : red > 200,
        `${name}: ${colorScheme} has the background ${seen.background}`,
      );
      await page.screenshot({
        path: join(pictures, `${name.replaceAll("/", "-").replace(".html", "")}-phone-${colorScheme}.png`),
      });
      await closed(page);
    }
    const page = await opened("index.html", { colorScheme });
    await page.screenshot({ path: join(pictures, `index-desktop-${colorScheme}.png`) });
    await closed(page);
  }
});

test("pages print to A4 without what only a screen has, and nothing is cut off", async () => {
  const names = ["quick-start.html", "tutorials/drawing.html", "theory/7-natural-frequencies.html", "robot-file.html"];
  for (const name of [...names, "reference/commands/modes.html", "coming-from.html", "validation/index.html"]) {
    const page = await opened(name);
    await page.emulateMedia({ media: "print" });
    await page.setViewportSize({ width: A4_PIXELS, height: 960 });
    await page.evaluate(() => document.fonts.ready);
    const seen = await page.evaluate(() => {
      const shown = (one) => one.getClientRects().length > 0;
      const screen = ".sidebar-drawer, .toc-drawer, .mobile-header, .back-to-top, .run-open, .run-not, .copybtn";
      const article = document.querySelector("article");
      const right = document.documentElement.clientWidth;
      const wide = [...article.querySelectorAll("pre, table, img, p, .equation .katex-html")];
      return {
        left: [...document.querySelectorAll(screen)].filter(shown).map((one) => one.className),
        cut: wide
          .filter((one) => shown(one) && one.getBoundingClientRect().right > right + 1)
          .map((one) => one.outerHTML),
        hidden: [...article.querySelectorAll("pre")].filter((one) => one.scrollWidth > one.clientWidth + 1).length,
      };
    });
    seen.cut = seen.cut.map((text) => text.slice(0, 200));
    assert.deepEqual(seen, { left: [], cut: [], hidden: 0 }, name);
    const pdf = await page.pdf({ preferCSSPageSize: true });
    const [, width, height] = /MediaBox \[0 0 ([\d.]+) ([\d.]+)\]/.exec(pdf.toString("latin1")).map(Number);
    assert.ok(Math.abs(width - 595) < 2 && Math.abs(height - 842) < 2, `${name}: ${width} × ${height} points`);
    await closed(page);
  }
});

test("the number of an equation stands beside it, also on a phone", async () => {
  for (const viewport of [DESKTOP, PHONE]) {
    const page = await opened("theory/4-dynamic-stiffness-of-a-cable.html", { viewport });
    await page.evaluate(() => document.fonts.ready);
    const printedOver = await page.locator(".equation").evaluateAll((all) =>
      all.flatMap((one) => {
        const number = one.querySelector(".katex-tag")?.getBoundingClientRect();
        const bases = [...one.querySelectorAll(".katex-html > .base")].map(
          (base) => base.getBoundingClientRect().right,
        );
        return number && Math.max(...bases) > number.left + 1 ? [one.querySelector(".katex-tag").textContent] : [];
      }),
    );
    assert.deepEqual(printedOver, []);
    await closed(page);
  }
});

test("a message that is pasted leads to its cause and cure", async () => {
  const answers = {
    "error: `mass_kg` is 0, it must be positive": "A value is out of its range or of another kind",
    "unexpected argument '--pos' found": "A word or an option is unknown",
    "mass_kg is -3, it must be positive": "A value is out of its range or of another kind",
    'strain of cable "3" at equilibrium, tension over axial stiffness, is 0.17, usual is at most 0.02: Young\'s modulus in a wrong unit, or axial stiffness in kN given as N, or mass in g?':
      "A cable is strained more than a rope can be",
    "cable slack": "A cable is slack",
  };
  for (const [viewport, name] of [
    [DESKTOP, "desktop"],
    [PHONE, "phone"],
  ]) {
    const page = await opened("reference/messages.html", { viewport });
    for (const [message, title] of Object.entries(answers)) {
      await page.fill("#message", message);
      assert.equal(await page.locator(".message-answers h3").first().innerText(), title, message);
    }
    assert.match(await page.locator(".message-answers > div").first().innerText(), /Cause\.[\s\S]*Cure\./);
    await page.screenshot({ path: join(pictures, `messages-pasted-${name}.png`) });
    // The title leads to the row, and the page is complete again.
    await page.locator(".message-answers h3 a").first().click();
    assert.equal(await page.locator(".message-answers h3").count(), 0);
    assert.match(page.url(), /#a-cable-is-slack$/);
    await closed(page);
  }
});

test("programs find every page as Markdown, and the schemas of the program", () => {
  const text = (name) => readFileSync(join(site, name), "utf8");
  const short = text("llms.txt");
  const full = text("llms-full.txt");
  assert.ok(short.startsWith("# funicular\n\n> ") && full.startsWith("# funicular\n\n> "));

  const links = [...short.matchAll(/^- \[([^\]]+)\]\(([^)]+)\): (.*)$/gm)];
  const names = links.map(([, , name]) => name);
  assert.equal(new Set(names).size, names.length, "each page once");
  for (const [, title, name, about] of links.filter(([, , name]) => name.endsWith(".md"))) {
    const page = text(name);
    assert.ok(title.length > 0 && about.length < 700 && !about.includes("```"), `${name}: ${about}`);
    assert.ok(!/\{(math|toctree|raw)\}/.test(page), `${name} has words of the builder`);
    assert.ok(full.includes(page.trim()), name);
  }
  // Pages with a source; the index of the search and notebooks have none.
  const pages = readdirSync(site, { recursive: true }).filter(
    (name) => /\.html$/.test(name) && !name.startsWith("_static"),
  );
  const without = pages.filter((name) => !existsSync(join(site, name.replace(/html$/, "md"))));
  assert.deepEqual(
    without.filter((name) => !/^(notebooks\/|genindex|search)/.test(name)),
    [],
  );
  for (const name of pages.filter((one) => !without.includes(one) && one !== "index.html")) {
    assert.ok(names.includes(name.replace(/html$/, "md")), `${name} is in llms.txt`);
    assert.match(text(name), /<link rel="alternate" type="text\/markdown"/);
  }
  for (const of of ["robot-file", "request", "results"]) {
    const { stdout } = spawnSync(program, ["schema", "--of", of], { encoding: "utf8", maxBuffer: 2 ** 26 });
    assert.deepEqual(JSON.parse(text(`schema/${of}.json`)), JSON.parse(stdout), of);
    assert.ok(names.includes(`schema/${of}.json`));
  }
});

test("the live page runs inside the site where it was built", async () => {
  const page = await opened("live.html");
  if (existsSync(join(site, "_static/live.html"))) {
    const frame = page.frameLocator("iframe.live");
    await frame.locator("select option").nth(3).waitFor({ state: "attached" });
    await frame.getByText("Loading the program").waitFor({ state: "hidden" });
    // The figures over the view; a narrow page folds its tables.
    await frame.getByText("Highest tension").locator("visible=true").first().waitFor();
    await frame
      .locator("td", { hasText: /^\d+\.\d+$/ })
      .first()
      .waitFor({ state: "attached" });
  } else {
    assert.match(await page.locator("article").innerText(), /scripts\/web/);
  }
  await closed(page);
});

/**
 * Where two texts differ, or an empty text. Numbers of the module differ by rounding: by one in the last of at most six
 * decimals, by 1e-9 of themselves where all digits are printed, or zero but for rounding. Estimates of the error of a
 * simulation are the largest differences of two nearly equal runs, whose steps end elsewhere when the last bit of a sum
 * differs: with `estimates`, numbers of two digits may differ by 15 %.
 */
function same(a, b, { estimates = false } = {}) {
  const words = (text) => text.split(/[\s,]+/).filter(Boolean);
  const number = (word) =>
    /^[(\[]?[-+]?\d[\d.]*(e[-+]?\d+)?[%);.\]]*$/.test(word) ? parseFloat(word.replace(/^[(\[]/, "")) : NaN;
  const digits = (word) => (word.match(/\.(\d+)/)?.[1] ?? "").length;
  const [left, right] = [words(a), words(b)];
  const differ = left.findIndex((word, i) => {
    if (word === right[i]) return false;
    const [x, y] = [number(word), number(right[i] ?? "")];
    if (Number.isNaN(x) || Number.isNaN(y)) return true;
    if (word.includes("e")) return Math.abs(x) > 1e-9 || Math.abs(y) > 1e-9;
    if (estimates && word.replace(/^[0.]+|\D/g, "").length <= 2) return Math.abs(x - y) > 0.15 * Math.abs(y);
    if (digits(word) > 6) return Math.abs(x - y) > 1e-9 * Math.abs(y);
    return digits(word) !== digits(right[i]) || Math.abs(x - y) >= 1.5 * 10 ** -digits(word);
  });
  if (differ < 0 && left.length === right.length) return "";
  const at = differ < 0 ? Math.min(left.length, right.length) : differ;
  const around = (all) => all.slice(Math.max(0, at - 4), at + 4).join(" ");
  return `${around(left)} in place of ${around(right)}`;
}

/** What the program prints for command lines in an own folder, beside the files of the documents. */
function printed(lines) {
  const folder = mkdtempSync(join(tmpdir(), "funicular-site-"));
  for (const name of ["robots", "docs"]) symlinkSync(join(repository, name), join(folder, name));
  // As a terminal shows it: messages first, progress left out, which depends on the machine.
  const told = (text) => text.replace(/^(computing for \d+ s|.* after \d+ s.*)\n/gm, "");
  const found = lines.map((line) => {
    const both = spawnSync("bash", ["-c", line.replace(/^funicular/, program)], { cwd: folder, encoding: "utf8" });
    return { code: both.status, text: `$ ${line}\n${told(both.stderr)}${both.stdout}` };
  });
  rmSync(folder, { recursive: true });
  return { text: found.map(({ text }) => text).join(""), code: found.at(-1).code };
}

// Where scripts/web-program has built the program.
const runs = existsSync(join(site, "_static/run/run.js"));

test(
  "every example that claims to run prints what the program prints",
  { skip: !runs && "the program is not built" },
  async () => {
    const all = readdirSync(site, { recursive: true });
    const names = all.filter((name) => name.endsWith(".html") && !name.startsWith("_static")).sort();
    const wanted = names.filter((name) => readFileSync(join(site, name), "utf8").includes("_static/run/run.js"));
    const wrong = [];
    let count = 0;
    for (const name of wanted.filter((one) => !process.env.FUNICULAR_PAGES || one.match(process.env.FUNICULAR_PAGES))) {
      const page = await opened(name);
      page.setDefaultTimeout(5 * PATIENCE_MS);
      // Answers of exercises are folded.
      await page.evaluate(() => document.querySelectorAll("details").forEach((one) => (one.open = true)));
      while ((await page.locator(".run-open").count()) > 0) {
        const button = page.locator(".run-open").first();
        const block = await button.evaluateHandle((one) => one.previousElementSibling);
        const shown = await block.evaluate((one) => one.querySelector("pre").textContent);
        const begin = performance.now();
        await button.click();
        const bar = await block.evaluateHandle((one) => one.previousElementSibling);
        await page.waitForFunction((one) => /^(done|exit code)/.test(one.querySelector(".run-state").textContent), bar);
        const text = await block.evaluate((one) => one.querySelector("pre").textContent);
        const lines = (await bar.evaluate((one) => one.querySelector("textarea").value)).split("\n");
        if (process.env.FUNICULAR_MEASURE) console.log(name, Math.round(performance.now() - begin), "ms", lines[0]);
        count += 1;
        // What the page shows is compared with the program by another test; a line alone is run.
        const expected = shown.startsWith("$ ") ? shown : printed(lines).text;
        const difference = same(text, expected, { estimates: lines.some((line) => line.includes(" simulate ")) });
        if (difference !== "") wrong.push(`${name}: ${lines.join("; ")}: ${difference}`);
      }
      await closed(page);
    }
    assert.deepEqual(wrong, []);
    assert.ok(count > 0 && (process.env.FUNICULAR_PAGES || count > 80), `${count} examples`);
  },
);

test(
  "a reader changes an example, and gets messages, files and pages",
  { skip: !runs && "the program is not built" },
  async () => {
    for (const [viewport, name] of [
      [DESKTOP, "desktop"],
      [PHONE, "phone"],
    ]) {
      const page = await opened("quick-start.html", { viewport });
      await page.locator(".run-open").first().click();
      const state = page.locator(".run-state").first();
      const field = page.locator(".run-lines").first();
      const pre = page.locator(".run-bar + div pre").first();
      const run = async (line, wanted) => {
        await field.fill(line);
        await page.locator(".run-bar button", { hasText: "Run" }).click();
        await state.filter({ hasText: wanted }).waitFor();
      };
      await state.filter({ hasText: "done" }).waitFor();

      const second = performance.now();
      await run("funicular statics docs/quick-start/hall.toml --poze 1,2,3", "exit code 2");
      assert.ok(performance.now() - second < 2000, "an answer within two seconds once the program is there");
      assert.match(await pre.innerText(), /unexpected argument '--poze'/);
      assert.equal(
        same(await pre.innerText(), printed(["funicular statics docs/quick-start/hall.toml --poze 1,2,3"]).text),
        "",
      );
      await run("funicular statics --help", "done");
      assert.equal(same(await pre.innerText(), printed(["funicular statics --help"]).text), "");
      await run("funicular statics robots/cogiro.toml --pose '1, 2,1.5'", /done|exit/);

      await run("funicular new --cables 4 -o own.toml\nfuniculer", "exit code 127");
      const [download] = await Promise.all([
        page.waitForEvent("download"),
        page.locator(".run-files a").first().click(),
      ]);
      assert.equal(download.suggestedFilename(), "own.toml");
      await run("funicular report own.toml -o own.html", "done");
      await run("funicular statics own.toml -o own.json", "done");
      await run("funicular statics own.toml -o own.json", "done"); // a file of results is replaced
      await run("funicular new -o own.toml", "exit code 2"); // a robot file never is
      assert.match(await pre.innerText(), /own.toml exists and may hold your own numbers/);
      await run("funicular report own.toml -o own.html", "done");
      await page.frameLocator(".run-page").getByText("new robot").first().waitFor();
      const wide = await page.evaluate(() => document.documentElement.scrollWidth - window.innerWidth);
      assert.ok(wide <= 1, `${wide} pixels wider than the window`);
      await page.screenshot({ path: join(pictures, `run-${name}.png`) });

      await page.locator(".run-bar button", { hasText: "Reset" }).click();
      assert.match(await pre.innerText(), /^\$ funicular check/);
      await closed(page);
    }
  },
);

test("an example that cannot run says why", { skip: !runs && "the program is not built" }, async () => {
  const page = await opened("export.html");
  const told = await page.locator(".run-not").allInnerTexts();
  assert.ok(told.length > 0 && told.every((text) => /^Not run in this page: .{10,}\.$/.test(text)), told.join("\n"));
  await closed(page);
});

/** Text of a message as a pattern: what is an ellipsis on the page is anything. */
function pattern(shown) {
  const parts = shown.split("…").map((part) => part.replace(/[.*+?^${}()|[\]\\]/g, "\\$&").replace(/\s+/g, "\\s+"));
  return new RegExp(parts.join("[\\s\\S]*?"));
}

test("what the program refuses is on the page of messages", async () => {
  const page = await opened("reference/messages.html");
  // Folded messages have no inner text.
  const shown = await page.locator("article li > p > code, article li > code").allTextContents();
  assert.ok(shown.length > 800, `${shown.length} messages`);
  // A message that is mostly names and numbers of the user would match anything.
  const patterns = shown.filter((text) => text.replace(/[^a-z]/g, "").length >= 10).map(pattern);
  await closed(page);
  const hall = "docs/quick-start/hall.toml";
  const refused = [
    ["statics", hall, "--mass-kg", "900"],
    ["statics", hall, "--pose", "12,0,3"],
    ["statics", hall, "--pose", "0,0,9"],
    ["statics", hall, "--pose", "1,2"],
    ["statics", hall, "--mass-kg", "17,5"],
    ["statics", hall, "--tension-rule", "closest"],
    ["statics", hall, "--set", "platform.mass=75"],
    ["statics", hall, "--set", "platform.mass_kg=0"],
    ["statics", hall, "--below-hz", "3"],
    ["statics"],
    ["static", hall],
    ["statics", hall, "--set", "materials.rope.damping_ratio=30"],
    ["statics", hall, "--lengths-m", "1,2,3"],
    ["statics", hall, "--load-point-m", "0,0,1"],
    ["statics", "robots/yuan2014-4mm.toml", "--pose", "9,9,3"],
    ["statics", "robots/none.toml"],
    ["modes", hall, "--below-hz", "-2"],
    ["frf", hall, "--from-hz", "2", "--to-hz", "1", "--points", "5"],
    ["frf", hall, "--from-hz", "1", "--to-hz", "2", "--points", "5", "--input", "fq"],
    ["map", hall, "--grid", "x=0:1:2", "--quantity", "dampings"],
    ["map", hall, "--grid", "q=0:1:2"],
    ["payload", hall, "--mass-kg", "9000"],
    ["identify", hall, "--measured", "docs/identification/hall-modes.csv", "--fit", "platform.weight"],
    ["uncertainty", hall, "--of", "tensions"],
    ["design", hall, "--change", "platform.mass_kg=±0"],
    ["reduce", hall, "--below-hz", "5", "--order", "1", "--input", "fz", "--output", "z"],
    ["import", hall],
    ["new", "--cables", "1"],
  ];
  for (const words of refused) {
    const { status, stderr } = spawnSync(program, words, { cwd: repository, encoding: "utf8" });
    assert.ok(status === 1 || status === 2, `${words.join(" ")}: exit code ${status}: ${stderr}`);
    assert.ok(
      patterns.some((one) => one.test(stderr)),
      `${words.join(" ")}: no row for ${stderr}`,
    );
  }
});
