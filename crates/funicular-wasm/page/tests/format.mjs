// Numbers in words.

import assert from "node:assert/strict";
import { test } from "node:test";
import { span } from "../src/format.js";

test("values are one number if they are equal, and else the smallest and the largest", () => {
  assert.equal(span([30, 30, 30]), "30.0");
  assert.equal(span([80, 30, 50]), "30.0 to 80.0");
  assert.equal(span([12345]), "12\u202f345");
});
