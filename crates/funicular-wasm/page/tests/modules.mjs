// Structure of the page's script: its modules import each other in no circle, and its lines are short.

import assert from "node:assert/strict";
import { readdirSync, readFileSync } from "node:fs";
import { test } from "node:test";

const source = new URL("../src/", import.meta.url);
const imports = new Map(
  readdirSync(source).map((file) => {
    const text = readFileSync(new URL(file, source), "utf8");
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

test("lines have at most 120 characters, in texts and comments too, which the formatter leaves alone", () => {
  const long = [...imports.keys()].flatMap((file) => {
    const lines = readFileSync(new URL(file, source), "utf8").split("\n");
    return lines.flatMap((line, i) => ([...line].length > 120 ? [`${file}, line ${i + 1}`] : []));
  });
  assert.deepEqual(long, []);
});

test("the state of the page imports nothing, so that each module may use it", () => {
  assert.deepEqual(imports.get("store.js"), []);
});
