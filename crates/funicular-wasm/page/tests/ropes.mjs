// Values that an import asks for.

import assert from "node:assert/strict";
import { test } from "node:test";
import { FIELDS, keysOf, missing, numbersOf, typical } from "../src/ropes.js";

test("typical ropes have the size of those of the library", () => {
  const { mass_kg_per_m: mass, axial_stiffness_n: stiffness } = typical("steel", 4e-3);
  // CoGiRo's rope of 4 mm: 64 g/m, and 100 GPa on 8.2051 mm².
  assert.equal(mass, 0.064);
  assert.ok(Math.abs(stiffness / 820.51e3 - 1) < 0.1, `${stiffness}`);
  assert.ok(typical("fibre", 4e-3).mass_kg_per_m < 0.2 * mass);
});

test("missing values are those that the message names", () => {
  const message =
    "the source lacks values that a robot file needs: the mass of the ropes, give `mass_kg_per_m`; the stiffness of " +
    "the ropes, give `axial_stiffness_n`, or `youngs_modulus_pa` with `diameter_m`";
  assert.deepEqual(missing(message), ["mass_kg_per_m", "axial_stiffness_n"]);
  assert.deepEqual(missing("a.xml:3: `mass_kg` is negative"), []);
});

test("numbers are read in their unit, and wrong ones are refused", () => {
  assert.deepEqual(numbersOf("64", FIELDS.mass_kg_per_m), [0.064]);
  assert.deepEqual(numbersOf(" 1,5", FIELDS.mass_kg_per_m), [0.0015]);
  assert.deepEqual(numbersOf("0, 1; -2", FIELDS.center_of_mass_m), [0, 1, -2]);
  assert.deepEqual(numbersOf("0 1 2.5", FIELDS.center_of_mass_m), [0, 1, 2.5]);
  for (const bad of ["", "a", "1 2", "1e999", "64 65"]) {
    assert.equal(numbersOf(bad, FIELDS.mass_kg_per_m), null, bad);
  }
  assert.equal(numbersOf("1 2", FIELDS.center_of_mass_m), null);
  const keys = keysOf({ mass_kg: [3], inertia_kg_m2: [1, 2, 3] });
  assert.deepEqual(keys, { mass_kg: 3, inertia_kg_m2: [1, 2, 3, 0, 0, 0] });
});
