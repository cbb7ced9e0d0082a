// The refit that the page of `calibrate` and the live page share: against a least-squares fit from its rows.

import assert from "node:assert/strict";
import { test } from "node:test";
import {
  refit,
  refitSentence,
  refittedAnchors,
  refittedValues,
  spreadOf,
} from "../../../funicular-pages/templates/refit.js";

// A straight line through points: two values, each row is one point. A fit of all five has these residuals.
const at = [0, 1, 2, 3, 4];
const measured = [1.1, 2.9, 5.2, 6.8, 9.1];

/** Line through points: offset, slope, sum of squares. */
function line(rows) {
  const mean = (of) => rows.reduce((sum, j) => sum + of(j), 0) / rows.length;
  const [x, y] = [mean((j) => at[j]), mean((j) => measured[j])];
  const slope = mean((j) => (at[j] - x) * (measured[j] - y)) / mean((j) => (at[j] - x) ** 2);
  const offset = y - slope * x;
  const chi2 = rows.reduce((sum, j) => sum + (offset + slope * at[j] - measured[j]) ** 2, 0);
  return { offset, slope, chi2, variance: 1 / rows.reduce((sum, j) => sum + (at[j] - x) ** 2, 0) };
}

const all = line([0, 1, 2, 3, 4]);
const linear = {
  free: [
    [1, 0],
    [0, 1],
  ],
  inner: [
    [1, 0],
    [0, 1],
  ],
  information: [
    [5, 10],
    [10, 30],
  ],
  rows: at.map((x, j) => ({ by_free: [[1, x]], residuals: [all.offset + all.slope * x - measured[j]] })),
  units: [1, 1],
  chi2: all.chi2,
  degrees_of_freedom: 3,
};
const data = {
  linear,
  values: [
    { path: "offset", unit: "m", value: all.offset, held: false },
    { path: "slope", unit: "m", value: all.slope, held: false },
  ],
  anchors: [{ position: [all.offset, all.slope, 7], places: [0, 1, null] }],
};

test("without a row the fit is that of the others", () => {
  for (const gone of [[], [2], [0, 4], [1, 2, 3]]) {
    const found = refit(
      linear,
      at.map((_, j) => gone.includes(j)),
    );
    const own = line([0, 1, 2, 3, 4].filter((j) => !gone.includes(j)));
    const [offset, slope] = refittedValues(data, found);
    assert.ok(Math.abs(offset.value - own.offset) < 1e-12 && Math.abs(slope.value - own.slope) < 1e-12, `${gone}`);
    assert.ok(Math.abs(found.chi2 - own.chi2) < 1e-12 && found.degrees === 3 - gone.length);
    const deviation = found.degrees > 0 ? Math.sqrt((own.chi2 / found.degrees) * own.variance) : null;
    assert.ok(deviation === null ? slope.deviation === null : Math.abs(slope.deviation / deviation - 1) < 1e-6);
    const [anchor] = refittedAnchors(data, found);
    assert.deepEqual([anchor.position[0], anchor.position[2]], [offset.value, 7]);
    if (deviation !== null) {
      // The factor of the covariance times its transpose is the covariance, flat along the known coordinate.
      const factor = spreadOf(anchor.covariance, [0, 1, 2]);
      const product = (i, j) => factor[i].reduce((sum, entry, k) => sum + entry * factor[j][k], 0);
      [0, 1, 2].forEach((i) =>
        [0, 1, 2].forEach((j) => assert.ok(Math.abs(product(i, j) - anchor.covariance[i][j]) < 1e-12)),
      );
      assert.deepEqual(factor[2], [0, 0, 0]);
    }
  }
});

test("too few rows determine nothing, and the sentence says so", () => {
  const found = refit(linear, [true, true, true, true, false]);
  assert.equal(found, null);
  assert.match(refitSentence(found, 4), /do not determine all values/);
  assert.ok(refittedValues(data, null).every(({ value, deviation }) => value === null && deviation === null));
  const one = refit(linear, [false, true, false, false, false]);
  assert.match(refitSentence(one, 1), /^Without 1 row: χ² [\d.e-]+ with 2 degrees of freedom\.$/);
  assert.match(refitSentence(refit(linear, [false, false, false, false, false]), 0), /^All rows: χ² /);
});
