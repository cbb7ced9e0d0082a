// Structure of the page's script: its modules import each other in no circle, and no line is too wide to be read.

import assert from "node:assert/strict";
import { readdirSync, readFileSync } from "node:fs";
import { test } from "node:test";

const source = new URL("../src/", import.meta.url);
const MAX_COLUMNS = 120;
const texts = new Map(readdirSync(source).map((file) => [file, readFileSync(new URL(file, source), "utf8")]));
const imports = new Map(
  [...texts].map(([file, text]) => {
    return [file, [...text.matchAll(/^(?:import|export)\b[^;]*?from "\.\/([\w-]+\.js)";/gm)].map((found) => found[1])];
  }),
);

test("no modules import each other in a circle", () => {
  const done = new Set();
  const visit = (file, path) => {
    assert.ok(!path.includes(file), `${[...path, file].join(" → ")}: move what both need to a module below`);
    if (!done.has(file)) {
      imports.get(file).forEach((next) => visit(next, [...path, file]));
      done.add(file);
    }
  };
  imports.forEach((_, file) => visit(file, []));
  assert.ok(imports.get("main.js").length > 10 && done.size === imports.size, "the imports are not read");
});

test("every module is part of the page or of its worker", () => {
  const used = new Set(["main.js", "worker.js"]);
  for (const file of used) {
    imports.get(file).forEach((next) => used.add(next));
  }
  assert.deepEqual(
    [...imports.keys()].filter((file) => !used.has(file)),
    [],
  );
});

test("the state of the page imports nothing, so that each module may use it", () => {
  assert.deepEqual(imports.get("store.js"), []);
});

test(`no line has more than ${MAX_COLUMNS} columns`, () => {
  const wide = [...texts].flatMap(([file, text]) =>
    text.split("\n").flatMap((line, i) => {
      const columns = [...line].length; // characters, not the units of UTF-16
      return columns > MAX_COLUMNS ? [`${file}:${i + 1}: ${columns} columns`] : [];
    }),
  );
  assert.deepEqual(wide, [], "break these lines");
});
