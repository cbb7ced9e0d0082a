// Free response of the linear model after a payload is released: a sum of decaying modes. No part of the page, so that
// it can be tested alone.

const TAU = 2 * Math.PI;

/** Rotates a vector of the platform into the world by a unit quaternion w, x, y, z. */
function rotated([w, x, y, z], v) {
  const cross = (a, b) => [a[1] * b[2] - a[2] * b[1], a[2] * b[0] - a[0] * b[2], a[0] * b[1] - a[1] * b[0]];
  const t = cross([x, y, z], v).map((value) => 2 * value);
  const u = cross([x, y, z], t);
  return v.map((value, k) => value + w * t[k] + u[k]);
}

/**
 * Wrench (force, moment about the platform's origin, world axes) of a payload [kg] that hangs at a point of the
 * platform.
 */
export function wrenchOf(payload, gravity, quaternion, point = [0, 0, 0]) {
  const force = gravity.map((value) => payload * value);
  const [x, y, z] = rotated(quaternion, point);
  return [...force, y * force[2] - z * force[1], z * force[0] - x * force[2], x * force[1] - y * force[0]];
}

/**
 * Modal coordinates at the release: the static displacement of each mode under the wrench, `φᵀw / (ω² m)`.
 * @param {object[]} modes of a frame, with `hz`, `mass`, `damping`, `shape`
 */
export function startOf(modes, wrench) {
  return modes.map(({ hz, mass, shape }) => {
    const work = shape.reduce((sum, value, k) => sum + value * wrench[k], 0);
    return work / ((TAU * hz) ** 2 * mass);
  });
}

/**
 * Factor of a modal coordinate at a time [s] after the release from rest: the solution of `q̈ + 2ζω q̇ + ω² q = 0` with
 * q = 1 and q̇ = 0 at the beginning.
 */
export function decay({ hz, damping }, t) {
  const omega = TAU * hz;
  if (damping > 1) {
    const root = Math.sqrt(damping * damping - 1);
    const [slow, fast] = [-omega * (damping - root), -omega * (damping + root)];
    return (slow * Math.exp(fast * t) - fast * Math.exp(slow * t)) / (slow - fast);
  }
  if (damping === 1) {
    return (1 + omega * t) * Math.exp(-omega * t);
  }
  const root = Math.sqrt(1 - damping * damping);
  return Math.exp(-damping * omega * t) * (Math.cos(root * omega * t) + (damping / root) * Math.sin(root * omega * t));
}

/** Sum of modes with factors, for their shapes or for the points of their cables. */
export function summed(parts, factors) {
  const sum = new Float64Array(parts[0].length);
  parts.forEach((part, i) => {
    const factor = factors[i];
    for (let k = 0; k < sum.length; k += 1) {
      sum[k] += factor * part[k];
    }
  });
  return sum;
}
