// Which value moves this frequency most: derivatives of the chosen natural frequency by every number of the robot file,
// from the core's `gradient`, computed in a worker while the platform rests.

import { holdsLengths, statics } from "./computation.js";
import { Cancelled, Job } from "./engine.js";
import { bars } from "./figures.js";
import { $, element, short } from "./format.js";
import { age, busy } from "./messages.js";
import { chooseMode } from "./modes.js";
import { pin } from "./sliders.js";
import { content, on, page, shown } from "./store.js";
import { wordsOf } from "./units.js";

const BARS = 10;
const MARGIN = 1e-6; // relative: the limit of the list is above the chosen frequency by this
const job = new Job();
let followed = ""; // state of the page that the choice of what is held has followed
let found = null; // last table, with the mode that it is about

/** Words for the steps. */
const STEPS = { percent: "if a value rises by 1 % of its size", tolerance: "if a value rises by its usual tolerance" };

async function compute() {
  job.cancel();
  const { frame } = page;
  const mode = frame?.modes[shown.mode];
  const place = $("influence");
  age("influence", false);
  if (!mode) {
    found = null;
    show();
    return;
  }
  followHold();
  place.setAttribute("aria-busy", "true");
  if (!found) {
    place.replaceChildren(element("p", { class: "soft" }, "Computing …"));
  }
  const request = {
    command: "gradient",
    ...statics(),
    ...content.model,
    of: ["frequencies"],
    below_hz: mode.hz * (1 + MARGIN),
    hold: $("influence-hold").value,
    per: $("influence-per").value,
  };
  const done = busy("Computing the influence of all values", () => {
    job.cancel();
    found = { reason: "Cancelled." };
    show();
  });
  try {
    const text = await job.run(1, async ([worker]) => (await worker.call("answer", { request })).text);
    found = { table: JSON.parse(text), mode, index: shown.mode };
  } catch (error) {
    if (error instanceof Cancelled) {
      return;
    }
    found = { reason: error.message };
  } finally {
    done();
  }
  place.removeAttribute("aria-busy");
  show();
}

/** Derivatives of the chosen frequency; a frequency that several modes share has none. */
function derivatives() {
  const { table, mode } = found;
  const distance = ({ value }) => Math.abs(value - mode.hz);
  const nearest = (list) => list.reduce((best, one) => (distance(one) < distance(best) ? one : best), list[0]);
  const own = nearest(table.results);
  const refused = table.refused?.map(({ name, reason }) => `${name}: ${reason}`);
  if (!own || Math.abs(own.value / mode.hz - 1) > 1e-3) {
    return { reason: refused?.join(" ") || "there is no derivative of this frequency" };
  }
  if (own.block_entry) {
    return {
      reason:
        "Several modes share this frequency: along each change it splits into several, so it has no single " +
        "derivative. Choose another mode, or move the platform a little.",
    };
  }
  return { result: own };
}

function show() {
  const place = $("influence");
  place.dataset.mode = found?.index ?? "";
  if (!found) {
    const { frame } = page;
    const none = frame?.first?.reason ? ` There is no first one of the platform: ${frame.first.reason}` : "";
    const text = frame ? `Choose a natural frequency in the table above.${none}` : "–";
    place.replaceChildren(element("p", { class: "soft" }, text));
    return;
  }
  const { result, reason } = found.reason ? found : derivatives();
  if (reason) {
    place.replaceChildren(element("p", { class: "soft" }, reason));
    return;
  }

  // The largest effects first; a value of zero has no per cent.
  const { table } = found;
  const effects = table.parameters.map(({ path, unit, tolerance }, i) => ({
    path,
    unit,
    tolerance,
    effect: (100 * result.derivatives[i]) / result.value,
  }));
  const largest = effects
    .filter(({ effect }) => effect !== 0 && Number.isFinite(effect))
    .sort((a, b) => Math.abs(b.effect) - Math.abs(a.effect))
    .slice(0, BARS);
  if (largest.length === 0) {
    place.replaceChildren(element("p", { class: "soft" }, "No value moves this frequency."));
    return;
  }
  const step = ({ unit, tolerance }) => {
    const ofUnit = unit === "1" ? "" : ` ${unit}`;
    return table.per === "tolerance" ? ` (${short(tolerance, 2)}${ofUnit})` : "";
  };
  const label = `Change of ${short(result.value, 5)} Hz ${STEPS[table.per]}`;
  const past = pastOf(table);
  const rows = largest.map((one) => ({
    name: `${nameOf(one.path)}${step(one)}`,
    path: one.path,
    value: one.effect,
    past: past?.get(one.path),
  }));
  place.innerHTML = bars({ rows, label, unit: "%" });
  const held = `${table.held_means[0].toUpperCase()}${table.held_means.slice(1)}`;
  place.append(element("p", { class: "soft" }, `${held}. A click on a bar adds a slider for the value.`));
}

/** Words for a value of the robot file. */
function nameOf(path) {
  const parameter = page.parameters.find((one) => one.path === path);
  return parameter ? wordsOf(parameter) : path;
}

/** Effects of the remembered state on its mode of this number, by paths; none if it was of another kind. */
function pastOf(table) {
  const before = page.before?.influence;
  const isSame =
    before?.table && before.index === found.index && before.table.per === table.per && before.table.held === table.held;
  if (!isSame) {
    return null;
  }
  const { parameters } = before.table;
  const own = before.effects;
  return new Map(parameters.map(({ path }, i) => [path, own[i]]));
}

/**
 * Chooses what is held as the page holds it: the sliders act like the bars then. The rule `stiffest` has no
 * derivatives.
 */
function followHold() {
  const now = `${content.hold} ${page.frame.about.tension_rule}`;
  if (followed === now) {
    return;
  }
  followed = now;
  const rule = page.frame.about.tension_rule;
  const byRule = rule && rule !== "stiffest";
  $("influence-hold").querySelector("[value=rule]").disabled = !byRule;
  $("influence-hold").value = holdsLengths() ? "lengths" : byRule ? "rule" : "pose";
}

/** The button for the first mode of the platform is disabled without one, and says why. */
function showFirst() {
  const { frame, reason } = page;
  const first = frame?.first;
  const button = $("influence-first");
  button.disabled = first?.index === undefined;
  const searching = first ? "" : "The first mode of the platform is searched when the platform rests.";
  button.title = !frame ? reason : (first?.reason ?? searching);
}

function drop() {
  job.cancel();
  found = null;
  age("influence", false);
  show();
  showFirst();
}

/** Listens to the choice of a mode and to the end of changes. */
export function listen() {
  on("rest", compute);
  on("mode", compute);
  on("remember", () => {
    if (page.before && found?.table) {
      const { result } = derivatives();
      const effects = result?.derivatives.map((value) => (100 * value) / result.value);
      page.before.influence = result && { ...found, effects };
    }
    show();
  });
  on("outdated", () => {
    job.cancel();
    age("influence", found !== null);
  });
  on("empty", drop);
  on("forget", () => {
    followed = "";
  });
  on("frame", showFirst);
  on("platform", () => {
    showFirst();
    if (!found) {
      compute();
    }
  });
  ["influence-hold", "influence-per"].forEach((id) => $(id).addEventListener("change", compute));
  $("influence-form").addEventListener("submit", (event) => event.preventDefault());
  const chosen = (event) => {
    const path = event.target.closest("[data-path]")?.dataset.path;
    if (path && (event.type === "click" || event.key === "Enter" || event.key === " ")) {
      event.preventDefault();
      $("tab-values").click();
      pin(path);
      document.querySelector(`[data-number="${CSS.escape(path)}"]`)?.scrollIntoView({ block: "nearest" });
    }
  };
  ["click", "keydown"].forEach((kind) => $("influence").addEventListener(kind, chosen));
  $("influence-first").addEventListener("click", () => {
    const index = page.frame?.first?.index;
    if (index !== undefined) {
      chooseMode(index);
    }
  });
  show();
}
