// Pose of the platform: fields, handles, keys, and what is held.

import { change, holdsLengths, mayChoose } from "./computation.js";
import { $, short } from "./format.js";
import { anglesOf, quaternionOf } from "./frame.js";
import { commit } from "./history.js";
import { numberOf, refuse, tell, textOf } from "./messages.js";
import { content, emit, on, page, shown } from "./store.js";

/** Step of a position that a person can choose with a handle [m]. */
const rounding = () => 10 ** Math.floor(Math.log10(page.view.size * 2e-4));

/** Pose with few digits: those that a person can choose with the handle. */
export function rounded(position, quaternion) {
  const step = rounding();
  const decimals = Math.max(0, Math.round(-Math.log10(step)));
  const { name } = page.about.motion;
  const angles = name === "point-mass" ? [0, 0, 0] : anglesOf(quaternion);
  return [...position.map((value) => Number((Math.round(value / step) * step).toFixed(decimals))), ...angles.map((value) => Number(value.toFixed(2)) + 0)];
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

/** Pose from which the next one is made: the requested one, or that of the equilibrium with few digits. */
const presentPose = () => (content.hold === "pose" ? [...content.pose] : rounded(page.frame.position, page.frame.quaternion));

/** Holds the platform at a pose. */
export function setPose(pose) {
  content.hold = "pose";
  content.pose = allowed(pose);
  content.lengths = null;
  content.start = null;
  showHold();
  // The tension rule is a key of the robot's request, and only poses have one.
  change(content.rule ? { robot: true } : { frame: true });
}

function showHold() {
  const present = content.hold === "file" ? (holdsLengths() ? "lengths" : "pose") : content.hold;
  document.querySelectorAll("[data-hold]").forEach((button) => button.setAttribute("aria-pressed", String(button.dataset.hold === present)));
  $("rule").disabled = !mayChoose();
  page.view.canDrag = true;
}

function hold(kind) {
  const { frame } = page;
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
  document.body.classList.remove("broken");
  showHold();
  view.setFrame(frame, view.dragging);
  const under = Number.isFinite(frame.distance) && frame.distance > 0;
  showPose(content.hold === "pose" && !under ? content.pose : [...frame.position, ...frame.angles]);
  view.canvas.setAttribute("aria-label", `Robot with ${frame.cables.length} cables; platform at x ${short(frame.position[0])}, y ${short(frame.position[1])}, z ${short(frame.position[2])} metres. Arrow keys move the platform, Page up and Page down lift it.`);
  const parts = [];
  if (holdsLengths()) {
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
}

function frameRefused(error) {
  tell(error.status === 1 ? `No equilibrium here: ${error.message}` : textOf(error));
  if (content.hold === "pose") {
    page.view.setBroken(content.pose.slice(0, 3), quaternionOf(content.pose.slice(3)));
    showPose(content.pose);
  }
  $("state").textContent = "No equilibrium: the results are those of the last state that had one.";
  document.body.classList.add("broken");
}

let dragged = null;

/** What the view tells: a handle is dragged, and released. */
export const handles = {
  drag: (position, quaternion) => {
    dragged = rounded(position, quaternion);
    setPose(dragged);
  },
  dragEnd: () => {
    if (dragged) {
      commit();
      dragged = null;
    }
    if (page.frame && !shown.broken) {
      page.view.setFrame(page.frame);
    }
    emit("drag-end");
  },
  turned: () => {},
};

let keys = 0;

function onKey(event) {
  const axis = { ArrowRight: [0, 1], ArrowLeft: [0, -1], ArrowUp: [1, 1], ArrowDown: [1, -1], PageUp: [2, 1], PageDown: [2, -1] }[event.key];
  if (!axis || !page.frame) {
    return;
  }
  event.preventDefault();
  const pose = presentPose();
  const step = rounding() * (event.shiftKey ? 100 : 10);
  pose[axis[0]] = Number((pose[axis[0]] + axis[1] * step).toPrecision(10));
  setPose(pose);
  clearTimeout(keys);
  keys = setTimeout(commit, 500);
}

/** Listens to the bar over the view, the fields and the keys. */
export function listen() {
  const { view } = page;
  on("robot", showRobot);
  on("frame", showFrame);
  on("frame-refused", frameRefused);
  document.querySelectorAll("[data-handle]").forEach((button) => button.addEventListener("click", () => {
    document.querySelectorAll("[data-handle]").forEach((other) => other.setAttribute("aria-pressed", String(other === button)));
    view.setHandles(button.dataset.handle);
  }));
  document.querySelectorAll("[data-look]").forEach((button) => button.addEventListener("click", () => view.look(button.dataset.look)));
  $("exaggeration").addEventListener("input", () => {
    const value = numberOf($("exaggeration").value);
    if (value !== null && value >= 0 && value <= 1000) {
      shown.exaggeration = view.exaggeration = value;
      if (page.frame && !shown.broken) {
        view.setFrame(page.frame);
      }
    }
  });
  document.querySelectorAll("#pose [data-pose]").forEach((field) => {
    field.addEventListener("input", () => { field.dirty = true; });
    field.addEventListener("change", () => {
      field.dirty = false;
      const value = numberOf(field.value);
      if (value === null) {
        refuse(field, `“${field.value}” is not a number`);
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
  $("rule").addEventListener("change", () => {
    content.rule = $("rule").value;
    change({ robot: true });
    commit();
  });
  view.canvas.addEventListener("keydown", onKey);
}
