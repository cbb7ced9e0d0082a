// Modes that share the motion of the platform, and the sentence on them.

import assert from "node:assert/strict";
import { test } from "node:test";
import { sharingModes, sharingText } from "../src/platform_modes.js";

const frame = (shares, index) => ({
  first: index === undefined ? null : { index },
  modes: shares.map((platformShare, i) => ({ hz: 5 + 0.25 * i, platformShare })),
});

test("only modes below the first one of the platform count, with a considerable share", () => {
  const split = frame([0.02, 0.43, 0.19, 0.28, 0.91, 0.4], 4);
  assert.deepEqual(
    sharingModes(split, 0.2).map(({ hz }) => hz),
    [5.25, 5.75],
  );
  assert.equal(sharingText(split, 0.2), "5.25 and 5.75 Hz move the platform, too: 43 % and 28 %");
  assert.equal(sharingText(frame([0.01, 0.97], 1), 0.2), "");
  assert.equal(sharingText(frame([0.3, 0.97], 1), 0.2), "5.00 Hz moves the platform, too: 30 %");
  // While the first one is searched above the list, all listed modes count.
  assert.equal(sharingModes(frame([0.3, 0.1, 0.25]), 0.2).length, 2);
});
