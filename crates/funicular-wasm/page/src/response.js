// Frequency response: choice of signals and range, and the figure.

import { change } from "./computation.js";
import { response as figure } from "./figures.js";
import { $, element } from "./format.js";
import { accept, age, numberOf, put, refuse } from "./messages.js";
import { on, page, shown } from "./store.js";

/** Signals of a robot, and a range that shows its first resonances. */
function signals() {
  const { name, normal } = page.about.motion;
  const out = name === "planar" ? normal.findIndex((value) => Math.abs(value) > 0.99) : -1;
  const axes = ["x", "y", "z"];
  const forces = axes.map((axis, k) => (k === out ? null : [`f${axis}`, `force along ${axis}`]));
  const moments = axes.map((axis, k) => (name === "rigid" || k === out ? [`m${axis}`, `moment about ${axis}`] : null));
  const kinds = [
    ["", "displacement"],
    ["v", "velocity"],
    ["a", "acceleration"],
  ];
  const motions = kinds.flatMap(([kind, word]) =>
    axes.map((axis, k) => (k === out ? null : [`${kind}${axis}`, `${word} along ${axis}`])),
  );
  const options = (list) => list.filter(Boolean).map(([value, text]) => element("option", { value }, text));
  $("input").replaceChildren(...options([...forces, ...moments]));
  $("output").replaceChildren(...options(motions));
  const [input, output] = out === 2 ? ["fx", "ax"] : ["fz", "az"];
  shown.response ??= { input, output, from: null, to: null, log: false };
  showSignals();
}

function showSignals() {
  const { input, output, from, to, log } = shown.response;
  $("input").value = input;
  $("output").value = output;
  $("from").value = from ?? "";
  $("to").value = to ?? "";
  $("log").checked = log;
}

/** Range of the first response: up to somewhat above the listed modes. */
function chooseRange() {
  const { response } = shown;
  const highest = page.frame?.modes.at(-1)?.hz;
  if (response && response.to === null && highest) {
    const top = 1.15 * highest;
    const unit = 10 ** Math.floor(Math.log10(top));
    response.to = Number(((Math.ceil((2 * top) / unit) * unit) / 2).toPrecision(3));
    response.from = Number((response.to / 200).toPrecision(2));
    showSignals();
  }
}

function setRange(key, field) {
  const value = numberOf(field.value);
  const next = { ...shown.response, [key]: value };
  if (value === null || value < 0 || !(next.from < next.to) || (next.log && !(next.from > 0))) {
    refuse(
      field,
      "the range of the response needs two frequencies, the first below the second, " +
        "and above zero if it is logarithmic",
    );
    return;
  }
  [$("from"), $("to")].forEach(accept);
  shown.response = next;
  change({ response: true });
}

let width = 0; // of the figure, asked when it changes: asking in each frame makes the page lay out everything twice

function showResponse() {
  const { answered, before, frame } = page;
  if (!answered) {
    return;
  }
  age("bode", false);
  const { numbers, peaks } = answered.exact ?? answered;
  const curves = [{ numbers, kind: "now" }];
  if (before?.response?.signals === answered.signals && before.response.range === answered.range) {
    curves.unshift({ numbers: (before.response.exact ?? before.response).numbers, kind: "past" });
  }
  const { input, output, log } = shown.response;
  const label = (id, value) => [...$(id).options].find((option) => option.value === value)?.textContent ?? value;
  $("bode").innerHTML = figure({
    curves,
    peaks,
    modes: frame.modes.map((mode) => mode.hz),
    unit: answered.unit,
    log,
    title: `${label("output", output)} per ${label("input", input)}`,
    width: Math.max(280, width || $("bode").clientWidth),
  });
  put($("caveat"), answered.caveat ?? "");
}

/** Shows a text instead of the curve. */
function showNone(text) {
  age("bode", false);
  put($("caveat"), "");
  $("bode").replaceChildren(element("p", { class: "soft" }, text));
}

/** Listens to the choice of signals and range. */
export function listen() {
  on("robot", (isNew) => {
    if (isNew) {
      signals();
    }
  });
  on("frame", chooseRange);
  on("empty", () => showNone("–"));
  on("response", showResponse);
  on("remember", showResponse);
  on("response-refused", (error) => showNone(error.message));
  ["input", "output"].forEach((id) =>
    $(id).addEventListener("change", () => {
      shown.response = { ...shown.response, [id]: $(id).value };
      change({ response: true });
    }),
  );
  ["from", "to"].forEach((id) => $(id).addEventListener("change", () => setRange(id, $(id))));
  $("log").addEventListener("change", () => {
    if (!shown.response?.to) {
      return; // without a range, which the first response chooses
    }
    const from = shown.response.from || Number((shown.response.to / 200).toPrecision(2));
    shown.response = { ...shown.response, log: $("log").checked, from };
    showSignals();
    change({ response: true });
  });
  $("response").addEventListener("submit", (event) => event.preventDefault());
  new ResizeObserver(() => {
    const now = $("bode").clientWidth;
    if (now !== width) {
      width = now;
      showResponse();
    }
  }).observe($("bode"));
}
