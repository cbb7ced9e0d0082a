// A payload is released: the linear modes play the free response from the static displacement under the payload.

import { findFirst, listModes, modeOf, statics } from "./computation.js";
import { Cancelled, Job } from "./engine.js";
import { history, moveClock } from "./figures.js";
import { $, element, plain, short } from "./format.js";
import { decay, startOf, summed, wrenchOf } from "./free_response.js";
import { accept, numberOf, refuse, tell as say } from "./messages.js";
import { emit, on, page, shown } from "./store.js";

const MAX_MODES = 60; // that are drawn, the largest first: more need more time per frame than they show
const MAX_PERIODS = 24; // of the slowest large mode, until the record ends
const REST_FRACTION = 0.02; // of the first displacement: the record may end
const SLOW_HZ = 1; // on the screen, the slowest large mode has at most this frequency
const LARGE = 0.1; // of the largest coordinate: a mode that decides the time scale
const SAMPLES = 1500;
// Relative difference of the static displacement, above which more modes are taken, or the page warns.
const LINEAR_LIMIT = 0.1;
const MAX_TAKEN = 320; // modes that are taken until they reach the static displacement; a frame has at most 500
const job = new Job();
let last = null; // last free response, also for “before”

/** Payload whose weight is a tenth of the platform's, with two digits. */
function firstPayload() {
  const mass = page.about.check.platform.mass_kg;
  return mass > 0 ? Number((0.1 * mass).toPrecision(2)) : 1;
}

async function release() {
  const payload = numberOf($("release-mass").value);
  const {
    about: { check },
    frame,
  } = page;
  if (payload === null || payload <= 0 || payload > 1e9) {
    refuse($("release-mass"), `“${$("release-mass").value}” is not a payload: give a positive mass in kilograms`);
    return;
  }
  accept($("release-mass"));
  const tell = (text) => $("release").replaceChildren(element("p", { class: "soft" }, text));
  if (!frame || frame.modes.length === 0 || frame.stable === false) {
    tell(
      frame
        ? "A release needs a stable equilibrium with natural frequencies."
        : `There is nothing to release from: ${page.reason}.`,
    );
    return;
  }

  // Without the modes of the platform the sum lacks most of the motion.
  tell("Searching the modes that move the platform …");
  await findFirst(frame);
  if (frame !== page.frame) {
    return; // the robot has moved meanwhile
  }
  const point = statics().load_point_m ?? check.load?.point_m ?? [0, 0, 0];
  const wrench = wrenchOf(payload, check.gravity_m_s2, frame.quaternion, point);
  const { complete, reason } = await staticDisplacement(frame, payload, point);
  const { off, starts, linear } = await enoughModes(frame, wrench, complete);
  if (frame !== page.frame) {
    return;
  }
  const size = (i) => Math.abs(starts[i]) * Math.hypot(...frame.modes[i].shape.slice(0, 3));
  const order = frame.modes
    .map((_, i) => i)
    .sort((a, b) => size(b) - size(a))
    .slice(0, MAX_MODES);
  if (!(size(order[0]) > 0)) {
    tell("No mode moves the platform under this payload: without gravity it does nothing.");
    return;
  }
  const note = noteOf({ complete, reason, linear, off, count: frame.modes.length });

  // The slowest of the large modes gives the time scale.
  const large = order.filter((i) => size(i) >= LARGE * size(order[0])).map((i) => frame.modes[i]);
  const slowest = large.reduce((a, b) => (b.hz < a.hz ? b : a));
  const settling = -Math.log(REST_FRACTION) / Math.max(slowest.damping * 2 * Math.PI * slowest.hz, 1e-9);
  const seconds = Math.min(settling, MAX_PERIODS / slowest.hz);
  const up = check.gravity_m_s2.map((value) => -value / Math.hypot(...check.gravity_m_s2));
  const modes = order.map((i) => frame.modes[i]);
  const own = order.map((i) => starts[i]);
  const along = modes.map(({ shape }, k) => own[k] * (shape[0] * up[0] + shape[1] * up[1] + shape[2] * up[2]));
  const at = (t) => along.reduce((sum, value, k) => sum + value * decay(modes[k], t), 0);
  const times = Float64Array.from({ length: SAMPLES }, (_, i) => (seconds * i) / (SAMPLES - 1));
  last = {
    payload,
    seconds,
    times,
    values: times.map(at),
    slowdown: Math.max(1, slowest.hz / SLOW_HZ),
    start: summed(
      modes.map(({ shape }) => shape),
      own,
    ),
    note,
  };

  // Curves of the cables; a cable model that describes ends only has none, and straight lines follow the platform.
  let cables = null;
  try {
    cables = [];
    for (const i of order) {
      cables.push(await modeOf(i));
    }
  } catch {
    cables = null;
  }
  if (frame !== page.frame) {
    return;
  }
  emit("release");
  shown.released = true;
  page.view.playback.setRelease({
    seconds,
    slowdown: last.slowdown,
    clock: (t) => moveClock($("release"), t),
    start: { shape: last.start, cables: cables && summed(cables, own) },
    at: (t) => {
      const factors = modes.map((mode, k) => own[k] * decay(mode, t));
      return {
        shape: summed(
          modes.map(({ shape }) => shape),
          factors,
        ),
        cables: cables && summed(cables, factors),
      };
    },
  });
  $("release-stop").hidden = false;
  show();
}

/**
 * Static displacement under a payload [m] by the complete, not linear model at the present lengths, or why there is
 * none.
 */
async function staticDisplacement(frame, payload, point) {
  const { pose: _, lengths_m: __, tension_rule: ___, ...rest } = statics();
  const { check } = page.about;
  const held = rest.force_n ?? check.load?.force_n ?? [0, 0, 0];
  const force = held.map((value, k) => value + payload * check.gravity_m_s2[k]);
  const lengths = frame.cables.map((cable) => cable.length);
  const request = { command: "statics", ...rest, lengths_m: lengths, force_n: force, load_point_m: point };
  try {
    const text = await job.run(1, async ([worker]) => (await worker.call("answer", { request })).text);
    return { complete: JSON.parse(text).pose.position_m.map((value, k) => value - frame.position[k]) };
  } catch (error) {
    if (error instanceof Cancelled) {
      throw error;
    }
    return { complete: null, reason: error.message };
  }
}

/**
 * Takes more modes until their static displacement is that of the complete model, or until more of them change nothing:
 * then the payload is too large for small motions.
 */
async function enoughModes(frame, wrench, complete) {
  const displacement = () => {
    const starts = startOf(frame.modes, wrench);
    const linear = Array.from(
      summed(
        frame.modes.map(({ shape }) => shape),
        starts,
      ).subarray(0, 3),
    );
    const size = complete ? Math.max(Math.hypot(...complete), 1e-12) : 1;
    return { starts, linear, off: complete ? Math.hypot(...complete.map((value, k) => value - linear[k])) / size : 0 };
  };
  let found = displacement();
  for (let count = 2 * frame.modes.length; found.off > LINEAR_LIMIT && count <= MAX_TAKEN; count *= 2) {
    const before = frame.modes.length;
    await listModes(count);
    if (frame !== page.frame || frame.modes.length === before) {
      break; // the robot has moved meanwhile, or has no more modes
    }
    found = displacement();
  }
  return found;
}

/** What is told about the first displacement. */
function noteOf({ complete, reason, linear, off, count }) {
  if (!complete) {
    return `The complete static model has no equilibrium with this payload at these lengths: ${reason}`;
  }
  const millimetres = (list) => `${short(1000 * Math.hypot(...list), 4)} mm`;
  const apart =
    off > LINEAR_LIMIT
      ? ` They differ by ${short(100 * off, 2)} %: the payload is too large for small motions, or the platform has ` +
        "important modes above these."
      : "";
  return (
    `The complete static model moves the platform by ${millimetres(complete)} under this payload, ` +
    `the listed modes by ${millimetres(linear)} (${count} modes).${apart}`
  );
}

function show() {
  if (!last || !shown.released) {
    return;
  }
  const curves = [{ ...last, kind: "now" }];
  if (page.before?.release) {
    curves.unshift({ ...page.before.release, kind: "past" });
  }
  const figure = history({
    curves,
    label: "displacement of the platform upwards [mm]",
    factor: 1000,
    width: Math.max(280, $("release").clientWidth),
  });
  const scale = page.view.playback.releaseScale;
  const times = `${short(scale > 1 ? scale : 1 / scale, 3)} times ${scale > 1 ? "larger" : "smaller"}`;
  const motion = scale === 1 ? "the motion is to scale" : `the view shows the motion ${times}`;
  $("release").innerHTML = figure;
  const slowdown = last.slowdown > 1 ? `${short(last.slowdown, 2)} times slower` : "as it is";
  $("release").append(element("p", { class: "soft" }, `Time runs ${slowdown}; ${motion}. ${last.note ?? ""}`));
}

/** Ends the motion in the view. */
function stop() {
  if (shown.released) {
    shown.released = false;
    page.view.playback.setRelease(null);
    $("release-stop").hidden = true;
  }
  $("release").replaceChildren();
}

/** Listens to the buttons, and ends the motion when the state changes. */
export function listen() {
  on("robot", (isNew) => {
    if (isNew) {
      $("release-mass").value = plain(firstPayload());
    }
  });
  ["outdated", "empty"].forEach((event) =>
    on(event, () => {
      job.cancel();
      stop();
      last = null;
    }),
  );
  on("forget", () => {
    $("release-mass").value = "";
  });
  on("mode", () => {
    if (shown.mode >= 0) {
      stop();
    }
  });
  on("simulate", stop); // the view has one motion
  on("remember", () => {
    if (page.before) {
      page.before.release = last;
    }
    show();
  });
  $("release-form").addEventListener("submit", (event) => {
    event.preventDefault();
    release().catch((error) => {
      if (!(error instanceof Cancelled)) {
        say(error.message);
      }
    });
  });
  $("release-stop").addEventListener("click", stop);
  new ResizeObserver(show).observe($("release"));
}
