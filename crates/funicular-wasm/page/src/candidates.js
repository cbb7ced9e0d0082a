// Poses around the anchors of a robot, among which one with an equilibrium is searched.

import { freeAxes } from "./measures.js";

const STEPS = [6, 6, 9]; // of the grid along x, y, z

/** Poses between the anchors, and below them as far as the robot is large. */
export function candidates({ anchors, motion }) {
  const axes = freeAxes(motion);
  const of = (k) => anchors.map((anchor) => anchor[k]);
  const [low, high] = [Math.min, Math.max].map((extreme) => [0, 1, 2].map((k) => extreme(...of(k))));
  const size = Math.hypot(...high.map((value, k) => value - low[k]));
  const middle = low.map((value, k) => (value + high[k]) / 2);
  const [from, to] = [[...low], [...high]];
  axes.forEach((k) => {
    if (k === 2) {
      from[2] = Math.min(low[2], high[2] - size);
    } else if (high[k] - low[k] < 0.05 * size) {
      [from[k], to[k]] = [middle[k] - size / 4, middle[k] + size / 4];
    }
  });
  const places = [0, 1, 2].map((k) =>
    axes.includes(k)
      ? Array.from({ length: STEPS[k] }, (_, i) => from[k] + ((to[k] - from[k]) * (i + 1)) / (STEPS[k] + 1))
      : [middle[k]],
  );
  return places[0].flatMap((x) => places[1].flatMap((y) => places[2].map((z) => [x, y, z, 0, 0, 0])));
}

/** The pose that is nearest to the mean of those with a value: inside of the workspace; null if there is none. */
export function innermost(poses, values) {
  const valid = poses.filter((_, i) => Number.isFinite(values[i]));
  const mean = [0, 1, 2].map((k) => valid.reduce((sum, pose) => sum + pose[k], 0) / valid.length);
  const away = (pose) => Math.hypot(...mean.map((value, k) => value - pose[k]));
  return valid.reduce((best, pose) => (best === null || away(pose) < away(best) ? pose : best), null);
}
