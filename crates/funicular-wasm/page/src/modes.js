// Table of natural frequencies; the chosen mode is shown in motion.

import { change } from "./computation.js";
import { $, element, short } from "./format.js";
import { accept, numberOf, put, refuse, rowsOf } from "./messages.js";
import { emit, on, page, shown } from "./store.js";

const MAX_MODES = 200;

/** Words for the kinds of modes. */
export const KINDS = {
  platform: "platform",
  cable: "cables",
  drive: "drives and supports",
  mixed: "platform and cables",
};

/** Modes of the table: the lowest ones, and the first of the platform above them. */
function listedModes({ listed, first }) {
  const lowest = Array.from({ length: listed }, (_, i) => i);
  return first?.index >= listed ? [...lowest, first.index] : lowest;
}

function rowOf() {
  const share = { class: "share", title: "fraction of the kinetic energy in the platform" };
  const row = element(
    "tr",
    { class: "pick" },
    element("td", {}, element("button")),
    element("td"),
    element("td"),
    element("td", { class: "left" }),
    element("td", { class: "left" }, element("span", share, element("i"))),
    element("td", { class: "before", hidden: true }),
  );
  row.addEventListener("click", () => chooseMode(shown.mode === row.mode ? -1 : row.mode));
  return row;
}

function showModes() {
  const { before, frame } = page;
  const listed = frame ? listedModes(frame) : [];
  const rows = rowsOf("modes", listed.length, rowOf);
  document.querySelectorAll("#modes .before").forEach((cell) => {
    cell.hidden = before === null;
  });
  listed.forEach((i, at) => {
    const mode = frame.modes[i];
    const { cells } = rows[at];
    if (rows[at].mode !== i) {
      rows[at].mode = i;
      put(cells[0].firstChild, String(i + 1));
      cells[0].firstChild.setAttribute("aria-label", `Show mode ${i + 1}`);
      rows[at].classList.toggle("apart", i > at);
    }
    put(cells[1], short(mode.hz, 5));
    put(cells[2], short(100 * mode.damping, 3));
    put(cells[3], KINDS[mode.kind]);
    cells[4].firstChild.firstChild.style.width = `${(100 * mode.platformShare).toFixed(0)}%`;
    const past = before?.frame.modes[i];
    put(cells[5], past ? `${mode.hz >= past.hz ? "+" : "−"}${short(Math.abs(100 * (mode.hz / past.hz - 1)), 3)}` : "");
    if (i === shown.mode) {
      rows[at].setAttribute("aria-current", "true");
    } else {
      rows[at].removeAttribute("aria-current");
    }
  });
  showPlay();
}

/** Shows a mode in motion; −1 ends it. */
export function chooseMode(index) {
  shown.mode = index;
  showModes();
  if (index < 0) {
    page.view.playback.setMode(null);
  } else {
    change({ mode: true });
  }
  emit("mode");
}

/** Shows the buttons of the motion if a mode of this state is chosen. */
function showPlay() {
  const none = !page.frame?.modes[shown.mode];
  $("play").hidden = none;
  $("amplitude-label").hidden = none;
}

/** Listens to the buttons of the motion and the number of modes. */
export function listen() {
  const { view } = page;
  on("frame", showModes);
  on("platform", showModes);
  on("empty", showModes);
  on("remember", showModes);
  addEventListener("keydown", ({ key, defaultPrevented }) => {
    if (key === "Escape" && !defaultPrevented && shown.mode >= 0) {
      chooseMode(-1);
    }
  });
  $("play").addEventListener("click", () => {
    const { mode } = view.playback;
    if (mode) {
      mode.playing = !mode.playing;
      $("play").textContent = mode.playing ? "Pause" : "Play";
      view.draw();
    }
  });
  $("amplitude").addEventListener("input", () => {
    view.playback.amplitude = Number($("amplitude").value);
    view.draw();
  });
  $("count").addEventListener("change", () => {
    const value = numberOf($("count").value);
    if (value === null || value < 1 || value > MAX_MODES || value % 1 !== 0) {
      refuse($("count"), `the number of frequencies has to be a whole number from 1 to ${MAX_MODES}`);
      return;
    }
    accept($("count"));
    shown.modes = value;
    change({ frame: true });
  });
}
