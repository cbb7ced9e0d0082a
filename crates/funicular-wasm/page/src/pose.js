// Pose of the platform: fields, handles, keys, and what is held.

import { reasonOf } from "./border.js";
import { change, endDrag, holdsLengths, mayChoose } from "./computation.js";
import { $, short } from "./format.js";
import { anglesOf, quaternionOf } from "./frame.js";
import { commit } from "./history.js";
import { accept, numberOf, put, refuse, tell, textOf } from "./messages.js";
import { content, emit, on, page, shown } from "./store.js";

/** Step of a position that a person can choose with a handle [m]. */
const rounding = () => 10 ** Math.floor(Math.log10(page.view.size * 2e-4));

/** Coordinate with few digits: those that a person can choose with the handle [m]. */
export function roundedLength(value) {
  const step = rounding();
  return Number((Math.round(value / step) * step).toFixed(Math.max(0, Math.round(-Math.log10(step)))));
}

/** Pose with few digits. */
export function rounded(position, quaternion) {
  const { name } = page.about.motion;
  const angles = name === "point-mass" ? [0, 0, 0] : anglesOf(quaternion);
  return [...position.map(roundedLength), ...angles.map((value) => Number(value.toFixed(2)) + 0)];
}

/** Pose within the plane of a planar platform. */
export function allowed(pose) {
  const { name, normal, offset_m: offset } = page.about.motion;
  if (name !== "planar") {
    return pose;
  }
  const position = pose.slice(0, 3);
  const off = position.reduce((sum, value, k) => sum + value * normal[k], 0) - offset;
  const axis = normal.findIndex((value) => Math.abs(value) > 0.99);
  const angles = pose.slice(3).map((value, k) => (axis < 0 || k === axis ? value : 0));
  return [...position.map((value, k) => value - off * normal[k]), ...angles];
}

/** Pose that the robot file gives, if it does. */
function poseOfFile() {
  const pose = page.about?.check.pose;
  return pose ? { position: pose.position_m, quaternion: quaternionOf(pose.roll_pitch_yaw_deg) } : null;
}

/**
 * Pose from which the next one is made: the requested one, or with few digits that of the last equilibrium or of the
 * file; null if there is none.
 */
export function presentPose() {
  if (!page.about) {
    return null;
  }
  if (content.hold === "pose") {
    return [...content.pose];
  }
  const from = page.frame ?? page.last ?? poseOfFile();
  return from && rounded(from.position, from.quaternion);
}

/** Holds the platform at a pose; resolves when it is shown, or refused. */
export function setPose(pose) {
  content.hold = "pose";
  content.pose = allowed(pose);
  content.lengths = null;
  content.start = null;
  showHold();
  // The tension rule is a key of the robot's request, and only poses have one.
  return change(content.rule ? { robot: true } : { frame: true });
}

function showHold() {
  const present = content.hold === "file" ? (holdsLengths() ? "lengths" : "pose") : content.hold;
  document.querySelectorAll("[data-hold]").forEach((button) => {
    button.setAttribute("aria-pressed", String(button.dataset.hold === present));
  });
  $("rule").disabled = !mayChoose();
}

/** Holds the cable lengths of the present frame; resolves when they are computed. */
export function holdLengths() {
  const { frame } = page;
  const lengths = frame.cables.map((cable) => cable.length);
  Object.assign(content, { hold: "lengths", lengths, start: [...frame.position, ...frame.quaternion], pose: null });
  showHold();
  return change({ robot: true });
}

/** Holds other lengths; the search begins at the last pose. */
export function setLengths(lengths) {
  const { last } = page;
  const start = last ? [...last.position, ...last.quaternion] : content.start;
  Object.assign(content, { start, lengths });
  return change({ frame: true });
}

function hold(kind) {
  const { frame } = page;
  const pose = presentPose();
  if (kind === "lengths" && !frame) {
    tell(`The cable lengths cannot be held: ${page.reason}.`, true);
  } else if (kind === "lengths") {
    holdLengths().then(commit);
  } else if (frame || pose) {
    setPose(frame ? rounded(frame.position, frame.quaternion) : pose).then(commit);
  } else {
    tell(`There is no pose to hold: ${page.reason}.`, true);
  }
}

const ANGLE_DIGITS = 2; // of degrees
const MAX_DIGITS = 6; // of what a person has typed

/** Decimals of a position [m]: a millimetre, or the step of the handle of a robot so small that this is coarse. */
const lengthDigits = () => Math.max(3, -Math.floor(Math.log10(rounding())));

/** Shows a pose in the fields, rounded unless `exact`, as a person has chosen it; null empties them. */
function showPose(pose, exact) {
  document.querySelectorAll("#pose [data-pose]").forEach((field) => {
    if (document.activeElement !== field || !field.dirty) {
      const k = Number(field.dataset.pose);
      const digits = k < 3 ? lengthDigits() : ANGLE_DIGITS;
      field.value = pose ? String(Number(pose[k].toFixed(exact ? MAX_DIGITS : digits)) + 0) : "";
      accept(field);
    }
  });
}

function showRobot() {
  const { name, normal } = page.about.motion;
  const [rigid, planar] = [name === "rigid", name === "planar"];
  document.querySelector("[data-handle=rotate]").disabled = name === "point-mass";
  document.querySelectorAll("#pose [data-pose]").forEach((field) => {
    const k = Number(field.dataset.pose);
    const along = planar && Math.abs(normal[k % 3]) > 0.99;
    field.disabled = k < 3 ? along : !(rigid || (planar && along));
  });
  $("rule").disabled = !mayChoose();
}

function showFrame() {
  const { frame, view } = page;
  showHold();
  view.setFrame(frame, view.dragging);
  const under = Number.isFinite(frame.distance) && frame.distance > 0;
  const exact = content.hold === "pose" && !under;
  showPose(exact ? content.pose : [...frame.position, ...frame.angles], exact);
  const [x, y, z] = frame.position.map((value) => short(Number(value.toFixed(3)), 4));
  view.canvas.setAttribute(
    "aria-label",
    `Robot with ${frame.cables.length} cables; ` +
      `platform at x ${x}, y ${y}, z ${z} metres. Arrow keys move the platform, Page up and Page down lift it.`,
  );
  const parts = [];
  if (holdsLengths()) {
    parts.push("The pose follows from the cable lengths.");
  } else if (under) {
    const away = `${short(frame.distance, 3)} m away`;
    parts.push(`The cables cannot hold the requested pose: this is the nearest one, ${away}.`);
  } else {
    parts.push("The cable lengths follow from the pose.");
  }
  if (frame.stable === false) {
    parts.push("This equilibrium is unstable.");
  }
  const nearest = frame.about.clearance;
  if (nearest) {
    const words = nearest.margin_m < 0 ? "Too near" : "Nearest";
    parts.push(`${words}: ${nearest.pair}, ${short(nearest.distance_m, 3)} m (${nearest.required_m} m required).`);
  }
  if (frame.about.no_modes) {
    parts.push(`No natural frequencies: ${frame.about.no_modes}`);
  }
  $("state").textContent = parts.join(" ");
}

/** Pose that is asked for, although there is no equilibrium: of the request or of the file. */
function requestedPose() {
  if (!page.about || shown.refused) {
    return null;
  }
  if (content.hold === "pose") {
    return { position: content.pose.slice(0, 3), quaternion: quaternionOf(content.pose.slice(3)) };
  }
  return content.hold === "file" ? poseOfFile() : null;
}

/** Empties what shows the state: the pose of the request stays, if there is one. */
function showNone() {
  const { view, about } = page;
  put($("state"), about || shown.refused ? `There are no results: ${page.reason}.` : "");
  const pose = requestedPose();
  view.setBroken(pose);
  const exact = content.hold === "pose";
  showPose(exact ? content.pose : pose && [...pose.position, ...anglesOf(pose.quaternion)], exact);
  view.canvas.setAttribute(
    "aria-label",
    pose
      ? `Robot at a pose without results: ${page.reason}. Arrow keys move the platform.`
      : `View without a robot at rest: ${page.reason}`,
  );
  if (about) {
    showHold();
  }
}

function frameRefused(error) {
  tell(error.status === 1 ? `No equilibrium here: ${error.message}` : textOf(error));
}

/** At the border of the workspace the last pose holds; the wanted one is pale, and the view says why. */
function showBorder() {
  const { border, view } = page;
  view.setGhost(border && { position: border.pose.slice(0, 3), quaternion: quaternionOf(border.pose.slice(3)) });
  const text = border ? `Beyond the workspace: ${reasonOf(border.error.border)}.` : "";
  put($("border"), text);
  $("border").title = border ? border.error.message : "";
}

let dragged = null;

/** What the view tells: a handle is taken, dragged, and released. */
export const handles = {
  dragBegin: () => emit("drag-begin"),
  drag: (position, quaternion) => {
    dragged = rounded(position, quaternion);
    setPose(dragged);
  },
  dragEnd: async () => {
    const moved = dragged;
    dragged = null;
    await endDrag();
    if (page.frame && !page.view.dragging) {
      page.view.setFrame(page.frame);
    }
    if (moved) {
      commit();
    }
    emit("drag-end");
  },
};

/** Axis and direction in which a key moves the platform. */
const KEYS = {
  ArrowRight: [0, 1],
  ArrowLeft: [0, -1],
  ArrowUp: [1, 1],
  ArrowDown: [1, -1],
  PageUp: [2, 1],
  PageDown: [2, -1],
};

let keys = 0;

function onKey(event) {
  const axis = KEYS[event.key];
  const pose = axis && presentPose();
  if (!pose) {
    return;
  }
  event.preventDefault();
  const step = rounding() * (event.shiftKey ? 100 : 10);
  pose[axis[0]] = Number((pose[axis[0]] + axis[1] * step).toPrecision(10));
  const done = setPose(pose);
  clearTimeout(keys);
  keys = setTimeout(() => done.then(commit), 500);
}

/** Listens to the bar over the view, the fields and the keys. */
export function listen() {
  const { view } = page;
  on("robot", showRobot);
  on("frame", showFrame);
  on("frame", showBorder);
  on("border", showBorder);
  on("empty", showBorder);
  on("empty", showNone);
  on("frame-refused", frameRefused);
  document.querySelectorAll("[data-handle]").forEach((button) =>
    button.addEventListener("click", () => {
      document.querySelectorAll("[data-handle]").forEach((other) => {
        other.setAttribute("aria-pressed", String(other === button));
      });
      view.setHandles(button.dataset.handle);
    }),
  );
  document.querySelectorAll("[data-look]").forEach((button) => {
    button.addEventListener("click", () => view.look(button.dataset.look));
  });
  $("exaggeration").addEventListener("input", () => {
    const value = numberOf($("exaggeration").value);
    if (value !== null && value >= 0 && value <= 1000) {
      shown.exaggeration = view.exaggeration = value;
      if (page.frame) {
        view.setFrame(page.frame);
      }
    }
  });
  document.querySelectorAll("#pose [data-pose]").forEach((field) => {
    field.addEventListener("input", () => {
      field.dirty = true;
    });
    field.addEventListener("change", () => {
      field.dirty = false;
      const value = numberOf(field.value);
      if (value === null) {
        refuse(field, `“${field.value}” is not a number`);
        return;
      }
      const pose = presentPose();
      if (!pose) {
        refuse(field, `The pose cannot be changed: ${page.reason}.`);
        return;
      }
      accept(field);
      pose[Number(field.dataset.pose)] = value;
      setPose(pose).then(commit);
    });
  });
  $("pose").addEventListener("submit", (event) => event.preventDefault());
  document.querySelectorAll("[data-hold]").forEach((button) => {
    button.addEventListener("click", () => hold(button.dataset.hold));
  });
  $("home").addEventListener("click", () => {
    Object.assign(content, { hold: "file", pose: null, lengths: null, start: null });
    change({ robot: true });
    commit();
  });
  $("rule").addEventListener("change", () => {
    content.rule = $("rule").value;
    change({ robot: true });
    commit();
  });
  view.canvas.addEventListener("keydown", onKey);
}
