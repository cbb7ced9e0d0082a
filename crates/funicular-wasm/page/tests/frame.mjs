// Numbers of a frame as the page reads them.

import assert from "node:assert/strict";
import { test } from "node:test";
import { frameOf } from "../src/frame.js";

/** Frame of one cable with tensions between `lowest` and `highest`, limits 100 and 500 N. */
function frame(lowest, highest, reached, limited) {
  const numbers = new Float64Array(24 + 20);
  numbers.set([1, 0, 0]);
  numbers[18] = limited;
  numbers.set([lowest, highest, 100, 500, reached], 24 + 8);
  return frameOf(numbers).cables[0];
}

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
    assert.equal(frame(lowest, highest, reached, 1).beyond, beyond, `${lowest} to ${highest} N`);
  }
  assert.equal(frame(99, 501, 1, 0).beyond, false, "a robot without limits");
});
