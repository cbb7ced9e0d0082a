// Layout of the numbers of a frame: names and counts, in their order. Do not edit:
// `UPDATE_DOCS=1 cargo test -p funicular-wasm layout` writes this file from src/layout.rs of the module.

/** Numbers before the cables. */
export const HEADER = [
  ["cables", 1],
  ["pointsPerCable", 1],
  ["modes", 1],
  ["position", 3],
  ["quaternion", 4],
  ["angles", 3],
  ["residual", 1],
  ["iterations", 1],
  ["stability", 1],
  ["minStiffness", 1],
  ["distance", 1],
  ["limited", 1],
  ["unloaded", 1],
  ["belowHz", 1],
  ["countBelow", 1],
  ["certified", 1],
  ["unstableDirections", 1],
];

/** Numbers of each cable. */
export const CABLE = [
  ["length", 1],
  ["tension", 1],
  ["tensionAnchor", 1],
  ["tensionDrum", 1],
  ["chord", 1],
  ["sagRatio", 1],
  ["lambda2", 1],
  ["stringHz", 1],
  ["lowest", 1],
  ["highest", 1],
  ["minimum", 1],
  ["maximum", 1],
  ["reached", 1],
  ["slack", 1],
  ["attachment", 3],
  ["anchor", 3],
];

/** Numbers of each mode, which the energy fractions of the cables follow. */
export const MODE = [
  ["hz", 1],
  ["multiplicity", 1],
  ["damping", 1],
  ["kind", 1],
  ["platformShare", 1],
  ["mass", 1],
  ["shape", 6],
];

/** Kinds of modes, by their numbers. */
export const KINDS = ["platform", "cable", "drive", "mixed"];
