// Numbers of a frame as named values. The layout is in docs/web.md.

const HEADER = 24;
const CABLE = 20;
const MODE = 12;
const KINDS = ["platform", "cable", "drive", "mixed"];
const CABLE_KEYS = [
  "length", "tension", "tensionAnchor", "tensionDrum", "chord", "sagRatio", "lambda2", "stringHz", "lowest", "highest",
  "minimum", "maximum", "reached", "slack",
];

// Relative distance by which a tension is beyond its limit. `reached` of the frame tells less: the tensions of most
// rules are at a limit, and stay there when the lengths are held, to the accuracy of the search.
const LIMIT_MARGIN = 1e-6;

/** True if a tension is beyond its limits: reaching one is not enough. */
const isBeyond = ({ reached, lowest, highest, minimum, maximum }) =>
  reached !== 0 && (highest > maximum * (1 + LIMIT_MARGIN) || lowest < minimum * (1 - LIMIT_MARGIN));

/** Frame with named values. `numbers` are kept, because the points are parts of them. */
export function frameOf(numbers) {
  const [cables, points, modes] = numbers;
  const atPoints = HEADER + cables * CABLE;
  const atModes = atPoints + 3 * cables * points;
  const limited = numbers[18] === 1;
  return {
    position: Array.from(numbers.slice(3, 6)),
    quaternion: Array.from(numbers.slice(6, 10)),
    angles: Array.from(numbers.slice(10, 13)),
    residual: numbers[13],
    iterations: numbers[14],
    stable: [undefined, false, true][numbers[15] + 1],
    minStiffness: numbers[16],
    distance: numbers[17],
    limited,
    belowHz: numbers[20],
    countBelow: numbers[21],
    certified: numbers[22] === 1,
    unstableDirections: numbers[23],
    pointsPerCable: points,
    cables: Array.from({ length: cables }, (_, i) => {
      const own = numbers.subarray(HEADER + i * CABLE, HEADER + (i + 1) * CABLE);
      const cable = Object.fromEntries(CABLE_KEYS.map((key, k) => [key, own[k]]));
      cable.beyond = limited && isBeyond(cable);
      cable.attachment = own.subarray(14, 17);
      cable.anchor = own.subarray(17, 20);
      cable.points = numbers.subarray(atPoints + 3 * points * i, atPoints + 3 * points * (i + 1));
      return cable;
    }),
    modes: modesOf(numbers.subarray(atModes, atModes + modes * (MODE + cables)), cables),
  };
}

/** Modes of their numbers, for a robot with this number of cables. */
export function modesOf(numbers, cables) {
  return Array.from({ length: numbers.length / (MODE + cables) }, (_, i) => {
    const own = numbers.subarray(i * (MODE + cables), (i + 1) * (MODE + cables));
    return {
      hz: own[0],
      multiplicity: own[1],
      damping: own[2],
      kind: KINDS[own[3]],
      platformShare: own[4],
      mass: own[5],
      shape: Array.from(own.subarray(6, 12)),
      cableShares: Array.from(own.subarray(MODE)),
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
