// Values of the robot file as sliders with number fields.

import { change } from "./computation.js";
import { $, element, plain } from "./format.js";
import { commit } from "./history.js";
import { accept, numberOf, refuse } from "./messages.js";
import { makeSearch } from "./search.js";
import { content, on, page } from "./store.js";
import { labelOf, shownValue, unitOf, valueOf as inSi, wordsOf } from "./units.js";

/** Reads the numbers of the robot file. */
export async function readParameters() {
  page.pending += 1;
  try {
    const robot = { ...content.robot, set: [] };
    const { text } = await page.engine.call("answer", { request: { command: "parameters", robot } });
    page.parameters = JSON.parse(text).parameters;
  } catch {
    page.parameters = []; // the reader of the robot tells the error
  } finally {
    page.pending -= 1;
  }
  showSliders();
}

/** Values that most people change first. */
export function pinFirst() {
  const first = (pattern) => page.parameters.find(({ path }) => pattern.test(path))?.path;
  content.pinned = [
    first(/^platform\.mass_kg$/),
    first(/^materials\..*\.(diameter_m|area_m2)$/),
    first(/^materials\..*\.(youngs_modulus_pa|axial_stiffness_n)$/),
  ].filter(Boolean);
  showSliders();
}

const known = (path) => page.parameters.find((one) => one.path === path);
const valueOf = (path) => content.robot.set.find((one) => one.path === path)?.value ?? known(path)?.value;

function setValue(path, value) {
  const others = content.robot.set.filter((one) => one.path !== path);
  content.robot = { ...content.robot, set: value === known(path)?.value ? others : [...others, { path, value }] };
}

/** Range of a slider around a value. */
function rangeOf({ value, minimum, maximum, unit, path }) {
  const { size: robot } = page.view;
  const finite = (bound) => bound !== null && Number.isFinite(bound) && Math.abs(bound) < 1e300;
  let [low, high] =
    value > 0 && finite(minimum) && minimum >= 0
      ? [0.2 * value, 3 * value]
      : [value - Math.abs(value), value + Math.abs(value)];
  if (unit === "m" && !(finite(minimum) && minimum >= 0)) {
    [low, high] = [value - 0.15 * robot, value + 0.15 * robot];
  } else if (value === 0) {
    const size = { "m/s": 20, N: 500, "N m": 100 }[unit] ?? (/damping_ratio/.test(path) ? 0.1 : 1);
    [low, high] = [finite(minimum) && minimum >= 0 ? 0 : -size, size];
  }
  return [
    finite(minimum) ? Math.max(low, minimum) : low,
    finite(maximum) ? Math.min(high, maximum * (1 - 1e-9)) : high,
  ];
}

export function showSliders() {
  const none = page.parameters.length === 0 && content.pinned.length > 0;
  const note = () => element("p", { class: "soft" }, "The values come back when the robot file can be read.");
  $("sliders").replaceChildren(...(none ? [note()] : content.pinned.map(sliderOf)));
}

function sliderOf(path) {
  const parameter = known(path);
  if (!parameter) {
    const remove = element("button", { onclick: () => unpin(path) }, "remove");
    return element("div", { class: "slider" }, `${path} is not in this robot file `, remove);
  }
  const id = `value-${path}`;
  const [low, high] = rangeOf(parameter);
  const value = valueOf(path);
  const unit = unitOf(parameter);
  const [label, words] = [labelOf(parameter), wordsOf(parameter)];
  const range = element("input", {
    type: "range",
    min: low,
    max: high,
    step: (high - low) / 400,
    value,
    "aria-label": label,
    "data-path": path,
  });
  const number = element("input", {
    id,
    value: plain(shownValue(value, unit)),
    inputmode: "decimal",
    "data-number": path,
  });
  const set = (next, done) => {
    setValue(path, next);
    change({ robot: true });
    if (done) {
      commit();
    }
  };
  range.addEventListener("input", () => {
    const next = Number(Number(range.value).toPrecision(5));
    number.value = plain(shownValue(next, unit));
    accept(number);
    set(next, false);
  });
  range.addEventListener("change", commit);
  number.addEventListener("change", () => {
    const typed = numberOf(number.value);
    if (typed === null) {
      refuse(number, `${words}: “${number.value}” is not a number`);
      return;
    }
    const next = inSi(typed, unit);
    accept(number);
    range.value = next;
    set(next, true);
  });
  const back = () => {
    setValue(path, parameter.value);
    showSliders();
    change({ robot: true });
    commit();
  };
  return element(
    "div",
    { class: "slider" },
    element(
      "div",
      { class: "head" },
      element("label", { for: id, title: `${path}: ${parameter.meaning}` }, label),
      number,
      element(
        "button",
        {
          title: "Back to the value of the file",
          "aria-label": `${words} back to the value of the file`,
          onclick: back,
        },
        "↺",
      ),
      element(
        "button",
        {
          title: "Remove this slider",
          "aria-label": `Remove the slider ${words}`,
          onclick: () => unpin(path),
        },
        "×",
      ),
    ),
    range,
  );
}

function unpin(path) {
  content.pinned = content.pinned.filter((other) => other !== path);
  showSliders();
  commit();
}

/** Adds a slider for a value. */
export function pin(path) {
  if (!content.pinned.includes(path)) {
    content.pinned = [...content.pinned, path];
    showSliders();
    commit();
  }
}

/** Listens to the fields that add and reset values. */
export function listen() {
  on("forget", () => {
    $("sliders").replaceChildren();
    $("paths").replaceChildren();
    $("path").value = "";
  });
  on("restored", (isOther) => (isOther ? readParameters() : showSliders()));
  makeSearch(pin);
  $("reset").addEventListener("click", () => {
    content.robot = { ...content.robot, set: [] };
    showSliders();
    change({ robot: true });
    commit();
  });
}
