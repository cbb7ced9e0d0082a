// Numbers of a frame as named values.

import { CABLE, HEADER, KINDS, MODE } from "./layout.js";

const sizeOf = (parts) => parts.reduce((sum, [, count]) => sum + count, 0);
const [HEADER_SIZE, CABLE_SIZE, MODE_SIZE] = [HEADER, CABLE, MODE].map(sizeOf);

/** Named values of numbers in the order of a layout: one number, or several as a part of the list. */
function named(parts, numbers) {
  let at = 0;
  return Object.fromEntries(
    parts.map(([key, count]) => {
      const value = count === 1 ? numbers[at] : numbers.subarray(at, at + count);
      at += count;
      return [key, value];
    }),
  );
}

// Relative distance by which a tension is beyond its limit. `reached` of the frame tells less: the tensions of most
// rules are at a limit, and stay there when the lengths are held, to the accuracy of the search.
const LIMIT_MARGIN = 1e-6;

/** True if a tension is beyond its limits: reaching one is not enough. */
const isBeyond = ({ reached, lowest, highest, minimum, maximum }) =>
  reached !== 0 && (highest > maximum * (1 + LIMIT_MARGIN) || lowest < minimum * (1 - LIMIT_MARGIN));

/** Frame with named values. `numbers` are kept, because the points are parts of them. */
export function frameOf(numbers) {
  const { stability, ...head } = named(HEADER, numbers);
  const { cables, pointsPerCable: points, modes } = head;
  const atPoints = HEADER_SIZE + cables * CABLE_SIZE;
  const atModes = atPoints + 3 * cables * points;
  const limited = head.limited === 1;
  return {
    ...head,
    position: Array.from(head.position),
    quaternion: Array.from(head.quaternion),
    angles: Array.from(head.angles),
    stable: [undefined, false, true][stability + 1],
    limited,
    unloaded: head.unloaded === 1,
    certified: head.certified === 1,
    cables: Array.from({ length: cables }, (_, i) => {
      const cable = named(CABLE, numbers.subarray(HEADER_SIZE + i * CABLE_SIZE, HEADER_SIZE + (i + 1) * CABLE_SIZE));
      cable.beyond = limited && isBeyond(cable);
      cable.points = numbers.subarray(atPoints + 3 * points * i, atPoints + 3 * points * (i + 1));
      return cable;
    }),
    modes: modesOf(numbers.subarray(atModes, atModes + modes * (MODE_SIZE + cables)), cables),
  };
}

/** Modes of their numbers, for a robot with this number of cables. */
export function modesOf(numbers, cables) {
  const size = MODE_SIZE + cables;
  return Array.from({ length: numbers.length / size }, (_, i) => {
    const own = numbers.subarray(i * size, (i + 1) * size);
    const mode = named(MODE, own);
    return {
      ...mode,
      kind: KINDS[mode.kind],
      shape: Array.from(mode.shape),
      cableShares: Array.from(own.subarray(MODE_SIZE)),
    };
  });
}

/** Rotation matrix, by rows, of a unit quaternion w, x, y, z. */
export function rotation([w, x, y, z]) {
  return [
    [1 - 2 * (y * y + z * z), 2 * (x * y - w * z), 2 * (x * z + w * y)],
    [2 * (x * y + w * z), 1 - 2 * (x * x + z * z), 2 * (y * z - w * x)],
    [2 * (x * z - w * y), 2 * (y * z + w * x), 1 - 2 * (x * x + y * y)],
  ];
}

/** Quaternion w, x, y, z of roll, pitch, yaw in degrees, R = Rz(yaw) Ry(pitch) Rx(roll). */
export function quaternionOf(angles) {
  const [[cr, sr], [cp, sp], [cy, sy]] = angles.map((angle) => {
    const half = (angle * Math.PI) / 360;
    return [Math.cos(half), Math.sin(half)];
  });
  return [
    cr * cp * cy + sr * sp * sy,
    sr * cp * cy - cr * sp * sy,
    cr * sp * cy + sr * cp * sy,
    cr * cp * sy - sr * sp * cy,
  ];
}

/** Roll, pitch, yaw in degrees of a unit quaternion. */
export function anglesOf(quaternion) {
  const r = rotation(quaternion);
  const degrees = (angle) => (angle * 180) / Math.PI;
  return [
    degrees(Math.atan2(r[2][1], r[2][2])),
    degrees(Math.asin(Math.max(-1, Math.min(1, -r[2][0])))),
    degrees(Math.atan2(r[1][0], r[0][0])),
  ];
}
