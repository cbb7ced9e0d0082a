// A stop of the platform, with and without an input shaper: the core's `settle`, computed in a worker.

import { statics } from "./computation.js";
import { Cancelled, Job } from "./engine.js";
import { history } from "./figures.js";
import { $, element, plain, short } from "./format.js";
import { accept, busy, numberOf, refuse } from "./messages.js";
import { content, on, page } from "./store.js";

const COLUMNS = 700; // of the figure: of longer records the extremes of each column are drawn
const FIELDS = { "stop-speed": "speed in metres per second", "stop-time": "time in seconds" };
const job = new Job();
let found = null; // last answer, with its request

/** Values of the fields; the first one that is wrong is refused. */
function values() {
  for (const [id, words] of Object.entries(FIELDS)) {
    const value = numberOf($(id).value);
    if (value === null || !(value > 0)) {
      refuse($(id), `“${$(id).value}” is not a ${words}: give a positive number`);
      return null;
    }
    accept($(id));
  }
  return { speed: numberOf($("stop-speed").value), time: numberOf($("stop-time").value) };
}

async function stop() {
  const given = values();
  if (!given) {
    return;
  }
  const tell = (text) => $("stop").replaceChildren(element("p", { class: "soft" }, text));
  if (!page.frame) {
    tell(`There is nothing to stop: ${page.reason}.`);
    return;
  }
  const axis = ["x", "y", "z"].indexOf($("stop-axis").value);
  const velocity = [0, 1, 2].map((k) => (k === axis ? given.speed : 0));
  const shaper = $("stop-shaper").value;
  const request = {
    command: "settle",
    ...statics(),
    ...content.model,
    stop_m_s: velocity,
    profile_s: [given.time],
    ...(shaper && { shaper }),
  };
  const done = busy("Computing the motion after the stop", () => job.cancel());
  try {
    const text = await job.run(1, async ([worker]) => (await worker.call("answer", { request })).text);
    found = { answer: JSON.parse(text), axis };
    show();
  } catch (error) {
    if (!(error instanceof Cancelled)) {
      found = null;
      tell(error.message);
    }
  } finally {
    done();
  }
}

/** Displacement along an axis over time, with the extremes of each column of the figure. */
function record(rows, axis, kind) {
  const of = ({ x_m: x, y_m: y, z_m: z }) => [x, y, z][axis];
  const every = Math.max(1, Math.ceil(rows.length / COLUMNS));
  const kept = [];
  for (let first = 0; first < rows.length; first += every) {
    const part = rows.slice(first, first + every);
    const [low, high] = [Math.min, Math.max].map((extreme) => part.find((row) => of(row) === extreme(...part.map(of))));
    kept.push(...(low.t_s <= high.t_s ? [low, high] : [high, low]));
  }
  return { times: kept.map((row) => row.t_s), values: kept.map(of), kind };
}

/** The same length of time for both curves: a curve that ends before is at rest within the tolerance. */
const until = ({ times, values, kind }, end) =>
  times.at(-1) < end ? { times: [...times, end], values: [...values, values.at(-1)], kind } : { times, values, kind };

function show() {
  if (!found) {
    return;
  }
  const { answer, axis } = found;
  const { shaping } = answer;
  const curves = [record(answer.history, axis, "now")];
  if (shaping) {
    curves.unshift(record(shaping.history_without, axis, "past"));
  }
  const end = Math.max(...curves.map(({ times }) => times.at(-1)));
  const millimetres = `${short(1000 * answer.tolerance_m, 3)} mm`;
  $("stop").innerHTML = history({
    curves: curves.map((curve) => until(curve, end)),
    label: `displacement along ${"xyz"[axis]} after the stop [mm]`,
    factor: 1000,
    width: Math.max(280, $("stop").clientWidth),
  });
  const seconds = (value) => `${short(value, 3)} s`;
  const never = "never, because nothing damps its motion";
  const after = (value) => (value === undefined ? never : `${seconds(value)} after the end of the stop`);
  const own = `within ${millimetres} of its rest for good ${after(answer.settled_s)}`;
  const past = shaping?.settled_without_s;
  const words = shaping
    ? `With the shaper (full line) the platform is ${own}; without it (broken line) ` +
      `${past === undefined ? never : `after ${seconds(past)}`}. ` +
      `The shaped stop takes ${seconds(shaping.longer_s)} longer, and cancels ` +
      `${shaping.modes_hz.map((hz) => `${short(hz, 4)} Hz`).join(", ") || "nothing: nothing is left to cancel"}.`
    : `The platform is ${own}.`;
  const largest = answer.modes[0];
  const most = largest
    ? ` The largest part, ${short(1000 * largest.amplitude_m, 3)} mm, has the mode at ` +
      `${short(largest.frequency_hz, 4)} Hz with ${short(100 * largest.damping_ratio, 2)} % damping.`
    : "";
  $("stop").append(element("p", { class: "soft" }, `${words}${most}`));
}

function forget() {
  job.cancel();
  found = null;
  $("stop").replaceChildren();
}

/** Listens to the form, and forgets the motion when the state changes. */
export function listen() {
  on("robot", (isNew) => {
    if (isNew) {
      const { name, normal } = page.about.motion;
      const out = name === "planar" ? normal.findIndex((value) => Math.abs(value) > 0.99) : -1;
      const axes = ["x", "y", "z"].filter((_, k) => k !== out);
      $("stop-axis").replaceChildren(...axes.map((axis) => element("option", { value: axis }, `along ${axis}`)));
      $("stop-speed").value = plain(0.2);
      $("stop-time").value = plain(0.3);
    }
  });
  ["outdated", "empty"].forEach((event) => on(event, forget));
  $("stop-form").addEventListener("submit", (event) => {
    event.preventDefault();
    stop();
  });
  new ResizeObserver(show).observe($("stop"));
}
