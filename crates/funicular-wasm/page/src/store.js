// State of the page: one object that undo restores, and everything that is computed from it. A change is told by an
// event, so that each panel knows the state and no other panel.

/** Part of the state that undo restores and that a link holds. */
export const content = {
  robot: { name: "", text: "", set: [] },
  hold: "file", // state of the file, `pose` or `lengths`
  pose: null, // x, y, z [m], roll, pitch, yaw [degrees]
  lengths: null, // unstrained [m]
  start: null, // position and quaternion from which held lengths are solved
  rule: "",
  pinned: [],
  more: {}, // loads, limits and static model that the page was made with, in the keys of requests
  model: {}, // cable model and terms of the stiffness
};

/** What is shown, without being part of the robot's state. */
export const shown = { mode: -1, modes: 20, response: null, exaggeration: 1, issues: [] };

/** Results for the state, and the parts of the page that are made once. */
export const page = {
  engine: null,
  view: null,
  about: null, // description of the robot by the reader; null if another robot was refused
  parameters: [], // numbers of the robot file without the changes of sliders
  frame: null, // results for the state; null while there are none
  reason: "", // why there are none
  last: null, // last frame of this robot, also after a refused state: where a person moves the platform from
  border: null, // pose that was wanted beyond the workspace, and why it has no equilibrium; the last valid one holds
  robots: 0, // number of robots so far: an answer for an earlier one is dropped
  before: null, // remembered frame, with its response
  answered: null, // response of the frame
  settled: { statics: null, payload: null }, // results of the long computations for the frame
  pending: 0, // readings of parameters without an answer
  times: [], // milliseconds from a request of a frame to its display
};

const listeners = new Map();

/** Calls `work` at each event of this name. Listeners are called in the order in which they were added. */
export function on(name, work) {
  listeners.set(name, [...(listeners.get(name) ?? []), work]);
}

/** Tells an event to its listeners. */
export function emit(name, ...values) {
  listeners.get(name)?.forEach((work) => work(...values));
}
