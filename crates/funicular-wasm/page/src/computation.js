// From the state to results: the robot, then a frame, then the mode and the response that are shown. When nothing has
// changed for a while, the long computations follow in a worker of their own.

import { Cancelled, Engine, Job } from "./engine.js";
import { frameOf } from "./frame.js";
import { busy, tell } from "./messages.js";
import { content, emit, on, page, shown } from "./store.js";

export const POINTS = 33; // per cable: a sagging cable looks smooth
export const RESPONSE_POINTS = 1000;
const SLOW_MS = 30; // a response that takes longer waits until the platform rests
const REST_MS = 250; // without a change: the long computations begin
const MAX_TIMES = 1000;

const details = new Job();
const dirty = { robot: false, frame: false, mode: false, response: false };
let stopped = false; // a person has cancelled a frame
let running = null; // the computation that is at work

/** True if every change so far has its frame. */
export const isIdle = () => running === null && page.frame !== null && page.pending === 0;

/** Notes what has changed and computes it; resolves when everything so far is shown. */
export function change(what) {
  Object.assign(dirty, what);
  if (stopped) {
    stopped = false;
    dirty.robot = true;
  }
  if (what.robot || what.frame) {
    details.cancel();
    page.settled = { statics: null, payload: null };
    emit("outdated");
    dirty.frame = true;
  }
  running ??= compute().finally(() => { running = null; });
  return running;
}

/** Computes until nothing has changed; of several changes of one kind the last one counts. */
async function compute() {
  while (dirty.robot || dirty.frame || dirty.mode || dirty.response) {
    if (dirty.robot) {
      dirty.robot = false;
      await readRobot();
    } else if (dirty.frame) {
      dirty.frame = false;
      await computeFrame();
    } else if (dirty.mode) {
      dirty.mode = false;
      await computeMode();
    } else {
      dirty.response = false;
      await computeResponse();
    }
    if (dirty.frame && page.answered?.milliseconds < SLOW_MS && dirty.response) {
      // While the platform is dragged, the response follows every frame.
      dirty.response = false;
      await computeResponse();
    }
  }
  rest();
}

/** Keys of a request for the robot, its loads and its models. */
export const requestOf = () => ({
  robot: content.robot,
  ...content.more,
  ...content.model,
  ...(content.rule && content.hold !== "lengths" && mayChoose() ? { tension_rule: content.rule } : {}),
});

/** Keys of a request for the present state, without the linearisation. */
export function statics() {
  const own = Object.fromEntries(Object.entries(requestOf()).filter(([key]) => !(key in content.model)));
  if (content.hold === "pose") {
    return { ...own, pose: content.pose };
  }
  return content.hold === "lengths" ? { ...own, lengths_m: content.lengths } : own;
}

/** True if the state follows from the cable lengths. */
export const holdsLengths = () => content.hold === "lengths" || (content.hold === "file" && page.about?.check.state === "lengths");

/** True if the tensions at a pose leave a choice. */
export const mayChoose = () =>
  (content.hold === "pose" || (content.hold === "file" && page.about?.check.state === "pose")) &&
  (page.about ? page.about.check.cables.length > page.about.degrees_of_freedom : true);

async function readRobot() {
  try {
    const found = await page.engine.call("robot", { request: requestOf() });
    const isNew = page.about === null || shown.newRobot;
    page.about = found.about;
    tell(null);
    shown.newRobot &&= dirty.robot;
    shown.refused = false;
    emit("robot", isNew);
  } catch (error) {
    // A refused robot has no frame, but one that was chosen in the meantime has.
    dirty.frame = dirty.robot;
    if (!(error instanceof Cancelled)) {
      shown.refused = true;
      emit("robot-refused", error);
    }
  }
}

function stateOf() {
  if (content.hold === "pose") {
    return { kind: 1, state: content.pose };
  }
  if (content.hold === "lengths") {
    return content.start ? { kind: 3, state: [...content.start, ...content.lengths] } : { kind: 2, state: content.lengths };
  }
  return { kind: 0, state: [] };
}

/** Ends a frame that takes too long. The next change begins with a new worker, which reads the robot again. */
function cancelFrame() {
  page.engine.end();
  page.engine = new Engine();
  stopped = true;
}

async function computeFrame() {
  const begin = performance.now();
  const done = busy("Computing the equilibrium and its natural frequencies", cancelFrame);
  try {
    const found = await page.engine.call("frame", { ...stateOf(), modes: shown.modes, points: POINTS });
    page.frame = { ...frameOf(found.numbers), about: found.about };
    tell(null);
    shown.broken = false;
    emit("frame");
    page.times.push(performance.now() - begin);
    page.times.splice(0, page.times.length - MAX_TIMES);
    dirty.response = true;
    dirty.mode = shown.mode >= 0;
  } catch (error) {
    if (!(error instanceof Cancelled)) {
      shown.broken = true;
      emit("frame-refused", error);
    } else if (stopped) {
      tell("Cancelled: the results are those of the last state.", true);
    }
  } finally {
    done();
  }
}

/** Displacements of the cables in a mode of the present frame. */
export const modeOf = async (index) => (await page.engine.call("mode", { index, points: POINTS })).numbers;

async function computeMode() {
  const { frame, view } = page;
  if (shown.mode < 0 || !frame || shown.mode >= frame.modes.length) {
    return;
  }
  const { shape, hz } = frame.modes[shown.mode];
  const cables = await modeOf(shown.mode).catch((error) => {
    if (!(error instanceof Cancelled)) {
      // A cable model that describes ends only has no shapes: straight lines follow the platform.
      tell(error.message, true);
    }
    return null;
  });
  if (shown.mode >= 0) {
    view.setMode({ cables, shape, hz });
  }
}

async function computeResponse() {
  const { input, output, from, to, log } = shown.response ?? {};
  if (!page.frame || !input || shown.broken) {
    return;
  }
  const request = { input, output, from_hz: from, to_hz: to, points: RESPONSE_POINTS, log };
  try {
    const found = await page.engine.call("response", { request });
    const { frequencies, peaks } = found.about;
    const [curve, rest] = [found.numbers.subarray(0, 3 * frequencies), found.numbers.subarray(3 * frequencies)];
    page.answered = {
      numbers: curve,
      peaks: Array.from({ length: peaks }, (_, i) => ({ hz: rest[3 * i], magnitude: rest[3 * i + 2] })),
      unit: found.about.unit,
      milliseconds: found.milliseconds,
      signals: `${output}/${input}`,
      range: `${from} ${to} ${log}`,
    };
    emit("response");
  } catch (error) {
    page.answered = null;
    if (!(error instanceof Cancelled)) {
      emit("response-refused", error);
    }
  }
}

let waitingForRest = 0;

/** Starts the long computations when nothing has changed for a while. */
export function rest() {
  clearTimeout(waitingForRest);
  waitingForRest = setTimeout(async () => {
    const { frame, view } = page;
    if (!frame || shown.broken || shown.refused || view.dragging) {
      return;
    }
    emit("rest");
    const state = statics();
    const run = (command, more = {}) => (found) => found.call("answer", { request: { command, ...state, ...more } });
    const done = busy("Computing the payload and every peak of the response", () => {
      details.cancel();
      page.settled.payload ??= { reason: "cancelled" };
      emit("settled");
    });
    try {
      await details.run(1, async ([worker]) => {
        page.settled = { statics: JSON.parse((await run("statics")(worker)).text), payload: null };
        emit("settled");
        try {
          page.settled.payload = JSON.parse((await run("payload")(worker)).text);
        } catch (error) {
          if (error instanceof Cancelled) {
            throw error;
          }
          page.settled.payload = { reason: error.message };
        }
        emit("settled");
        const { input, output, from, to, log } = shown.response;
        if (from !== null) {
          // While the platform rests, the curve has every peak with its height.
          const own = { input, output, from_hz: from, to_hz: to, log, adaptive: true, ...content.model };
          const { frequency_hz: hz, real, imag, peaks, warnings } = JSON.parse((await run("frf", own)(worker)).text);
          if (page.answered && page.frame === frame) {
            const numbers = Float64Array.from({ length: 3 * hz.length }, (_, k) => [hz, real, imag][k % 3][Math.floor(k / 3)]);
            page.answered.exact = { numbers, peaks: peaks.map((peak) => ({ hz: peak.frequency_hz, magnitude: peak.magnitude })) };
            page.answered.caveat = warnings.filter((text) => !page.settled.statics.warnings.includes(text)).join(" ");
            emit("response");
          }
        }
      });
    } catch (error) {
      if (!(error instanceof Cancelled)) {
        page.settled = { statics: null, payload: null, reason: error.message };
        emit("settled");
      }
    }
    done();
    emit("rested");
  }, REST_MS);
}

on("drag-end", rest);
