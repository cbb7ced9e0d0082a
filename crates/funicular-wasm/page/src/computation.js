// From the state to results: the robot, then a frame, then the mode and the response that are shown. When nothing has
// changed for a while, the long computations follow in a worker of their own.

import { Cancelled, Engine, Job } from "./engine.js";
import { frameOf, modesOf } from "./frame.js";
import { busy, tell } from "./messages.js";
import { content, emit, on, page, shown } from "./store.js";

export const POINTS = 33; // per cable: a sagging cable looks smooth
export const RESPONSE_POINTS = 1000;
const SLOW_MS = 30; // a response that takes longer waits until the platform rests
const REST_MS = 250; // without a change: the long computations begin
const MAX_TIMES = 1000;
const MAX_FRAME_MODES = 500; // of a frame: the limit of the core
const MAX_FOLLOWED = 60; // so many modes are listed while the platform is dragged, if its own first one is among them

const details = new Job();
const search = new Job();
const dirty = { robot: false, frame: false, mode: false, response: false };
let stopped = false; // a person has cancelled a frame
let lost = false; // the worker has no frame for the state that holds at the border of the workspace
let running = null; // the computation that is at work

/** True if every change so far has its frame, or the reason why it has none. */
export const isIdle = () =>
  running === null && (page.frame !== null || shown.broken || shown.refused) && page.pending === 0;

/** Notes what has changed and computes it; resolves when everything so far is shown. */
export function change(what) {
  Object.assign(dirty, what);
  if (stopped || shown.refused) {
    stopped = false;
    dirty.robot = true; // the worker has none
  }
  if (dirty.robot || what.frame) {
    cancelLong();
    page.settled = { statics: null, payload: null };
    emit("outdated");
    dirty.frame = true;
  }
  running ??= compute().finally(() => {
    running = null;
  });
  return running;
}

function cancelLong() {
  details.cancel();
  search.cancel();
}

/**
 * Empties what depended on the state: it has no results. No figure of another state is left on the page.
 * @param {string} reason why there are none
 */
export function empty(reason) {
  cancelLong();
  const settled = { statics: null, payload: null };
  Object.assign(page, { frame: null, answered: null, settled, reason, border: null });
  lost = false;
  emit("empty");
}

/** Forgets the robot, because another one comes; `display`: what is shown of that. */
export function forget(display = {}) {
  page.robots += 1;
  followed = 0;
  Object.assign(shown, { mode: -1, newRobot: true, response: null, refused: false, broken: false, ...display });
  Object.assign(page, { about: null, last: null, before: null, parameters: [] });
  tell(null);
  emit("forget");
  empty("the robot is being read");
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
    } else if (lost) {
      computeHeld();
    } else if (dirty.mode) {
      dirty.mode = false;
      await computeMode();
    } else {
      dirty.response = false;
      await computeResponse();
    }
    if (dirty.frame && page.answered?.milliseconds < SLOW_MS && dirty.response && !lost) {
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
export const holdsLengths = () =>
  content.hold === "lengths" || (content.hold === "file" && page.about?.check.state === "lengths");

/** True if the tensions at a pose leave a choice. */
export const mayChoose = () =>
  (content.hold === "pose" || (content.hold === "file" && page.about?.check.state === "pose")) &&
  (page.about ? page.about.check.cables.length > page.about.degrees_of_freedom : true);

async function readRobot() {
  const { robots } = page;
  const done = busy("Reading the robot file", stop);
  try {
    const request = requestOf();
    const found = await page.engine.call("robot", { request });
    if (robots !== page.robots) {
      return; // another one was chosen meanwhile
    }
    const isNew = page.about === null || shown.newRobot;
    page.about = found.about;
    if ("tension_rule" in requestOf() !== "tension_rule" in request) {
      Object.assign(shown, { newRobot: isNew });
      dirty.robot = true; // only its description tells whether a rule counts
      return;
    }
    tell(null);
    shown.newRobot &&= dirty.robot;
    shown.refused = false;
    emit("robot", isNew);
  } catch (error) {
    // A refused robot has no frame, but one that was chosen in the meantime has.
    dirty.frame = dirty.robot;
    if (robots === page.robots && (stopped || !(error instanceof Cancelled))) {
      shown.refused = true;
      const refusal = content.robot.set.length ? "a value of the robot is refused" : "the robot file has an error";
      const failure = error.status ? refusal : "the program for the computation does not run";
      empty(stopped ? "the reading of the robot file was cancelled" : failure);
      if (stopped) {
        tell("Cancelled: the robot file was not read.", true);
      } else {
        emit("robot-refused", error);
      }
    }
  } finally {
    done();
  }
}

function stateOf() {
  if (content.hold === "pose") {
    return { kind: 1, state: content.pose };
  }
  if (content.hold === "lengths") {
    return content.start
      ? { kind: 3, state: [...content.start, ...content.lengths] }
      : { kind: 2, state: content.lengths };
  }
  return { kind: 0, state: [] };
}

/**
 * Ends what the worker of frames does for too long. The next change begins with a new worker, which reads the robot
 * again.
 */
export function stop() {
  page.engine.end();
  page.engine = new Engine();
  stopped = true;
}

let followed = 0; // modes of the next frame, so that the first one of the platform is among them

/** Follows the first mode of the platform from frame to frame: where it is not listed, the next list is longer. */
function follow(frame) {
  const index = frame.first?.index;
  if (index === undefined) {
    followed = frame.modes.length < MAX_FOLLOWED ? Math.min(MAX_FOLLOWED, 2 * frame.modes.length) : 0;
  } else {
    followed = index < MAX_FOLLOWED ? index + 2 : 0;
  }
}

/** Number of modes of the next frame: those of the table, the one in motion, and the first of the platform if near. */
function wantedModes() {
  return Math.min(MAX_FRAME_MODES, Math.max(shown.modes, shown.mode + 1, followed));
}

/** Everything that a frame depends on: values and rule, and the state. */
function inputs() {
  const { robot, rule, hold, pose, lengths, start } = content;
  return { robot, rule, state: { hold, pose, lengths, start } };
}

const sameState = (a, b) => JSON.stringify(a.state) === JSON.stringify(b.state);

/**
 * True if a pose without an equilibrium was wanted of a robot that rests at another one: that one holds with its
 * frame.
 */
function holdsAtBorder(asked, error) {
  const before = page.frame?.of;
  const sameRobot = before && before.robot === asked.robot && before.rule === asked.rule;
  return error.status === 1 && asked.state.hold === "pose" && sameRobot && !sameState(before, asked);
}

/** Holds the last valid state. While a person drags on, the worker computes no frame for it: the page has it. */
function holdAtBorder(asked, error) {
  const { of } = page.frame;
  const isLatest = sameState(inputs(), asked);
  page.border = { pose: asked.state.pose, error, held: of.state };
  if (isLatest) {
    Object.assign(content, of.state);
  }
  lost = true;
  emit("border");
  if (isLatest && !page.view.dragging) {
    computeHeld();
  }
}

/** Computes the state that holds again, so that the worker has its frame. */
function computeHeld() {
  lost = false;
  dirty.frame = true;
  dirty.robot ||= Boolean(content.rule);
}

async function computeFrame() {
  const begin = performance.now();
  const { robots } = page;
  const asked = inputs();
  const done = busy("Computing the equilibrium and its natural frequencies", stop);
  try {
    const found = await page.engine.call("frame", { ...stateOf(), modes: wantedModes(), points: POINTS });
    if (robots !== page.robots) {
      return; // another robot was chosen meanwhile
    }
    const frame = { ...frameOf(found.numbers), about: found.about, of: asked };
    lost = false;
    if (page.border && !sameState(asked, { state: page.border.held })) {
      page.border = null;
    }
    const index = frame.modes.findIndex(isOfPlatform);
    // `first`: the first mode of the platform, as its index or as the reason why there is none; null until it is
    // searched.
    const none = { reason: found.about.no_modes ?? "there are no natural frequencies" };
    const unlisted = frame.modes.length === 0 ? none : null;
    const first = index >= 0 ? { index } : unlisted;
    Object.assign(frame, { first, listed: Math.min(shown.modes, frame.modes.length), inWorker: frame.modes.length });
    follow(frame);
    Object.assign(page, { frame, last: frame, reason: "" });
    tell(null);
    shown.broken = false;
    emit("frame");
    page.times.push(performance.now() - begin);
    page.times.splice(0, page.times.length - MAX_TIMES);
    dirty.response = true;
    dirty.mode = shown.mode >= 0;
  } catch (error) {
    if (robots === page.robots && !stopped && holdsAtBorder(asked, error)) {
      holdAtBorder(asked, error);
    } else if (robots === page.robots && (stopped || !(error instanceof Cancelled))) {
      shown.broken = true;
      const failure = error.status ? "this state is refused" : "the computation has failed";
      const reason = error.status === 1 ? "there is no equilibrium at this state" : failure;
      empty(stopped ? "the computation was cancelled" : reason);
      emit(
        "frame-refused",
        stopped ? new Error("Cancelled: there are no results for this state. The next change computes again.") : error,
      );
    }
  } finally {
    done();
  }
}

/** True for a mode with most of its kinetic energy in the platform. */
const isOfPlatform = (mode) => mode.platformShare >= page.about.platform_share;

let searched = { frame: null, done: null };

/**
 * Searches the first mode of the platform above the list of a frame, in a worker of its own; resolves when `first` of
 * the frame says where it is, or why there is none, or when the state has changed.
 */
export function findFirst(frame) {
  if (frame.first) {
    return Promise.resolve();
  }
  if (searched.frame !== frame) {
    searched = { frame, done: searchFirst(frame) };
  }
  return searched.done;
}

async function searchFirst(frame) {
  const cancelled = () => {
    search.cancel();
    told({ reason: "the search was cancelled" });
  };
  const told = (first) => {
    if (page.frame === frame) {
      frame.first = first;
      emit("platform");
    }
  };
  const done = busy("Searching the first resonance of the platform", cancelled);
  const [request, state] = [requestOf(), stateOf()];
  try {
    const { numbers, about } = await search.run(1, async ([worker]) => {
      await worker.call("robot", { request });
      await worker.call("frame", { ...state, modes: 0, points: 0 });
      return worker.call("platform");
    });
    frame.modes = [...frame.modes, ...modesOf(numbers, frame.cables.length).slice(frame.modes.length)];
    told({ index: about.index });
    if (page.frame === frame) {
      follow(frame);
    }
    if (page.frame === frame && shown.mode >= frame.inWorker) {
      change({ mode: true });
    }
  } catch (error) {
    if (!(error instanceof Cancelled)) {
      told({ reason: error.message });
    }
  } finally {
    done();
  }
}

/** Makes the worker of frames list as many modes of the present frame. */
export async function listModes(count) {
  const { frame } = page;
  if (count > MAX_FRAME_MODES) {
    throw new Error(
      `the motion of the cables is known for the ${MAX_FRAME_MODES} lowest modes only: ` +
        "the view shows that of the platform",
    );
  }
  if (count > frame.inWorker) {
    const { numbers } = await page.engine.call("frame", { ...stateOf(), modes: count, points: 0 });
    const more = frameOf(numbers).modes;
    frame.inWorker = more.length;
    frame.modes = [...frame.modes, ...more.slice(frame.modes.length)];
  }
}

/** Displacements of the cables in a mode of the present frame. */
export async function modeOf(index) {
  await listModes(index + 1);
  return (await page.engine.call("mode", { index, points: POINTS })).numbers;
}

async function computeMode() {
  const { frame, view } = page;
  if (!frame) {
    return;
  }
  if (shown.mode < 0 || shown.mode >= frame.modes.length) {
    view.playback.setMode(null); // a mode of an earlier state, which may come again with the next search
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
  if (shown.mode >= 0 && page.frame === frame) {
    view.playback.setMode({ cables, shape, hz });
  }
}

async function computeResponse() {
  const { frame } = page;
  const { input, output, from, to, log } = shown.response ?? {};
  if (!frame || !input) {
    return;
  }
  const request = { input, output, from_hz: from, to_hz: to, points: RESPONSE_POINTS, log };
  try {
    const found = await page.engine.call("response", { request });
    if (page.frame !== frame) {
      return;
    }
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
    if (!(error instanceof Cancelled) && page.frame === frame) {
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
    if (!frame || view.dragging || lost) {
      return;
    }
    emit("rest");
    const first = findFirst(frame);
    const state = statics();
    const run =
      (command, more = {}) =>
      (found) =>
        found.call("answer", { request: { command, ...state, ...more } });
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
            const columns = [hz, real, imag];
            const numbers = Float64Array.from({ length: 3 * hz.length }, (_, k) => columns[k % 3][Math.floor(k / 3)]);
            page.answered.exact = {
              numbers,
              peaks: peaks.map((peak) => ({ hz: peak.frequency_hz, magnitude: peak.magnitude })),
            };
            page.answered.caveat = warnings.filter((text) => !page.settled.statics.warnings.includes(text)).join(" ");
            emit("response");
          }
        }
      });
    } catch (error) {
      if (!(error instanceof Cancelled)) {
        page.settled = { statics: null, payload: { reason: error.message }, reason: error.message };
        emit("settled");
      }
    }
    done();
    await first;
    emit("rested");
  }, REST_MS);
}

/** Ends a drag: the state that holds has its frame, then the long computations begin. */
export async function endDrag() {
  await running;
  if (lost) {
    computeHeld();
    await change({});
  }
  rest();
}
