// Large motion: a payload is released, or winches that wind in are stopped. The core's `simulate`, computed in a worker
// and played in the view.

import { statics } from "./computation.js";
import { Cancelled, Job } from "./engine.js";
import { history, moveClock } from "./figures.js";
import { $, element, plain, short } from "./format.js";
import { accept, busy, numberOf, refuse } from "./messages.js";
import { emit, on, page, shown } from "./store.js";

const SAMPLES = 700; // rows of the result
const WIND_S = 1; // time of the command of lengths that is stopped
const STOP_S = 0.1; // time of the brakes, which begin in the middle of the command, where the winches are fastest
const job = new Job();
let last = null; // last answer, with the mass or length that it is about

/** Kinds of events: unit and first value of the field, words for a wrong value, and the scenario. */
const KINDS = {
  release: {
    unit: "kg",
    first: () => Number((0.1 * (page.about.check.platform.mass_kg || 10)).toPrecision(2)),
    what: "payload: give a positive mass in kilograms",
    scenario: (mass) => ({ release: [{ at_s: 0, mass_kg: mass }] }),
  },
  stop: {
    unit: "m",
    first: () => 0.05,
    what: "length: give a positive number in metres",
    scenario: (length) => ({
      lengths: [{ at_s: 0, duration_s: WIND_S, change_m: changes(-length) }],
      stop: [{ at_s: 0.5 * WIND_S, duration_s: STOP_S }],
    }),
  },
};

const changes = (length) => Object.fromEntries(page.about.check.cables.map(({ name }) => [name, length]));
const kind = () => KINDS[$("simulate-what").value];
const tell = (text) => $("simulate").replaceChildren(element("p", { class: "soft" }, text));

async function simulate() {
  const { what, scenario } = kind();
  const [value, seconds] = [$("simulate-value"), $("simulate-time")].map((field) => numberOf(field.value));
  for (const [field, number, words] of [
    [$("simulate-value"), value, what],
    [$("simulate-time"), seconds, "time: give a positive number of seconds"],
  ]) {
    if (number === null || !(number > 0)) {
      refuse(field, `“${field.value}” is not a ${words}`);
      return;
    }
    accept(field);
  }
  if (!page.frame) {
    tell(`There is nothing to simulate: ${page.reason}.`);
    return;
  }
  const request = {
    command: "simulate",
    ...statics(),
    scenario: scenario(value),
    duration_s: seconds,
    sample_time_s: seconds / SAMPLES,
  };
  const done = busy("Simulating the motion", () => job.cancel());
  const { frame } = page;
  try {
    const text = await job.run(1, async ([worker]) => (await worker.call("answer", { request })).text);
    if (frame === page.frame) {
      last = JSON.parse(text);
      play();
    }
  } catch (error) {
    if (!(error instanceof Cancelled)) {
      stop();
      tell(error.message);
    }
  } finally {
    done();
  }
}

/** Plays the motion in the view, and shows it as a curve. */
function play() {
  const { t_s: times, poses, curves_m: curves, enlargement } = last.picture;
  emit("simulate");
  shown.simulated = true;
  page.view.playback.setSimulation({ times, poses, curves, enlargement, clock: (t) => moveClock($("simulate"), t) });
  $("simulate-end").hidden = false;
  show();
}

/** Sentence on the error of the result. */
function errorOf({ errors, is_statistical: isStatistical }) {
  const position = errors?.find(({ column }) => column === "position_m");
  if (!position) {
    return "";
  }
  const tension = Math.max(...errors.map(({ relative }) => relative ?? 0));
  const slack = isStatistical ? " Cables go slack: what follows is one of many possible histories." : "";
  return (
    ` The error, by a run with a finer mesh, is at most ${short(1000 * position.largest, 2)} mm and ` +
    `${short(100 * tension, 2)} % of a tension.${slack}`
  );
}

function show() {
  if (!last || !shown.simulated) {
    return;
  }
  const gravity = page.about.check.gravity_m_s2;
  const size = Math.hypot(...gravity);
  const up = size > 0 ? gravity.map((value) => -value / size) : [0, 0, 1];
  const first = last.rows[0].position_m;
  const rise = ({ position_m: at }) => at.reduce((sum, value, k) => sum + (value - first[k]) * up[k], 0);
  $("simulate").innerHTML = history({
    curves: [{ times: last.rows.map((row) => row.t_s), values: last.rows.map(rise), kind: "now" }],
    label: "displacement of the platform upwards [mm]",
    factor: 1000,
    width: Math.max(280, $("simulate").clientWidth),
  });
  const { enlargement } = last.picture;
  const scale = enlargement > 1 ? `Displacements are shown ${plain(enlargement)} times as large` : "True to scale";
  const slack = last.slack.map(({ cable, first_s: at }) => ` Cable ${cable} is slack from ${short(at, 3)} s on.`);
  $("simulate").append(
    element("p", { class: "soft" }, `${scale}, in true time.${slack.join("")}${errorOf(last)}`),
    ...(last.warnings ?? []).map((text) => element("p", { class: "soft" }, `${text}.`)),
  );
}

/** Ends the motion in the view. */
function stop() {
  if (shown.simulated) {
    shown.simulated = false;
    page.view.playback.setSimulation(null);
    $("simulate-end").hidden = true;
  }
  $("simulate").replaceChildren();
}

/** Puts the first value of the chosen event into its field. */
function choose() {
  $("simulate-value").value = page.about ? plain(kind().first()) : "";
  $("simulate-unit").textContent = kind().unit;
}

/** Listens to the form, and ends the motion when the state changes or another motion is shown. */
export function listen() {
  on("robot", (isNew) => {
    if (isNew) {
      choose();
    }
  });
  ["outdated", "empty"].forEach((event) =>
    on(event, () => {
      job.cancel();
      stop();
      last = null;
    }),
  );
  on("mode", () => {
    if (shown.mode >= 0) {
      stop();
    }
  });
  on("release", stop); // the view has one motion
  $("simulate-what").addEventListener("change", choose);
  $("simulate-form").addEventListener("submit", (event) => {
    event.preventDefault();
    simulate();
  });
  $("simulate-end").addEventListener("click", stop);
  new ResizeObserver(show).observe($("simulate"));
}
