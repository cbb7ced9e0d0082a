// Numbers of a frame as the page reads them.

import assert from "node:assert/strict";
import { test } from "node:test";
import { frameOf } from "../src/frame.js";
import { CABLE, HEADER } from "../src/layout.js";

/** Numbers of a layout with some values by their names; the others are zero. */
const numbersOf = (parts, values) => parts.flatMap(([key, count]) => values[key] ?? Array(count).fill(0));

/** Cable with tensions between `lowest` and `highest`, limits 100 and 500 N, in a frame without points and modes. */
function cable(lowest, highest, reached, limited) {
  const own = numbersOf(CABLE, { lowest, highest, minimum: 100, maximum: 500, reached, anchor: [1, 2, 3] });
  return frameOf(Float64Array.from([...numbersOf(HEADER, { cables: 1, limited }), ...own])).cables[0];
}

test("numbers have the names of the layout, and several with one name are a list", () => {
  const { highest, anchor, points } = cable(120, 300, 0, 1);
  assert.deepEqual([highest, Array.from(anchor), points.length], [300, [1, 2, 3], 0]);
});

test("a tension is beyond a limit only if it has passed it by more than a millionth", () => {
  const cases = [
    [100, 300, -1, false],
    [100 - 1e-5, 300, -1, false],
    [99, 300, -1, true],
    [200, 500, 1, false],
    [200, 501, 1, true],
    [200, 300, 0, false],
  ];
  for (const [lowest, highest, reached, beyond] of cases) {
    assert.equal(cable(lowest, highest, reached, 1).beyond, beyond, `${lowest} to ${highest} N`);
  }
  assert.equal(cable(99, 501, 1, 0).beyond, false, "a robot without limits");
});
