// Calibration of the robot on the page from a table of lengths: the core's `calibrate`, computed in a worker. A row
// that is clicked away is fitted again at once by the linear equations, and then by the whole search.

import { refit, refitSentence, refittedAnchors, refittedValues } from "../../../funicular-pages/templates/refit.js";
import { requestOf, WrongField } from "./calibration_request.js";
import { proposalsTable, rowsTable, valuesTable } from "./calibration_tables.js";
import { Cancelled, Job } from "./engine.js";
import { residuals } from "./figures.js";
import { $, element, short } from "./format.js";
import { freeAxes, rangeOf } from "./measures.js";
import { accept, age, busy, put, refuse, textOf } from "./messages.js";
import { setRobot, showLibrary } from "./robot.js";
import { content, on, page } from "./store.js";
import { calibrateCommand } from "./words.js";

const FIELDS = ["deviation", "held", "frame", "model", "propose"].map((name) => `calibrate-${name}`);
const MAX_BYTES = 5e6; // of a table, as of the files of a robot
const job = new Job();
let readings = null; // `name`, `columns`
let whole = null; // answer with all rows, from whose linear equations each refit follows
let request = null; // of that answer
let exact = null; // last answer of the search
let leftOut = new Set(); // numbers of the rows that are clicked away
let isOld = false; // the values of the robot have changed since

const soft = (text) => element("p", { class: "soft" }, text);
const say = (...parts) => $("calibrate").replaceChildren(...parts);

/** Reads a table; a fault is told beside the button in the program's own sentence. */
async function read(name, text) {
  forgetAnswers();
  readings = null;
  put($("calibrate-name"), "");
  try {
    const { columns } = await job.run(1, ([worker]) => worker.call("table", { name, text }));
    readings = { name, columns };
    const count = Math.max(0, ...Object.values(columns).map((values) => values.length));
    put($("calibrate-name"), `${name}: ${count} ${count === 1 ? "row" : "rows"}`);
    say();
  } catch (error) {
    if (!(error instanceof Cancelled)) {
      say(element("p", { role: "alert", class: "advice" }, textOf(error)));
    }
  }
}

/** Reads a table of readings and calibrates. */
async function openReadings(name, text) {
  $("calibration").open = true;
  $("calibrate-text").value = text;
  await read(name, text);
  if (readings) {
    await calibrate();
  }
}

async function openFile(file) {
  if (file.size > MAX_BYTES) {
    say(element("p", { role: "alert" }, `${file.name} has ${short(file.size / 1e6, 3)} MB: give at most 5 MB`));
    return;
  }
  await openReadings(file.name, await file.text());
}

/** Request of the fields; null if one is wrong, which is marked. */
function requested() {
  const { about, view } = page;
  const middle = view.center.toArray();
  const ranges = freeAxes(about.motion).map((k) => [k, rangeOf(view, middle, k)]);
  const unknowns = [...document.querySelectorAll("[data-unknown]:checked")].map((box) => box.dataset.unknown);
  const fields = Object.fromEntries(FIELDS.map((id) => [id, $(id).value]));
  FIELDS.forEach((id) => accept($(id)));
  try {
    return requestOf({ robot: content.robot, readings: readings.columns, unknowns, fields, ranges });
  } catch (error) {
    if (!(error instanceof WrongField)) {
      throw error;
    }
    refuse($(error.id), error.message);
    return null;
  }
}

/** Answer of a request without the rows that are clicked away. */
async function answerOf(of) {
  const rows = [...leftOut].sort((a, b) => a - b);
  const asked = rows.length ? { ...of, leave_out: rows } : of;
  const done = busy("Fitting the readings", () => job.cancel());
  try {
    return JSON.parse(await job.run(1, async ([worker]) => (await worker.call("answer", { request: asked })).text));
  } finally {
    done();
  }
}

async function calibrate() {
  if (!page.about) {
    say(soft(`There is no robot to calibrate: ${page.reason}.`));
    return;
  }
  if (!readings) {
    say(soft("There are no readings: choose a file, or paste a table."));
    return;
  }
  const own = requested();
  if (!own) {
    return;
  }
  forgetAnswers();
  say(soft("Fitting the readings …"));
  try {
    whole = exact = await answerOf(own);
    request = own;
    show();
  } catch (error) {
    refused(error);
  }
}

function refused(error) {
  if (error instanceof Cancelled) {
    say(soft("Cancelled: the readings were not fitted."));
  } else {
    say(element("p", { role: "alert", class: "advice" }, textOf(error)));
  }
  page.view.calibration.set(null);
  page.view.draw();
}

/** Leaves a row out, or takes it in again: at once by the linear equations, then by the search. */
async function change(number, isLeftOut) {
  leftOut[isLeftOut ? "add" : "delete"](number);
  exact = leftOut.size === 0 ? whole : null;
  show();
  if (exact) {
    job.cancel();
    return;
  }
  const key = [...leftOut].join();
  try {
    const answer = await answerOf(request);
    if (key === [...leftOut].join()) {
      exact = answer;
      show();
    }
  } catch (error) {
    if (!(error instanceof Cancelled) && key === [...leftOut].join()) {
      $("calibrate-fit").replaceChildren(element("p", { role: "alert", class: "advice" }, textOf(error)));
    }
  }
}

const numbers = () => whole.refit.rows;

/** The linear refit without the rows that are clicked away; null where the others do not determine all values. */
function linear() {
  const isLeftOut = numbers().map((number) => leftOut.has(number));
  return whole.refit.linear && refit(whole.refit.linear, isLeftOut);
}

/** Sentences at the top: of the search, or of the linear refit until it has ended. */
function sentences(found) {
  if (exact) {
    return [exact.fit, exact.determined, `Frame: ${exact.frame}`].map((text) => element("p", {}, `${text}.`));
  }
  if (!whole.refit.linear) {
    return [soft("These rows do not determine all values: the search goes on without the row.")];
  }
  return [
    element("p", {}, refitSentence(found, leftOut.size)),
    soft("By the linear equations, which are exact for small changes; the whole search follows."),
  ];
}

/** Values of the search, or of the linear refit. */
function values(found) {
  if (exact) {
    const note = (row) =>
      row.held ? "held by the frame" : row.deviation === undefined || row.deviation === null ? "not determined" : "";
    return exact.values.map((row) => ({ ...row, note: note(row) }));
  }
  const moved = whole.refit.linear ? refittedValues(whole.refit, found) : [];
  return moved.map((of, k) => ({ ...of, start: whole.values[k].start, note: `moves by ${short(of.moved, 3)}` }));
}

/** What the view shows. */
function inView(found) {
  const of = exact ?? whole;
  const refitted = exact || !found ? null : refittedAnchors(whole.refit, found);
  const anchors = of.anchors.map((anchor, i) => ({
    start: anchor.start_m,
    position: refitted ? refitted[i].position : anchor.position_m,
    covariance: (refitted ? refitted[i].covariance : anchor.covariance_m2) ?? null,
    weakest: refitted ? null : (anchor.weakest_m ?? null),
  }));
  const place = (row) => (exact?.rows.find((own) => own.row === row.row) ?? row).position_m;
  const rows = whole.rows.map((row) => ({ position: place(row), isLeftOut: leftOut.has(row.row) }));
  const proposals = (exact?.proposals ?? []).map((row) => row.position_m);
  return { anchors, rows, proposals, scale: of.refit.magnification, size: page.view.size };
}

/** Sentences on the weakest combinations and on the walk along the first. */
function weak() {
  const { weak_combinations: combinations, walk } = exact;
  const sentence = ({ deviation_m: deviation, words }) =>
    deviation === undefined ? `undetermined: ${words}` : `±${short(1000 * deviation, 4)} mm: ${words}`;
  const list = element("ul", { class: "warnings" }, ...combinations.map((row) => element("li", {}, sentence(row))));
  const steps =
    walk && [walk.deviations, walk.chi2_rises].map((list) => list.map((value) => short(value, 3)).join(", "));
  const walked = steps
    ? [soft(`Held at ${steps[0]} deviations along the first, χ² rises by ${steps[1]}; a parabola rises by 1 and 4.`)]
    : [];
  return [element("h3", {}, "Weakest combinations"), list, ...walked];
}

/** What belongs to the answer of the search alone. */
function ofSearch() {
  const warnings = (exact.warnings ?? []).map((text) => element("li", {}, `${text}.`));
  const proposed = exact.proposals ?? [];
  const take = () => setRobot(content.robot.name, exact.robot_file).then(showLibrary);
  const command = calibrateCommand({
    file: content.robot.name || "robot.toml",
    readings: readings.name,
    request: { ...request, leave_out: [...leftOut] },
  });
  return [
    ...weak(),
    ...(warnings.length ? [element("ul", { class: "warnings" }, ...warnings)] : []),
    ...(proposed.length ? [element("h3", {}, "What to measure next"), proposalsTable(proposed)] : []),
    element(
      "p",
      { class: "row" },
      element("button", { id: "calibrate-take", onclick: take }, "Take the calibrated robot"),
    ),
    element("pre", { tabindex: "0", "aria-label": "Command" }, command),
  ];
}

function show() {
  if (!whole) {
    return;
  }
  const found = exact ? null : linear();
  const scale = (exact ?? whole).refit.magnification;
  const cables = whole.anchors.map(({ cable }) => cable);
  const rows = (exact ?? whole).rows.filter(({ row }) => !leftOut.has(row));
  const width = Math.max(280, $("calibrate").clientWidth);
  const figure = element("div", { id: "calibrate-residuals" });
  figure.innerHTML = residuals({ rows, cables, width });
  const focused = document.activeElement?.dataset?.row;
  const scrolled = $("calibrate-rows")?.parentElement.scrollTop;
  const size = scale === 1 ? "true to scale" : `${short(scale, 2)} times as large as the room`;
  say(
    element("div", { id: "calibrate-fit" }, ...sentences(found)),
    soft(
      "In the view: anchors of the file grey, calibrated ones blue with ellipsoids of two deviations " +
        `(inner conditions, ${size}), the weakest combination orange, rows green, poses to measure next violet.`,
    ),
    element("h3", {}, "Rows, with the residuals computed less measured"),
    rowsTable({ numbers: numbers(), rows, cables, isLeftOut: (number) => leftOut.has(number), change }),
    figure,
    valuesTable(values(found)),
    ...(exact ? ofSearch() : []),
  );
  document.querySelector(`[data-row="${focused}"]`)?.focus();
  $("calibrate-rows").parentElement.scrollTop = scrolled ?? 0;
  $("calibrate").dataset.shown = exact ? "search" : "linear";
  age("calibrate", isOld);
  page.view.calibration.set(inView(found));
  page.view.draw();
}

function forgetAnswers() {
  job.cancel();
  [whole, exact, request, isOld] = [null, null, null, false];
  leftOut = new Set();
  delete $("calibrate").dataset.shown;
  age("calibrate", false);
  say();
  page.view.calibration.set(null);
  page.view.draw();
}

/** Boxes of the unknowns of another robot. */
function offer() {
  const box = (name) => {
    const input = element("input", { type: "checkbox", "data-unknown": name });
    input.checked = name === "anchors";
    return element("label", { class: "small" }, input, ` ${name}`);
  };
  const known = [...document.querySelectorAll("[data-unknown]")].map(({ dataset }) => dataset.unknown);
  const names = page.about.calibration_unknowns;
  if (known.join() !== names.join()) {
    $("calibrate-unknowns").replaceChildren(element("legend", { class: "small" }, "Unknown"), ...names.map(box));
  }
}

/** Listens to the form, and to the robot, of which a calibration is. */
export function listen() {
  on("robot", (isNew) => {
    offer();
    if (!isNew && whole) {
      isOld = true;
      age("calibrate", true);
    }
  });
  on("forget", forgetAnswers);
  on("readings", openReadings);
  $("calibrate-open").addEventListener("click", () => $("calibrate-file").click());
  $("calibrate-file").addEventListener("change", async () => {
    const [file] = $("calibrate-file").files;
    if (file) {
      await openFile(file);
    }
    $("calibrate-file").value = "";
  });
  $("calibrate-text").addEventListener("change", () => {
    if ($("calibrate-text").value.trim()) {
      read("pasted table", $("calibrate-text").value);
    }
  });
  $("calibrate-form").addEventListener("submit", (event) => {
    event.preventDefault();
    calibrate();
  });
  new ResizeObserver(() => {
    if (whole && $("calibrate-residuals").firstElementChild) {
      const rows = (exact ?? whole).rows.filter(({ row }) => !leftOut.has(row));
      const cables = whole.anchors.map(({ cable }) => cable);
      $("calibrate-residuals").innerHTML = residuals({
        rows,
        cables,
        width: Math.max(280, $("calibrate").clientWidth),
      });
    }
  }).observe($("calibrate"));
}
