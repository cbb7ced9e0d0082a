// Modes that move the platform beside its first resonance: near a resonance of a cable, a motion is split over several.

import { short } from "./format.js";

/**
 * Modes below the first one of the platform with a considerable share of its motion; of all listed modes while the
 * first one is not known.
 * @param {object} frame `modes`, and `first` with its index
 * @param {number} considerable least share of the kinetic energy
 */
export function sharingModes(frame, considerable) {
  const end = frame.first?.index ?? frame.modes.length;
  return frame.modes.slice(0, end).filter((mode) => mode.platformShare >= considerable);
}

const listed = (texts) => texts.join(", ").replace(/, ([^,]*)$/, " and $1");

/** Sentence on such modes; empty without. */
export function sharingText(frame, considerable) {
  const modes = sharingModes(frame, considerable);
  if (modes.length === 0) {
    return "";
  }
  const shares = modes.map((mode) => `${(100 * mode.platformShare).toFixed(0)} %`);
  const hz = listed(modes.map((mode) => short(mode.hz, 3)));
  return `${hz} Hz move${modes.length === 1 ? "s" : ""} the platform, too: ${listed(shares)}`;
}
