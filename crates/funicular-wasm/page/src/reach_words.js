// Rays of the reach from the numbers of the core, and what they say in words.

import { short } from "./format.js";

const NUMBERS = 5; // of a ray: x, y, z, distance, and 1 at the border

/** Rays of the numbers of an answer. */
export const raysOf = (numbers) =>
  Array.from({ length: numbers.length / NUMBERS }, (_, i) => {
    const [x, y, z, distance, isBorder] = numbers.subarray(NUMBERS * i, NUMBERS * (i + 1));
    return { end: [x, y, z], distance, isBorder: isBorder === 1 };
  });

/** Words on the reach: the nearest border, in which direction, and what ends there. */
export function words({ from, rays, conditions, isInBox }) {
  const kept = conditions.join(", ");
  if (!isInBox) {
    return "The platform is beyond the box of its anchors and the origin, in which the reach is searched.";
  }
  if (rays.length === 0) {
    return `Not kept at this pose: ${kept}.`;
  }
  const borders = rays.filter(({ isBorder }) => isBorder);
  if (borders.length === 0) {
    return `Everywhere in the box of the anchors: ${kept}.`;
  }
  const nearest = borders.reduce((a, b) => (b.distance < a.distance ? b : a));
  const along = nearest.end.map((at, k) => (at - from[k]) / Math.max(nearest.distance, 1e-12));
  const k = along.reduce((best, value, i) => (Math.abs(value) > Math.abs(along[best]) ? i : best), 0);
  const where = `${along[k] < 0 ? "−" : "+"}${"xyz"[k]}`;
  return `${short(nearest.distance, 3)} m to the nearest border, towards ${where} (${kept}; ${rays.length} rays).`;
}
