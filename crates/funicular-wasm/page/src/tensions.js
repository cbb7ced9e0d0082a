// Table of tensions, the legend of their colours, and fields for held lengths.

import { colorOf, COLORS, isLimited } from "./colors.js";
import { $, element, plain, short, span } from "./format.js";
import { commit } from "./history.js";
import { accept, numberOf, put, refuse, rowsOf } from "./messages.js";
import { setLengths } from "./pose.js";
import { content, on, page, shown } from "./store.js";

function showLegend() {
  const { frame } = page;
  const limits = frame.limited && frame.cables.every((cable) => Number.isFinite(cable.maximum));
  const scale = [0, 0.2, 0.4, 0.6, 0.8, 1].map((at) => `#${colorOf(at).getHexString()}`).join(",");
  const { kinds } = page.view.drives;
  // The ends of the scale: the limits of the cables, or zero and the highest tension, as the view colours them.
  const of = (name) => span(frame.cables.map((cable) => cable[name]));
  const [low, high] = limits
    ? [`minimum ${of("minimum")} N `, ` maximum ${of("maximum")} N`]
    : ["0 N ", ` highest ${short(Math.max(...frame.cables.map((cable) => cable.highest)), 3)} N`];
  const key = `${low} ${high} ${Object.values(kinds)}`;
  if ($("legend").dataset.key === key) {
    return;
  }
  $("legend").dataset.key = key;
  const swatch = (color, words) => `<span><i class="one" style="background:${color}"></i>${words}</span>`;
  $("legend").innerHTML =
    `<span>Tension: ${low}<i style="background:linear-gradient(90deg,${scale})"></i>${high}</span>` +
    swatch(COLORS.slack, "slack") +
    swatch(COLORS.beyond, "beyond a limit") +
    (kinds.drums ? '<span><i class="dot drum"></i>drum</span>' : "") +
    (kinds.pulleys ? `<span><i class="dot wheel"></i>pulley${kinds.guides ? ", guide wheel" : ""}</span>` : "") +
    (kinds.supports ? '<span><i class="dot support"></i>flexible support</span>' : "");
}

function rowOf(i) {
  const label = `Unstrained length of cable ${i + 1} in metres`;
  const length = element("input", { "aria-label": label, inputmode: "decimal" });
  length.addEventListener("change", () => setLength(i, length));
  const track = element("span", { class: "track", role: "img" }, element("i"), element("b", { class: "past" }));
  return element(
    "tr",
    {},
    element("td", { class: "left name" }),
    element("td"),
    element("td", { class: "left" }, track),
    element("td"),
    element("td"),
    element("td", { class: "lengths" }, length, element("span")),
  );
}

/** Empties the rows: a robot that can be read keeps the names of its cables, and held lengths stay to be corrected. */
function showNone() {
  const cables = shown.refused ? [] : (page.about?.check.cables ?? []);
  const free = content.hold === "lengths";
  const rows = rowsOf("tensions", cables.length, rowOf);
  cables.forEach(({ name }, i) => {
    const { cells } = rows[i];
    put(cells[0], name);
    [1, 3, 4].forEach((k) => put(cells[k], "–"));
    const track = cells[2].firstChild;
    track.firstChild.style.cssText = "width:0";
    track.lastChild.style.cssText = "display:none";
    track.setAttribute("aria-label", "no tension");
    track.title = "";
    const [field, text] = cells[5].children;
    field.hidden = !free;
    put(text, free ? "" : "–");
    if (free && document.activeElement !== field) {
      field.value = plain(content.lengths[i], 7);
    }
    rows[i].classList.remove("beyond");
  });
  delete $("legend").dataset.key;
  $("legend").replaceChildren();
}

function showTensions() {
  const { about, before, frame, view } = page;
  if (!frame) {
    return;
  }
  const rows = rowsOf("tensions", frame.cables.length, rowOf);
  const free = content.hold === "lengths";
  const top = Math.max(...frame.cables.map((cable) => (isLimited(frame, cable) ? cable.maximum : 1.1 * cable.highest)));
  frame.cables.forEach((cable, i) => {
    const { cells } = rows[i];
    put(cells[0], about.check.cables[i].name);
    put(cells[1], short(cable.tension, 5));
    const most = isLimited(frame, cable) ? cable.maximum : top;
    const track = cells[2].firstChild;
    const part = Math.max(0, Math.min(1, cable.highest / most));
    const own = view.lines[i]?.material.color.getHexString();
    track.firstChild.style.cssText = `width:${(100 * part).toFixed(1)}%;background:#${own}`;
    const [lowest, highest] = [short(cable.minimum, 3), short(cable.maximum, 4)];
    track.setAttribute("aria-label", `${short(cable.tension, 4)} of ${lowest} to ${highest} newtons`);
    track.title = frame.limited ? `${lowest} to ${Number.isFinite(cable.maximum) ? highest : "∞"} N` : "";
    const past = before?.frame.cables[i] ? Math.min(1, before.frame.cables[i].highest / most) : null;
    track.lastChild.style.cssText = past === null ? "display:none" : `left:${(100 * past).toFixed(1)}%`;
    put(cells[3], short(100 * cable.sagRatio, 3));
    put(cells[4], short(cable.lambda2, 3));
    const [field, text] = cells[5].children;
    field.hidden = !free;
    put(text, free ? "" : short(cable.length, 5));
    if (free && document.activeElement !== field) {
      field.value = plain(cable.length, 7);
      accept(field);
    }
    rows[i].classList.toggle("beyond", cable.beyond || cable.slack === 1);
  });
}

function setLength(i, field) {
  const { about } = page;
  const value = numberOf(field.value);
  if (value === null || value <= 0) {
    const name = about.check.cables[i].name;
    refuse(field, `cable “${name}”: “${field.value}” is not a length; give a positive number of metres`);
    return;
  }
  accept(field);
  setLengths(content.lengths.map((length, k) => (k === i ? value : length))).then(commit);
}

export function listen() {
  on("frame", showTensions);
  on("empty", showNone);
  on("remember", showTensions);
  on("frame", showLegend);
}
