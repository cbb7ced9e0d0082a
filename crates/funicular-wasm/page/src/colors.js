// Colours of tensions, and which cable is nearest to its limit.

import { Color } from "three";

/** Colours of tension from low to high, readable with any colour vision and on both backgrounds. */
const SCALE = ["#3b6fb6", "#4aa3c8", "#62b78f", "#c9a227", "#d9772b", "#c23b22"].map((hex) => new Color(hex));
/** Colours of states. */
export const COLORS = { slack: "#8a8f98", beyond: "#d1249d" };

/** Colour of a fraction from 0 to 1. */
export function colorOf(fraction) {
  const at = Math.max(0, Math.min(1, fraction)) * (SCALE.length - 1);
  const low = Math.min(SCALE.length - 2, Math.floor(at));
  return SCALE[low].clone().lerp(SCALE[low + 1], at - low);
}

/** True if a cable has a maximum tension. */
export const isLimited = (frame, cable) => frame.limited && Number.isFinite(cable.maximum);

/** The cable with the highest tension, as a part of its limit if every cable has one. */
export function limitingCable(frame) {
  const all = frame.cables.every((cable) => isLimited(frame, cable));
  const size = ({ highest, maximum }) => (all ? highest / maximum : highest);
  return frame.cables.reduce((best, cable, i) => (size(cable) > size(frame.cables[best]) ? i : best), 0);
}
