// Engineers' units and words of the values of a robot file.

import assert from "node:assert/strict";
import { test } from "node:test";
import { found, labelOf, shownValue, unitOf, valueOf, wordsOf } from "../src/units.js";

const modulus = {
  path: "materials.wire-rope-4mm.youngs_modulus_pa",
  label: "Young's modulus (wire-rope-4mm) [Pa]",
  meaning: "Young's modulus of the metal area",
  unit: "Pa",
  value: 100e9,
};
const area = { path: "materials.r.area_m2", label: "metal area (r) [m²]", meaning: "", unit: "m²", value: 8.2051e-6 };
const anchor = { path: "cables.1.anchor_m.x", label: "anchor (1), x [m]", meaning: "", unit: "m", value: -0.02 };
const mass = { path: "platform.mass_kg", label: "mass of the platform [kg]", meaning: "", unit: "kg", value: 91 };
const damping = { path: "materials.r.damping_ratio", label: "damping ratio (r)", meaning: "", unit: "1", value: 0.003 };

test("names are words, and values have the units of engineers", () => {
  assert.equal(labelOf(modulus), "Young's modulus of wire-rope-4mm [GPa]");
  assert.equal(shownValue(modulus.value, unitOf(modulus)), 100);
  assert.equal(labelOf(area), "metal area of r [mm²]");
  assert.equal(shownValue(area.value, unitOf(area)), 8.2051);
  assert.equal(labelOf(anchor), "anchor of cable 1, x [m]");
  assert.equal(labelOf(mass), "mass of the platform [kg]");
  assert.equal(labelOf(damping), "damping ratio of r");
  assert.equal(wordsOf({ label: undefined, path: "a.b" }), "a.b");
});

test("ropes have the words of engineers, whatever the name of the rope is", () => {
  const rope = (name) => wordsOf({ ...modulus, path: `materials.${name}.youngs_modulus_pa` });
  assert.equal(rope("'steel 4.0 mm'"), "Young's modulus of steel 4.0 mm");
  assert.equal(rope("r"), "Young's modulus of r");
  assert.equal(wordsOf({ path: "materials.r.breaking_load_n", label: "breaking load (r) [N]" }), "breaking load of r");
});

test("a value keeps its digits through the unit", () => {
  for (const value of [8.2051e-6, 1.7e-5, 3.3333e-6]) {
    const unit = unitOf({ ...area, value });
    assert.equal(valueOf(shownValue(value, unit), unit), value);
  }
  assert.equal(valueOf(100, unitOf(modulus)), 100e9);
  assert.equal(valueOf(0.1 + 0.2, { factor: 1 }), 0.1 + 0.2, "no rounding without a unit");
});

test("a search by words finds values, those that begin with it first", () => {
  const all = [area, anchor, modulus, mass, damping];
  assert.deepEqual(found(all, "mass", 9), [mass]);
  assert.deepEqual(found(all, "anchor x", 9), [anchor]);
  assert.deepEqual(found(all, "young’s", 9), [modulus]);
  assert.deepEqual(found(all, "platform.mass_kg", 9), [mass]);
  assert.deepEqual(found(all, "m", 2).length, 2);
  assert.deepEqual(found(all, "zzz", 9), []);
});
