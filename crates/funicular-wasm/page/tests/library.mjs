// Names of the robots of the library.

import assert from "node:assert/strict";
import { readdirSync, readFileSync } from "node:fs";
import { test } from "node:test";
import { titles } from "../src/library.js";

test("no two robots have the same name", () => {
  const folder = new URL("../../../../robots/", import.meta.url);
  const files = readdirSync(folder).filter((name) => name.endsWith(".toml") && name !== "Cargo.toml");
  const robots = Object.fromEntries(files.map((name) => [name, readFileSync(new URL(name, folder), "utf8")]));
  const all = titles(robots).map(([, title]) => title);
  assert.equal(new Set(all).size, files.length, all.join("\n"));
  assert.ok(all.some((title) => title.endsWith("with winches")));
  const twice = titles({ a: 'name = "A"\n', b: 'name = "A"\n', c: "" }).map(([, title]) => title);
  assert.deepEqual(twice, ["A, a", "A, b", "c"]);
});
