// Request of a calibration from what a person gives on the page.

import { numberOf } from "./messages.js";

const IN_SPACE = 5; // candidates of a proposal along each axis: 125 positions in space
const IN_PLANE = 9; // and 81 in a plane
const BESIDE = 0.1; // of a range: candidates stay this far from its ends, where the anchors are

/** Texts that are separated by commas. */
const listed = (text) =>
  text
    .split(",")
    .map((part) => part.trim())
    .filter(Boolean);

/** Axes of the candidates of a proposal: positions in the room of the anchors. `ranges`: of each axis along which the
 * platform moves, as `[axis, [from, to]]`. */
export function gridOf(ranges) {
  const count = ranges.length > 2 ? IN_SPACE : IN_PLANE;
  return ranges.map(([axis, [low, high]]) => {
    const [from, to] = [low + BESIDE * (high - low), high - BESIDE * (high - low)];
    return { axis: "xyz"[axis], from: Number(from.toPrecision(6)), to: Number(to.toPrecision(6)), count };
  });
}

/** Field whose text is no number of its kind. */
export class WrongField extends Error {
  constructor(id, message) {
    super(message);
    this.id = id;
  }
}

/**
 * Request without the rows that are left out.
 * @param {object} of `robot`, `readings` (columns), `unknowns` (names), `fields` (texts by their ids), `ranges` as in
 *   `gridOf`
 */
export function requestOf({ robot, readings, unknowns, fields, ranges }) {
  const positive = (id, what) => {
    const text = fields[id];
    const value = numberOf(text);
    if (text.trim() !== "" && !(value > 0)) {
      throw new WrongField(id, `“${text}” is not a ${what}: give a positive number, or nothing`);
    }
    return value;
  };
  const deviation = positive("calibrate-deviation", "deviation in millimetres");
  const proposed = numberOf(fields["calibrate-propose"] || "0");
  if (!Number.isInteger(proposed) || proposed < 0 || proposed > 100) {
    const text = fields["calibrate-propose"];
    throw new WrongField("calibrate-propose", `“${text}” is not a number of poses: give a whole number from 0 to 100`);
  }
  const [held, frame] = [listed(fields["calibrate-held"]), listed(fields["calibrate-frame"])];
  return {
    command: "calibrate",
    robot,
    readings,
    unknowns,
    ...(held.length && { hold_anchors: held }),
    ...(frame.length && { frame }),
    ...(deviation && { length_std_m: deviation / 1000 }),
    static_model: fields["calibrate-model"],
    ...(proposed && { propose: proposed, grid: gridOf(ranges) }),
  };
}
