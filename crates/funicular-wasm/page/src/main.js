// The page: one state, from which everything that is shown follows.

import { Cancelled, CORES, Engine, Job, prepare } from "./engine.js";
import { Editor } from "./editor.js";
import { response as responseFigure } from "./figures.js";
import { anglesOf, frameOf, quaternionOf } from "./frame.js";
import { $, element, plain, save, short } from "./format.js";
import { packed, unpacked } from "./share.js";
import { colorOf, COLORS, View } from "./view.js";
import { commands, python } from "./words.js";
import { Workspace } from "./workspace.js";

const POINTS = 33; // per cable: a sagging cable looks smooth
const RESPONSE_POINTS = 1000;
const SLOW_MS = 30; // a response that takes longer waits until the platform rests
const REST_MS = 250; // without a change: the long computations begin
const MAX_HISTORY = 200;
const FIRST_ROBOT = "cogiro";

/** State of the page. The part that undo restores is `content`. */
const content = {
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
const shown = { mode: -1, modes: 20, response: null, exaggeration: 1 };

let engine, details, comparing, view, editor, workspace;
let about = null; // description of the robot by the reader
let parameters = []; // numbers of the robot file without the changes of sliders
let frame = null; // last frame
let before = null; // remembered frame, with its response
let answered = null; // last response
let settled = { statics: null, payload: null };
const dirty = { robot: false, frame: false, mode: false, response: false };
const times = []; // milliseconds from a request of a frame to its display

// ---------------------------------------------------------------------------------------------------- history

const history = { past: [], future: [], present: "" };

/** Stores the present content as a step that undo goes back to. */
function commit() {
  const now = JSON.stringify(content);
  if (now === history.present) {
    return;
  }
  if (history.present !== "") {
    history.past.push(history.present);
    history.past.splice(0, history.past.length - MAX_HISTORY);
  }
  history.present = now;
  history.future = [];
  showHistory();
}

function step(from, to) {
  if (from.length === 0) {
    return;
  }
  const old = content.robot;
  to.push(history.present);
  history.present = from.pop();
  Object.assign(content, JSON.parse(history.present));
  showHistory();
  if (old.text !== content.robot.text) {
    readParameters();
  } else {
    showSliders();
  }
  change({ robot: true });
}

function showHistory() {
  $("undo").disabled = history.past.length === 0;
  $("redo").disabled = history.future.length === 0;
}

// ---------------------------------------------------------------------------------------------------- computation

/** Notes what has changed and computes it. */
function change(what) {
  Object.assign(dirty, what);
  if (what.robot || what.frame) {
    details.cancel();
    workspace?.outdated();
    dirty.frame = true;
  }
  compute();
}

let computing = false;

/** Computes until nothing has changed; of several changes of one kind the last one counts. */
async function compute() {
  if (computing) {
    return;
  }
  computing = true;
  try {
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
      if (dirty.frame && answered && answered.milliseconds < SLOW_MS && dirty.response) {
        // While the platform is dragged, the response follows every frame.
        dirty.response = false;
        await computeResponse();
      }
    }
  } finally {
    computing = false;
  }
  rest();
}

const requestOf = () => ({
  robot: content.robot,
  ...content.more,
  ...content.model,
  ...(content.rule && content.hold !== "lengths" && mayChoose() ? { tension_rule: content.rule } : {}),
});

/** True if the tensions at a pose leave a choice. */
const mayChoose = () =>
  (content.hold === "pose" || (content.hold === "file" && about?.check.state === "pose")) &&
  (about ? about.check.cables.length > about.degrees_of_freedom : true);

async function readRobot() {
  try {
    const found = await engine.call("robot", { request: requestOf() });
    const isNew = about === null || shown.newRobot;
    about = found.about;
    tell(null);
    showRobot(isNew);
    shown.newRobot = false;
    if (about.check.state === "none" && content.hold === "file") {
      // A robot file without a state: the middle between the anchors is a place to start from.
      const pose = [...view.center.toArray().map((value) => Number(value.toPrecision(3))), 0, 0, 0];
      Object.assign(content, { hold: "pose", pose: allowed(pose) });
      commit();
    }
    if (shown.camera) {
      view.camera6 = shown.camera;
      shown.camera = null;
    }
  } catch (error) {
    dirty.frame = false;
    showRefusal(error);
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

async function computeFrame() {
  const begin = performance.now();
  try {
    const found = await engine.call("frame", { ...stateOf(), modes: shown.modes, points: POINTS });
    frame = { ...frameOf(found.numbers), about: found.about };
    tell(null);
    shown.broken = false;
    showFrame();
    times.push(performance.now() - begin);
    times.splice(0, times.length - 1000);
    chooseRange();
    dirty.response = true;
    dirty.mode = shown.mode >= 0;
  } catch (error) {
    frameRefused(error);
  }
}

async function computeMode() {
  if (shown.mode < 0 || !frame || shown.mode >= frame.modes.length) {
    return;
  }
  const { shape, hz } = frame.modes[shown.mode];
  try {
    const { numbers } = await engine.call("mode", { index: shown.mode, points: POINTS });
    if (shown.mode >= 0) {
      view.setMode({ cables: numbers, shape, hz });
    }
  } catch (error) {
    if (!(error instanceof Cancelled)) {
      // A cable model that describes ends only: the platform moves, and straight lines follow it.
      tell(error.message, true);
    }
  }
}

async function computeResponse() {
  const { input, output, from, to, log } = shown.response ?? {};
  if (!frame || !input || shown.broken) {
    return;
  }
  const request = { input, output, from_hz: from, to_hz: to, points: RESPONSE_POINTS, log };
  try {
    const found = await engine.call("response", { request });
    const { frequencies, peaks } = found.about;
    const [curve, rest] = [found.numbers.subarray(0, 3 * frequencies), found.numbers.subarray(3 * frequencies)];
    answered = {
      numbers: curve,
      peaks: Array.from({ length: peaks }, (_, i) => ({ hz: rest[3 * i], magnitude: rest[3 * i + 2] })),
      unit: found.about.unit,
      milliseconds: found.milliseconds,
      signals: `${output}/${input}`,
      range: `${from} ${to} ${log}`,
    };
    showResponse();
  } catch (error) {
    answered = null;
    put($("caveat"), "");
    $("bode").replaceChildren(element("p", { class: "soft" }, error.message));
  }
}

let waitingForRest = 0;

/** Starts the long computations when nothing has changed for a while. */
function rest() {
  clearTimeout(waitingForRest);
  waitingForRest = setTimeout(async () => {
    if (!frame || shown.broken || view.dragging) {
      return;
    }
    showWords();
    const state = statics();
    const run = (command, more = {}) => (found) => found.call("answer", { request: { command, ...state, ...more } });
    const ofFrame = frame;
    try {
      await details.run(1, async ([worker]) => {
        settled = { statics: JSON.parse((await run("statics")(worker)).text), payload: null };
        showWarnings();
        try {
          settled.payload = JSON.parse((await run("payload")(worker)).text);
        } catch (error) {
          settled.payload = { reason: error.message };
          if (error instanceof Cancelled) {
            throw error;
          }
        }
        showKey();
        const { input, output, from, to, log } = shown.response;
        if (from !== null) {
          // While the platform rests, the curve has every peak with its height.
          const own = { input, output, from_hz: from, to_hz: to, log, adaptive: true, ...content.model };
          const { frequency_hz: hz, real, imag, peaks, warnings } = JSON.parse((await run("frf", own)(worker)).text);
          if (answered && frame === ofFrame) {
            const numbers = Float64Array.from({ length: 3 * hz.length }, (_, k) => [hz, real, imag][k % 3][Math.floor(k / 3)]);
            answered.exact = { numbers, peaks: peaks.map((peak) => ({ hz: peak.frequency_hz, magnitude: peak.magnitude })) };
            showResponse();
          }
          put($("caveat"), warnings.filter((text) => !settled.statics.warnings.includes(text)).join(" "));
        }
      });
    } catch (error) {
      if (!(error instanceof Cancelled)) {
        settled = { statics: null, payload: null, reason: error.message };
        showWarnings();
      }
    }
    $("state").dataset.settled = String(Number($("state").dataset.settled ?? 0) + 1);
  }, REST_MS);
}

/** Keys of a request for the present state, without the linearisation. */
function statics() {
  const own = Object.fromEntries(Object.entries(requestOf()).filter(([key]) => !(key in content.model)));
  if (content.hold === "pose") {
    return { ...own, pose: content.pose };
  }
  return content.hold === "lengths" ? { ...own, lengths_m: content.lengths } : own;
}

// ---------------------------------------------------------------------------------------------------- messages

/** Shows a message, or nothing. A note is not an error. */
function tell(text, note = false) {
  const place = $("message");
  place.hidden = text === null;
  place.classList.toggle("note", note);
  place.textContent = text ?? "";
}

function brokenText(error) {
  return error.broken ? `${error.message}\nThe page has started again with the last robot.` : error.message;
}

function showRefusal(error) {
  if (error instanceof Cancelled) {
    return;
  }
  const { issues } = error;
  tell(issues.length ? `The robot file has ${issues.length === 1 ? "an error" : `${issues.length} errors`}: line ${issues[0].line}: ${issues[0].message}` : brokenText(error));
  if (content.robot.set.length === 0) {
    editor.text = content.robot.text;
  }
  editor.issues = issues;
  $("issues").replaceChildren(...issues.map((issue) => element("li", {},
    element("button", { onclick: () => editor.show(issue.from_byte) }, `line ${issue.line}, column ${issue.column}`),
    `: ${issue.message}${issue.help ? ` (${issue.help})` : ""}`)));
}

function frameRefused(error) {
  if (error instanceof Cancelled) {
    return;
  }
  shown.broken = true;
  tell(error.status === 1 ? `No equilibrium here: ${error.message}` : brokenText(error));
  if (content.hold === "pose") {
    view.setBroken(content.pose.slice(0, 3), quaternionOf(content.pose.slice(3)));
    showPose(content.pose);
  }
  $("state").textContent = "No equilibrium: the results are those of the last state that had one.";
  document.body.classList.add("broken");
}

// ---------------------------------------------------------------------------------------------------- robot

function showRobot(isNew) {
  const { check } = about;
  $("name").textContent = about.name;
  $("source").textContent = check.source || "";
  document.title = `${about.name} – funicular`;
  editor.text = about.text;
  editor.issues = [];
  $("issues").replaceChildren();
  view.setRobot(about, frame && !isNew ? frame : null, !isNew);
  if (isNew) {
    before = null;
    view.remember(null);
    $("remember").setAttribute("aria-pressed", "false");
    signals();
  }
  const rigid = about.motion.name === "rigid";
  document.querySelector("[data-handle=rotate]").disabled = about.motion.name === "point-mass";
  document.querySelectorAll("#pose [data-pose]").forEach((field) => {
    const k = Number(field.dataset.pose);
    const { name, normal } = about.motion;
    const planar = name === "planar";
    const along = planar && Math.abs(normal[k % 3]) > 0.99;
    field.disabled = k < 3 ? along : !(rigid || (planar && along));
  });
  $("rule").disabled = !mayChoose();
}

/** Another robot: text, and what belongs to the old one goes. */
async function setRobot(name, text, more = {}) {
  const next = { robot: { name, text, set: [] }, hold: "file", pose: null, lengths: null, start: null, rule: "", pinned: [], more: {}, model: {}, ...more };
  Object.assign(content, next);
  Object.assign(shown, { mode: -1, newRobot: true, response: more.response ?? null });
  view.setMode(null);
  frame = null;
  workspace.forget();
  $("compare").replaceChildren();
  await readParameters();
  if (content.pinned.length === 0) {
    const first = (pattern) => parameters.find(({ path }) => pattern.test(path))?.path;
    content.pinned = [first(/^platform\.mass_kg$/), first(/^materials\..*\.(diameter_m|area_m2)$/), first(/^materials\..*\.(youngs_modulus_pa|axial_stiffness_n)$/)].filter(Boolean);
  }
  showSliders();
  change({ robot: true });
  commit();
}

// ---------------------------------------------------------------------------------------------------- values

async function readParameters() {
  try {
    const robot = { ...content.robot, set: [] };
    const { text } = await engine.call("answer", { request: { command: "parameters", robot } });
    parameters = JSON.parse(text).parameters;
  } catch {
    return; // the reader of the robot tells the error
  }
  $("paths").replaceChildren(...parameters.map(({ path, unit, meaning }) => element("option", { value: path }, `${unit === "1" ? "" : `${unit}: `}${meaning}`)));
  showSliders();
}

const valueOf = (path) => content.robot.set.find((change) => change.path === path)?.value ?? parameters.find((one) => one.path === path)?.value;

function setValue(path, value) {
  const original = parameters.find((one) => one.path === path)?.value;
  const others = content.robot.set.filter((change) => change.path !== path);
  content.robot = { ...content.robot, set: value === original ? others : [...others, { path, value }] };
}

/** Range of a slider around a value. */
function rangeOf({ value, minimum, maximum, unit, path }) {
  const finite = (bound) => bound !== null && Number.isFinite(bound) && Math.abs(bound) < 1e300;
  let [low, high] = value > 0 && finite(minimum) && minimum >= 0 ? [0.2 * value, 3 * value] : [value - Math.abs(value), value + Math.abs(value)];
  if (unit === "m" && !(finite(minimum) && minimum >= 0)) {
    [low, high] = [value - 0.15 * view.size, value + 0.15 * view.size];
  } else if (value === 0) {
    const size = { "m/s": 20, N: 500, "N m": 100 }[unit] ?? (/damping_ratio/.test(path) ? 0.1 : 1);
    [low, high] = [finite(minimum) && minimum >= 0 ? 0 : -size, size];
  }
  return [finite(minimum) ? Math.max(low, minimum) : low, finite(maximum) ? Math.min(high, maximum * (1 - 1e-9)) : high];
}

function showSliders() {
  $("sliders").replaceChildren(...content.pinned.map((path) => {
    const parameter = parameters.find((one) => one.path === path);
    if (!parameter) {
      return element("div", { class: "slider" }, `${path} is not in this robot file `, element("button", { onclick: () => unpin(path) }, "remove"));
    }
    const id = `value-${path}`;
    const [low, high] = rangeOf(parameter);
    const value = valueOf(path);
    const range = element("input", { type: "range", min: low, max: high, step: (high - low) / 400, value, "aria-label": path, "data-path": path });
    const number = element("input", { id, value: plain(value), inputmode: "decimal", "data-number": path });
    const set = (next, done) => {
      setValue(path, next);
      change({ robot: true });
      if (done) {
        commit();
      }
    };
    range.addEventListener("input", () => {
      const next = Number(Number(range.value).toPrecision(5));
      number.value = plain(next);
      number.removeAttribute("aria-invalid");
      set(next, false);
    });
    range.addEventListener("change", commit);
    number.addEventListener("change", () => {
      const next = numberOf(number.value);
      if (next === null) {
        number.setAttribute("aria-invalid", "true");
        tell(`${path}: “${number.value}” is not a number`);
        return;
      }
      number.removeAttribute("aria-invalid");
      range.value = next;
      set(next, true);
    });
    const words = path.split(".");
    return element("div", { class: "slider" },
      element("div", { class: "head" },
        element("label", { for: id, title: parameter.meaning }, words.join(" "), " ", element("small", {}, parameter.unit === "1" ? "" : `[${parameter.unit}]`)),
        number,
        element("button", { title: "Back to the value of the file", "aria-label": `${path} back to the value of the file`, onclick: () => { setValue(path, parameter.value); showSliders(); change({ robot: true }); commit(); } }, "↺"),
        element("button", { title: "Remove this slider", "aria-label": `Remove the slider ${path}`, onclick: () => unpin(path) }, "×")),
      range);
  }));
}

/** Number of a text with a point or a comma; null if it is none. */
function numberOf(text) {
  const number = Number(text.trim().replace(",", ".").replace("−", "-"));
  return text.trim() !== "" && Number.isFinite(number) ? number : null;
}

function unpin(path) {
  content.pinned = content.pinned.filter((other) => other !== path);
  showSliders();
  commit();
}

// ---------------------------------------------------------------------------------------------------- state

const rounding = () => 10 ** Math.floor(Math.log10(view.size * 2e-4));

/** Pose with few digits: those that a person can choose with the handle. */
function rounded(position, quaternion) {
  const step = rounding();
  const decimals = Math.max(0, Math.round(-Math.log10(step)));
  const { name } = about.motion;
  const angles = name === "point-mass" ? [0, 0, 0] : anglesOf(quaternion);
  return [...position.map((value) => Number((Math.round(value / step) * step).toFixed(decimals))), ...angles.map((value) => Number(value.toFixed(2)) + 0)];
}

/** Pose within the plane of a planar platform. */
function allowed(pose) {
  const { name, normal, offset_m: offset } = about.motion;
  if (name !== "planar") {
    return pose;
  }
  const position = pose.slice(0, 3);
  const off = position.reduce((sum, value, k) => sum + value * normal[k], 0) - offset;
  const axis = normal.findIndex((value) => Math.abs(value) > 0.99);
  const angles = pose.slice(3).map((value, k) => (axis < 0 || k === axis ? value : 0));
  return [...position.map((value, k) => value - off * normal[k]), ...angles];
}

/** Pose from which the next one is made: the requested one, or that of the equilibrium with few digits. */
const presentPose = () => (content.hold === "pose" ? [...content.pose] : rounded(frame.position, frame.quaternion));

function setPose(pose) {
  content.hold = "pose";
  content.pose = allowed(pose);
  content.lengths = null;
  content.start = null;
  showHold();
  // The tension rule is a key of the robot's request, and only poses have one.
  change(content.rule ? { robot: true } : { frame: true });
}

function showHold() {
  document.querySelectorAll("[data-hold]").forEach((button) => {
    const own = button.dataset.hold === content.hold || (content.hold === "file" && button.dataset.hold === (about?.check.state === "lengths" ? "lengths" : "pose"));
    button.setAttribute("aria-pressed", String(own));
  });
  $("rule").disabled = !mayChoose();
  view.canDrag = true;
}

function hold(kind) {
  if (!frame || shown.broken) {
    return;
  }
  if (kind === "lengths") {
    content.hold = "lengths";
    content.lengths = frame.cables.map((cable) => cable.length);
    content.start = [...frame.position, ...frame.quaternion];
    content.pose = null;
    showHold();
    change({ robot: true });
  } else {
    setPose(rounded(frame.position, frame.quaternion));
  }
  commit();
}

function showPose(pose) {
  document.querySelectorAll("#pose [data-pose]").forEach((field) => {
    if (document.activeElement !== field || !field.dirty) {
      const k = Number(field.dataset.pose);
      field.value = String(Number(pose[k].toFixed(k < 3 ? 5 : 3)) + 0);
      field.removeAttribute("aria-invalid");
    }
  });
}

// ---------------------------------------------------------------------------------------------------- results

function showFrame() {
  document.body.classList.remove("broken");
  showHold();
  view.setFrame(frame, view.dragging);
  const under = Number.isFinite(frame.distance) && frame.distance > 0;
  showPose(content.hold === "pose" && !under ? content.pose : [...frame.position, ...frame.angles]);
  view.canvas.setAttribute("aria-label", `Robot with ${frame.cables.length} cables; platform at x ${short(frame.position[0])}, y ${short(frame.position[1])}, z ${short(frame.position[2])} metres. Arrow keys move the platform, Page up and Page down lift it.`);
  const parts = [];
  if (content.hold === "lengths" || (content.hold === "file" && about.check.state === "lengths")) {
    parts.push("The pose follows from the cable lengths.");
  } else if (under) {
    parts.push(`The cables cannot hold the requested pose: this is the nearest one, ${short(frame.distance, 3)} m away.`);
  } else {
    parts.push("The cable lengths follow from the pose.");
  }
  if (frame.stable === false) {
    parts.push("This equilibrium is unstable.");
  }
  if (frame.about.no_modes) {
    parts.push(`No natural frequencies: ${frame.about.no_modes}`);
  }
  $("state").textContent = parts.join(" ");
  showTensions();
  showModes();
  showKey();
  showLegend();
}

function showLegend() {
  const limits = frame.limited && frame.cables.every((cable) => Number.isFinite(cable.maximum));
  const scale = [0, 0.2, 0.4, 0.6, 0.8, 1].map((at) => `#${colorOf(at).getHexString()}`).join(",");
  const key = String(limits);
  if ($("legend").dataset.key === key) {
    return;
  }
  $("legend").dataset.key = key;
  $("legend").innerHTML = `<span>Tension: ${limits ? "minimum" : "none"}<i style="background:linear-gradient(90deg,${scale})"></i>${limits ? "maximum" : "highest"}</span>`
    + `<span><i class="one" style="background:${COLORS.slack}"></i>slack</span><span><i class="one" style="background:${COLORS.beyond}"></i>beyond a limit</span>`;
}

function isBeyond(cable) {
  return frame.limited && (cable.highest > cable.maximum * (1 + 1e-6) || cable.lowest < cable.minimum * (1 - 1e-6));
}

/** Rows of a table, made once and then only filled, because a frame has no time to make them. */
function rowsOf(table, count, make) {
  const body = $(table).tBodies[0];
  while (body.rows.length > count) {
    body.lastChild.remove();
  }
  while (body.rows.length < count) {
    body.append(make(body.rows.length));
  }
  return body.rows;
}

const put = (cell, text) => {
  if (cell.textContent !== text) {
    cell.textContent = text;
  }
};

function showTensions() {
  const names = about.check.cables.map((cable) => cable.name);
  const rows = rowsOf("tensions", frame.cables.length, (i) => {
    const length = element("input", { "aria-label": `Unstrained length of cable ${i + 1} in metres`, inputmode: "decimal" });
    length.addEventListener("change", () => setLength(i, length));
    return element("tr", {}, element("td", { class: "left name" }), element("td"), element("td", { class: "left" },
      element("span", { class: "track", role: "img" }, element("i"), element("b", { class: "past" }))), element("td"), element("td"), element("td", { class: "lengths" }, length, element("span")));
  });
  const free = content.hold === "lengths";
  const top = Math.max(...frame.cables.map((cable) => (frame.limited && Number.isFinite(cable.maximum) ? cable.maximum : 1.1 * cable.highest)));
  frame.cables.forEach((cable, i) => {
    const { cells } = rows[i];
    put(cells[0], names[i]);
    put(cells[1], short(cable.tension, 5));
    const most = frame.limited && Number.isFinite(cable.maximum) ? cable.maximum : top;
    const track = cells[2].firstChild;
    const part = Math.max(0, Math.min(1, cable.highest / most));
    const own = view.lines[i]?.material.color.getHexString();
    track.firstChild.style.cssText = `width:${(100 * part).toFixed(1)}%;background:#${own}`;
    track.setAttribute("aria-label", `${short(cable.tension, 4)} of ${short(cable.minimum, 3)} to ${short(cable.maximum, 4)} newtons`);
    track.title = frame.limited ? `${short(cable.minimum, 3)} to ${Number.isFinite(cable.maximum) ? short(cable.maximum, 4) : "∞"} N` : "";
    const past = before && before.frame.cables[i] ? Math.min(1, before.frame.cables[i].highest / most) : null;
    track.lastChild.style.cssText = past === null ? "display:none" : `left:${(100 * past).toFixed(1)}%`;
    put(cells[3], short(100 * cable.sagRatio, 3));
    put(cells[4], short(cable.lambda2, 3));
    const [field, text] = cells[5].children;
    field.hidden = !free;
    put(text, free ? "" : short(cable.length, 5));
    if (free && document.activeElement !== field) {
      field.value = plain(cable.length, 7);
      field.removeAttribute("aria-invalid");
    }
    rows[i].classList.toggle("beyond", isBeyond(cable) || cable.slack === 1);
  });
}

function setLength(i, field) {
  const value = numberOf(field.value);
  if (value === null || value <= 0) {
    field.setAttribute("aria-invalid", "true");
    tell(`cable “${about.check.cables[i].name}”: “${field.value}” is not a length; give a positive number of metres`);
    return;
  }
  field.removeAttribute("aria-invalid");
  content.start = [...frame.position, ...frame.quaternion];
  content.lengths = content.lengths.map((length, k) => (k === i ? value : length));
  change({ frame: true });
  commit();
}

const KINDS = { platform: "platform", cable: "cables", drive: "drives", mixed: "platform and cables" };

function showModes() {
  const rows = rowsOf("modes", frame.modes.length, (i) => {
    const row = element("tr", { class: "pick" }, element("td", {}, element("button", { "aria-label": `Show mode ${i + 1}` }, String(i + 1))), element("td"), element("td"), element("td", { class: "left" }),
      element("td", { class: "left" }, element("span", { class: "share", title: "fraction of the kinetic energy in the platform" }, element("i"))), element("td", { class: "before", hidden: true }));
    row.addEventListener("click", () => chooseMode(shown.mode === i ? -1 : i));
    return row;
  });
  document.querySelectorAll("#modes .before").forEach((cell) => { cell.hidden = before === null; });
  frame.modes.forEach((mode, i) => {
    const { cells } = rows[i];
    put(cells[1], short(mode.hz, 5));
    put(cells[2], short(100 * mode.damping, 3));
    put(cells[3], KINDS[mode.kind]);
    cells[4].firstChild.firstChild.style.width = `${(100 * mode.platformShare).toFixed(0)}%`;
    const past = before?.frame.modes[i];
    put(cells[5], past ? `${mode.hz >= past.hz ? "+" : "−"}${short(Math.abs(100 * (mode.hz / past.hz - 1)), 3)}` : "");
    if (i === shown.mode) {
      rows[i].setAttribute("aria-current", "true");
    } else {
      rows[i].removeAttribute("aria-current");
    }
  });
}

function chooseMode(index) {
  shown.mode = index;
  $("play").hidden = index < 0;
  $("amplitude-label").hidden = index < 0;
  showModes();
  if (index < 0) {
    view.setMode(null);
  } else {
    change({ mode: true });
  }
}

function showKey() {
  const names = about.check.cables.map((cable) => cable.name);
  const highest = frame.cables.reduce((best, cable, i) => (cable.highest > frame.cables[best].highest ? i : best), 0);
  const lowest = frame.cables.reduce((best, cable, i) => (cable.lowest < frame.cables[best].lowest ? i : best), 0);
  const top = frame.cables[highest];
  const [first, platform] = [frame.modes[0], frame.modes.find((mode) => mode.platformShare >= 0.5)];
  const delta = (now, past) => (past ? ` (before ${short(past, 4)})` : "");
  const facts = [
    ["Highest tension", `${short(top.highest, 4)} N`, `cable ${names[highest]}${frame.limited && Number.isFinite(top.maximum) ? `, ${short((100 * top.highest) / top.maximum, 3)} % of its maximum` : ""}${delta(top.highest, before && Math.max(...before.frame.cables.map((cable) => cable.highest)))}`],
    ["Lowest tension", `${short(frame.cables[lowest].lowest, 4)} N`, `cable ${names[lowest]}${frame.limited ? `, minimum ${short(frame.cables[lowest].minimum, 3)} N` : ""}`],
    ["First resonance", first ? `${short(first.hz, 4)} Hz` : "–", first ? `of the ${KINDS[first.kind]}${delta(first.hz, before?.frame.modes[0]?.hz)}` : ""],
    ["First resonance of the platform", platform ? `${short(platform.hz, 4)} Hz` : "–", platform ? `mode ${frame.modes.indexOf(platform) + 1}` : frame.modes.length ? `above the ${frame.modes.length} lowest` : ""],
    payloadFact(),
    ["Stiffness in the softest direction", frame.stable === undefined ? "rigid" : `${short(frame.minStiffness, 4)} N/m`, frame.stable === false ? "unstable" : ""],
  ];
  const place = $("key");
  if (place.children.length !== facts.length) {
    place.replaceChildren(...facts.map(() => element("div", {}, element("dt"), element("dd", {}, element("span"), element("small")))));
  }
  facts.forEach(([name, value, more], i) => {
    const [term, fact] = place.children[i].children;
    put(term, name);
    put(fact.firstChild, value);
    put(fact.lastChild, more);
  });
}

function payloadFact() {
  const { payload } = settled;
  if (!payload || view.dragging) {
    return ["Maximum payload", "…", ""];
  }
  const { maximum } = payload;
  if (payload.reason || !maximum?.payload_kg) {
    return ["Maximum payload", "–", payload.reason ?? "the cables have no maximum tension"];
  }
  const limiting = maximum.cables.filter((cable) => cable.limit_reached === "maximum").map((cable) => cable.name);
  const slack = maximum.cables.filter((cable) => cable.limit_reached === "minimum").map((cable) => cable.name);
  const by = limiting.length ? `limited by cable ${limiting.join(", ")}` : slack.length ? `cable ${slack.join(", ")} reaches its minimum` : "";
  return ["Maximum payload", `${short(maximum.payload_kg, 4)} kg`, by];
}

function showWarnings() {
  const warnings = settled.statics?.warnings ?? [];
  const all = settled.reason ? [settled.reason] : warnings;
  $("warnings").replaceChildren(...(all.length ? all : ["No remarks on this state."]).map((text) => element("li", {}, text)));
  showKey();
}

// ---------------------------------------------------------------------------------------------------- response

/** Signals of a robot, and a range that shows its first resonances. */
function signals() {
  const { name, normal } = about.motion;
  const out = name === "planar" ? normal.findIndex((value) => Math.abs(value) > 0.99) : -1;
  const axes = ["x", "y", "z"];
  const forces = axes.map((axis, k) => (k === out ? null : [`f${axis}`, `force along ${axis}`]));
  const moments = axes.map((axis, k) => (name === "rigid" || k === out ? [`m${axis}`, `moment about ${axis}`] : null));
  const motions = ["", "v", "a"].flatMap((kind, j) => axes.map((axis, k) => (k === out ? null : [`${kind}${axis}`, `${["displacement", "velocity", "acceleration"][j]} along ${axis}`])));
  const options = (list) => list.filter(Boolean).map(([value, text]) => element("option", { value }, text));
  $("input").replaceChildren(...options([...forces, ...moments]));
  $("output").replaceChildren(...options(motions));
  shown.response ??= { input: out === 2 ? "fx" : "fz", output: out === 2 ? "ax" : "az", from: null, to: null, log: false };
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
  if (response && response.to === null && frame?.modes.length) {
    const top = 1.15 * frame.modes.at(-1).hz;
    const unit = 10 ** Math.floor(Math.log10(top));
    response.to = Number((Math.ceil((2 * top) / unit) * unit / 2).toPrecision(3));
    response.from = Number((response.to / 200).toPrecision(2));
    showSignals();
  }
}

function setRange(key, field) {
  const value = numberOf(field.value);
  const next = { ...shown.response, [key]: value };
  if (value === null || value < 0 || !(next.from < next.to) || (next.log && !(next.from > 0))) {
    field.setAttribute("aria-invalid", "true");
    tell("the range of the response needs two frequencies, the first below the second, and above zero if it is logarithmic");
    return;
  }
  [$("from"), $("to")].forEach((other) => other.removeAttribute("aria-invalid"));
  tell(null);
  shown.response = next;
  change({ response: true });
}

function showResponse() {
  if (!answered) {
    return;
  }
  const { numbers, peaks } = answered.exact ?? answered;
  const curves = [{ numbers, kind: "now" }];
  if (before?.response?.signals === answered.signals && before.response.range === answered.range) {
    curves.unshift({ numbers: (before.response.exact ?? before.response).numbers, kind: "past" });
  }
  const { input, output, log } = shown.response;
  const label = (id, value) => [...$(id).options].find((option) => option.value === value)?.textContent ?? value;
  $("bode").innerHTML = responseFigure({
    curves, peaks, modes: frame.modes.map((mode) => mode.hz), unit: answered.unit, log,
    title: `${label("output", output)} per ${label("input", input)}`, width: Math.max(280, $("bode").clientWidth),
  });
}

// ---------------------------------------------------------------------------------------------------- words, files, links

function wordsState() {
  const kind = content.hold;
  return { kind, pose: content.pose, lengths: content.lengths, set: content.robot.set, rule: mayChoose() ? content.rule : "" };
}

const fileName = () => `${(content.robot.name || about?.name || "robot").replace(/^.*[/\\]/, "").replace(/\.toml$/, "").replace(/[^\w.-]+/g, "-").toLowerCase()}.toml`;

function showWords() {
  const { response } = shown;
  const of = {
    file: fileName(), state: wordsState(), belowHz: Number((frame.belowHz || 20).toPrecision(3)),
    response: { ...(response ?? {}), points: RESPONSE_POINTS },
  };
  put($("commands"), commands(of));
  put($("python"), python(of));
}

async function saveAs(kind) {
  const name = fileName().replace(/\.toml$/, "");
  if (kind === "toml") {
    save(`${name}.toml`, about.text, "application/toml");
  } else if (kind === "png") {
    save(`${name}.png`, await view.png(), "image/png");
  } else if (kind === "svg") {
    save(`${name}.svg`, view.svg(), "image/svg+xml");
  } else if (kind === "response") {
    const style = getComputedStyle(document.documentElement);
    const rules = `text{fill:${style.getPropertyValue("--soft")}}.grid{stroke:${style.getPropertyValue("--line")}}.mode{stroke:#777}.now{fill:none;stroke:${style.getPropertyValue("--accent")};stroke-width:1.6}.past{fill:none;stroke:#777;stroke-dasharray:4 3}.peak{fill:${style.getPropertyValue("--accent")}}svg{font:11px sans-serif}`;
    save(`${name}-response.svg`, $("bode").innerHTML.replace(/>/, `><style>${rules}</style>`), "image/svg+xml");
  } else {
    const own = await results();
    if (kind === "json") {
      save(`${name}.json`, JSON.stringify(own, null, 2), "application/json");
    } else {
      save(`${name}.csv`, csv(own), "text/csv");
    }
  }
  document.querySelector(".menu").open = false;
}

/** Results of the program for the present state, in its JSON. */
async function results() {
  const state = statics();
  const ask = async (command, more = {}) => JSON.parse((await engine.call("answer", { request: { command, ...state, ...more } })).text);
  const own = { statics: await ask("statics"), modes: await ask("modes", { ...content.model, below_hz: frame.belowHz || 20 }) };
  const { input, output, from, to, log } = shown.response;
  if (from !== null) {
    own.frf = await ask("frf", { ...content.model, input, output, from_hz: from, to_hz: to, points: RESPONSE_POINTS, log });
  }
  return own;
}

function csv({ statics: rest, modes, frf }) {
  const cell = (value) => (value === undefined ? "" : /[",\n]/.test(String(value)) ? `"${String(value).replaceAll('"', '""')}"` : String(value));
  const table = (keys, rows) => [keys.join(","), ...rows.map((row) => keys.map((key) => cell(row[key])).join(","))].join("\n");
  const parts = [
    table(["name", "unstrained_length_m", "tension_platform_n", "tension_anchor_n", "sag_ratio", "lambda2", "minimum_tension_n", "maximum_tension_n"], rest.cables),
    table(["frequency_hz", "damping_ratio", "kind", "platform_energy_fraction"], modes.modes),
  ];
  if (frf) {
    parts.push(table(["frequency_hz", "real", "imag"], frf.frequency_hz.map((hz, i) => ({ frequency_hz: hz, real: frf.real[i], imag: frf.imag[i] }))));
  }
  return `${parts.join("\n\n")}\n`;
}

/** Everything that a link holds. A robot of the library is named, not copied. */
function linkState() {
  const { robot, ...rest } = content;
  const own = ROBOTS[robot.name] === robot.text ? { ...robot, text: undefined } : robot;
  return { version: 1, ...rest, robot: own, mode: shown.mode, modes: shown.modes, response: shown.response, exaggeration: shown.exaggeration, camera: view.camera6 };
}

async function restore(state) {
  if (state?.version !== 1 || typeof state.robot !== "object") {
    throw new Error("the link has no robot of this page");
  }
  const text = state.robot.text ?? ROBOTS[state.robot.name];
  if (text === undefined) {
    throw new Error(`the library of this page has no robot “${state.robot.name}”`);
  }
  const { hold, pose, lengths, pinned, response, more, model } = state;
  // Lengths without a pose from which the search starts are solved once as the program solves them.
  const start = state.start ?? null;
  const rule = state.rule === "lowest" ? "" : state.rule ?? "";
  if (rule && ![...$("rule").options].some(({ value }) => value === rule)) {
    $("rule").append(element("option", { value: rule }, rule));
  }
  shown.modes = state.modes ?? 20;
  await setRobot(state.robot.name, text, { robot: { name: state.robot.name, text, set: state.robot.set ?? [] }, hold: hold ?? "file", pose: pose ?? null, lengths: lengths ?? null, start, rule, pinned: pinned ?? [], more: more ?? {}, model: model ?? {} });
  shown.response = response ?? null;
  shown.mode = state.mode ?? -1;
  shown.exaggeration = view.exaggeration = state.exaggeration ?? 1;
  $("exaggeration").value = shown.exaggeration;
  $("count").value = shown.modes;
  $("rule").value = content.rule;
  shown.camera = state.camera;
  $("play").hidden = $("amplitude-label").hidden = shown.mode < 0;
}

/** Timer of the note on the last import; the next files end it, so that it does not hide what is told about them. */
let importNote = 0;

async function openFiles(list) {
  clearTimeout(importNote);
  const files = await Promise.all([...list].map(async (file) => ({ path: file.name, text: await file.text() })));
  if (files.length === 0) {
    return;
  }
  if (files.length === 1 && /\.toml$/i.test(files[0].path)) {
    await setRobot(files[0].path, files[0].text);
    showLibrary();
    return;
  }
  try {
    const { text } = await engine.call("answer", { request: { command: "import", files } });
    const found = JSON.parse(text);
    await setRobot(`${files[0].path.replace(/\.[^.]*$/, "")}.toml`, found.text);
    showLibrary();
    const told = [...found.assumed.map((line) => `assumed: ${line}`), ...found.lost.map((line) => `left out: ${line}`)];
    if (told.length) {
      shown.imported = `Imported.\n${told.join("\n")}`;
      importNote = setTimeout(() => tell(shown.imported, true), 400);
    }
  } catch (error) {
    tell(`${files.map((file) => file.path).join(", ")}: ${error.message}`);
  }
}

function showLibrary() {
  const own = ROBOTS[content.robot.name] !== undefined && ROBOTS[content.robot.name] === content.robot.text;
  const options = Object.entries(ROBOTS).map(([name, text]) => element("option", { value: name }, /^name = "(.*)"/m.exec(text)?.[1] ?? name));
  if (!own) {
    options.unshift(element("option", { value: "" }, content.robot.name || "own file"));
  }
  $("library").replaceChildren(...options);
  $("library").value = own ? content.robot.name : "";
}

async function copy(text, button) {
  try {
    await navigator.clipboard.writeText(text);
  } catch {
    const area = element("textarea", {}, text);
    document.body.append(area);
    area.select();
    document.execCommand("copy");
    area.remove();
  }
  const old = button.textContent;
  button.textContent = "Copied";
  setTimeout(() => { button.textContent = old; }, 1500);
}

// ---------------------------------------------------------------------------------------------------- start

function listen() {
  $("library").addEventListener("change", () => {
    const name = $("library").value;
    if (name) {
      setRobot(name, ROBOTS[name]).then(showLibrary);
    }
  });
  $("open").addEventListener("click", () => $("files").click());
  $("files").addEventListener("change", () => openFiles($("files").files).then(() => { $("files").value = ""; }));
  addEventListener("dragover", (event) => { event.preventDefault(); $("drop").hidden = false; });
  addEventListener("dragleave", (event) => { $("drop").hidden = event.relatedTarget !== null ? $("drop").hidden : true; });
  addEventListener("drop", (event) => {
    event.preventDefault();
    $("drop").hidden = true;
    openFiles(event.dataTransfer.files);
  });
  $("undo").addEventListener("click", () => step(history.past, history.future));
  $("redo").addEventListener("click", () => step(history.future, history.past));
  addEventListener("keydown", (event) => {
    const typing = event.target.closest?.(".cm-editor, input:not([type=range]), textarea");
    if ((event.ctrlKey || event.metaKey) && event.key.toLowerCase() === "z" && !typing) {
      event.preventDefault();
      (event.shiftKey ? $("redo") : $("undo")).click();
    }
  });
  $("share").addEventListener("click", async () => {
    const fragment = await packed(linkState());
    window.history.replaceState(null, "", `#${fragment}`);
    await copy(location.href, $("share"));
  });
  addEventListener("hashchange", async () => {
    try {
      await restore(await unpacked(location.hash.slice(1)));
      showLibrary();
    } catch {
      tell("this link cannot be read: it is not complete, or of another version of this page");
    }
  });
  $("theme").addEventListener("click", () => setTheme(document.documentElement.dataset.theme === "dark" ? "light" : "dark"));
  matchMedia("(prefers-color-scheme: dark)").addEventListener("change", ({ matches }) => setTheme(matches ? "dark" : "light"));
  $("remember").addEventListener("click", () => {
    before = before ? null : { frame, response: answered };
    $("remember").setAttribute("aria-pressed", String(before !== null));
    view.remember(before?.frame ?? null);
    workspace.remember(before !== null);
    showFrame();
    showResponse();
  });
  document.querySelectorAll("[data-save]").forEach((button) => button.addEventListener("click", () => saveAs(button.dataset.save)));
  document.querySelectorAll("[data-copy]").forEach((button) => button.addEventListener("click", () => copy($(button.dataset.copy).textContent, button)));

  // Tabs.
  const tabs = [...document.querySelectorAll("[role=tab]")];
  const choose = (tab) => tabs.forEach((other) => {
    other.setAttribute("aria-selected", String(other === tab));
    other.tabIndex = other === tab ? 0 : -1;
    $(other.getAttribute("aria-controls")).hidden = other !== tab;
  });
  tabs.forEach((tab, i) => {
    tab.addEventListener("click", () => choose(tab));
    tab.addEventListener("keydown", ({ key }) => {
      const next = { ArrowRight: tabs[i + 1], ArrowLeft: tabs[i - 1] }[key];
      if (next) {
        choose(next);
        next.focus();
      }
    });
  });

  // Values.
  const add = $("path");
  const pin = () => {
    const path = add.value.trim();
    if (parameters.some((one) => one.path === path)) {
      if (!content.pinned.includes(path)) {
        content.pinned = [...content.pinned, path];
        showSliders();
        commit();
      }
      add.value = "";
      add.removeAttribute("aria-invalid");
    } else if (path !== "") {
      add.setAttribute("aria-invalid", "true");
    }
  };
  add.addEventListener("change", pin);
  add.addEventListener("input", () => { if (parameters.some((one) => one.path === add.value)) { pin(); } });
  $("reset").addEventListener("click", () => {
    content.robot = { ...content.robot, set: [] };
    showSliders();
    change({ robot: true });
    commit();
  });
  $("rule").addEventListener("change", () => {
    content.rule = $("rule").value;
    change({ robot: true });
    commit();
  });

  // View.
  document.querySelectorAll("[data-handle]").forEach((button) => button.addEventListener("click", () => {
    document.querySelectorAll("[data-handle]").forEach((other) => other.setAttribute("aria-pressed", String(other === button)));
    shown.handle = button.dataset.handle;
    view.setHandles(button.dataset.handle);
  }));
  document.querySelectorAll("[data-look]").forEach((button) => button.addEventListener("click", () => view.look(button.dataset.look)));
  $("exaggeration").addEventListener("input", () => {
    const value = numberOf($("exaggeration").value);
    if (value !== null && value >= 0 && value <= 1000) {
      shown.exaggeration = view.exaggeration = value;
      if (frame && !shown.broken) {
        view.setFrame(frame);
      }
    }
  });
  document.querySelectorAll("#pose [data-pose]").forEach((field) => {
    field.addEventListener("input", () => { field.dirty = true; });
    field.addEventListener("change", () => {
      field.dirty = false;
      const value = numberOf(field.value);
      if (value === null) {
        field.setAttribute("aria-invalid", "true");
        tell(`“${field.value}” is not a number`);
        return;
      }
      field.removeAttribute("aria-invalid");
      const pose = presentPose();
      pose[Number(field.dataset.pose)] = value;
      setPose(pose);
      commit();
    });
  });
  $("pose").addEventListener("submit", (event) => event.preventDefault());
  document.querySelectorAll("[data-hold]").forEach((button) => button.addEventListener("click", () => hold(button.dataset.hold)));
  $("home").addEventListener("click", () => {
    Object.assign(content, { hold: "file", pose: null, lengths: null, start: null });
    change({ robot: true });
    commit();
  });
  view.canvas.addEventListener("keydown", (event) => {
    const axis = { ArrowRight: [0, 1], ArrowLeft: [0, -1], ArrowUp: [1, 1], ArrowDown: [1, -1], PageUp: [2, 1], PageDown: [2, -1] }[event.key];
    if (!axis || !frame) {
      return;
    }
    event.preventDefault();
    const pose = presentPose();
    const stepSize = rounding() * (event.shiftKey ? 100 : 10);
    pose[axis[0]] = Number((pose[axis[0]] + axis[1] * stepSize).toPrecision(10));
    setPose(pose);
    clearTimeout(shown.keys);
    shown.keys = setTimeout(commit, 500);
  });

  // Modes and response.
  $("play").addEventListener("click", () => {
    if (view.mode) {
      view.mode.playing = !view.mode.playing;
      $("play").textContent = view.mode.playing ? "Pause" : "Play";
      view.draw();
    }
  });
  $("amplitude").addEventListener("input", () => { view.amplitude = Number($("amplitude").value); view.draw(); });
  $("count").addEventListener("change", () => {
    const value = numberOf($("count").value);
    if (value === null || value < 1 || value > 200 || value % 1 !== 0) {
      $("count").setAttribute("aria-invalid", "true");
      tell("the number of frequencies has to be a whole number from 1 to 200");
      return;
    }
    $("count").removeAttribute("aria-invalid");
    shown.modes = value;
    change({ frame: true });
  });
  ["input", "output"].forEach((id) => $(id).addEventListener("change", () => {
    shown.response = { ...shown.response, [id]: $(id).value };
    change({ response: true });
  }));
  ["from", "to"].forEach((id) => $(id).addEventListener("change", () => setRange(id, $(id))));
  $("log").addEventListener("change", () => {
    shown.response = { ...shown.response, log: $("log").checked, from: shown.response.from || Number((shown.response.to / 200).toPrecision(2)) };
    showSignals();
    change({ response: true });
  });
  $("response").addEventListener("submit", (event) => event.preventDefault());
  new ResizeObserver(() => showResponse()).observe($("bode"));

  $("compare-run").addEventListener("click", compare);
}

async function compare() {
  const button = $("compare-run");
  if (shown.comparing) {
    comparing.cancel();
    return;
  }
  shown.comparing = true;
  button.textContent = "Cancel";
  const begin = performance.now();
  const clock = setInterval(() => put($("compare-state"), `${((performance.now() - begin) / 1000).toFixed(0)} s`), 500);
  try {
    const request = { command: "compare", ...statics(), below_hz: frame.belowHz || 20 };
    const text = await comparing.run(1, async ([worker]) => (await worker.call("answer", { request })).text);
    showComparison(JSON.parse(text));
  } catch (error) {
    $("compare").replaceChildren(element("p", { class: "soft" }, error instanceof Cancelled ? "Cancelled." : error.message));
  }
  clearInterval(clock);
  put($("compare-state"), "");
  button.textContent = "Compare the models";
  shown.comparing = false;
}

function showComparison(found) {
  const rows = found.models.map((model) => element("tr", {},
    element("td", { class: "left" }, model.cable_model),
    element("td", {}, short(model.modes[0]?.frequency_hz, 5)),
    element("td", {}, String(model.missed ?? "")),
    element("td", {}, short(100 * model.largest_difference, 3)),
    element("td", {}, short(model.first_wrong_hz, 4))));
  const heads = [["Model", "", "left"], ["First", "[Hz]"], ["Missed", "modes"], ["Largest error", "[%]"], ["Wrong from", "[Hz]"]];
  const head = heads.map(([text, unit, kind]) => element("th", { class: kind }, text, element("span", {}, unit)));
  $("compare").replaceChildren(
    element("p", { class: "advice" }, found.advice?.text ?? ""),
    element("div", { class: "table" }, element("table", {}, element("thead", {}, element("tr", {}, ...head)), element("tbody", {}, ...rows))));
}

function setTheme(theme) {
  document.documentElement.dataset.theme = theme;
  view?.recolor();
  if (frame && !shown.broken) {
    view.setFrame(frame);
  }
}

/** WebAssembly from this file, or from beside it. */
async function coreBytes() {
  const own = $("core");
  if (!own) {
    return (await fetch("funicular.wasm")).arrayBuffer();
  }
  const packedBytes = Uint8Array.from(atob(own.textContent), (c) => c.charCodeAt(0));
  return new Response(new Blob([packedBytes]).stream().pipeThrough(new DecompressionStream("gzip"))).arrayBuffer();
}

async function start() {
  setTheme(matchMedia("(prefers-color-scheme: dark)").matches ? "dark" : "light");
  $("version").textContent = VERSION;
  await prepare(await coreBytes(), WORKER);
  engine = new Engine();
  [details, comparing] = [new Job(), new Job()];
  let last = null;
  try {
    view = new View($("view"), {
      drag: (position, quaternion) => {
        last = rounded(position, quaternion);
        setPose(last);
      },
      dragEnd: () => {
        if (last) {
          commit();
          last = null;
        }
        if (frame && !shown.broken) {
          view.setFrame(frame);
        }
        rest();
      },
      turned: () => {},
    });
  } catch (error) {
    tell(`This browser shows no 3D graphics (WebGL): ${error.message}`);
    throw error;
  }
  workspace = new Workspace({
    request: () => ({ ...statics(), robot: content.robot }),
    state: () => ({ about, frame, view }),
    go: (pose) => { setPose(pose); commit(); },
    rounded: (position, quaternion) => rounded(position, quaternion),
    tell,
    cores: CORES,
  });
  const schema = JSON.parse((await engine.call("answer", { request: { command: "schema" } })).text);
  editor = new Editor($("editor"), schema, (text) => {
    clearTimeout(shown.typing);
    shown.typing = setTimeout(async () => {
      content.robot = { ...content.robot, text, set: [] };
      showLibrary();
      change({ robot: true });
      await readParameters();
      commit();
    }, 300);
  });
  listen();
  const given = JSON.parse($("start").textContent);
  try {
    if (location.hash.length > 1) {
      await restore(await unpacked(location.hash.slice(1)));
    } else if (given) {
      await restore(given);
    } else {
      await setRobot(FIRST_ROBOT, ROBOTS[FIRST_ROBOT]);
    }
  } catch (error) {
    await setRobot(FIRST_ROBOT, ROBOTS[FIRST_ROBOT]);
    setTimeout(() => tell(`This link cannot be read: ${error.message}`), 500);
  }
  showLibrary();
  showHistory();
}

// For tests: the state and the numbers of the page, as data.
window.funicular = {
  get content() { return content; },
  get frame() { return frame; },
  get response() { return answered; },
  get freedoms() { return about.degrees_of_freedom; },
  get asked() { return { response: shown.response }; },
  get times() { return times; },
  get idle() { return !computing && frame !== null; },
  get view() { return view; },
  ask: async (request) => JSON.parse((await engine.call("answer", { request })).text),
  crash: () => engine.call("crash"),
};

start();
