// Words for the border of the workspace.

import assert from "node:assert/strict";
import { test } from "node:test";
import { cableNames, reasonOf } from "../src/border.js";

const none = { one_sided: false, push: [], minimum: [], maximum: [] };

test("the reason names what the cables would have to do", () => {
  assert.equal(reasonOf({ ...none, push: ["3"] }), "cable 3 would have to push");
  assert.equal(
    reasonOf({ ...none, minimum: ["2", "3", "4"] }),
    "cables 2, 3 and 4 would need less than their minimum tension",
  );
  assert.equal(
    reasonOf({ ...none, minimum: ["2"], maximum: ["left rope"] }),
    "cable 2 would need less than its minimum tension, and “left rope” would need more than its maximum tension",
  );
  assert.equal(reasonOf({ ...none, one_sided: true, push: ["1"] }), "no cable pulls against the load");
  [null, none].forEach((border) => assert.equal(reasonOf(border), "no equilibrium was found"));
});

test("many cables are counted, and long names stand alone", () => {
  assert.equal(cableNames(["1", "2", "3", "4", "5"]), "cables 1, 2, 3 and 2 more");
  assert.equal(cableNames(["cable 1", "cable 2"]), "“cable 1” and “cable 2”");
});
