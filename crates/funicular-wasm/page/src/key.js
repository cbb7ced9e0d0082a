// The facts that most people look for first, and the remarks on the state.

import { cableName, cableNames } from "./border.js";
import { limitingCable } from "./colors.js";
import { $, element, short } from "./format.js";
import { age, put } from "./messages.js";
import { KINDS } from "./modes.js";
import { sharingText } from "./platform_modes.js";
import { on, page } from "./store.js";

const NAMES = [
  "Highest tension",
  "Lowest tension",
  "First resonance",
  "First resonance of the platform",
  "Maximum payload",
  "Stiffness in the softest direction",
];

/** Those of them that are shown over the view, with short names: what a person watches while the platform moves. */
const OVER_VIEW = [
  [3, "Platform resonance"],
  [0, "Highest tension"],
  [4, "Maximum payload"],
  [5, "Softest stiffness"],
];

/** Tells a screen reader the results when the platform rests. */
function speak() {
  const { frame } = page;
  if (frame) {
    const [x, y, z] = frame.position.map((value) => short(Number(value.toFixed(3)), 4));
    const first = frame.modes[frame.first?.index];
    const highest = frame.cables[limitingCable(frame)].highest;
    const resonance = first ? ` First resonance of the platform ${short(first.hz, 3)} hertz.` : "";
    put(
      $("spoken"),
      `Platform at x ${x}, y ${y}, z ${z} metres. Highest tension ${short(highest, 3)} newtons, ` +
        `${cableName(page.about.check.cables[limitingCable(frame)].name)}.${resonance}`,
    );
  }
}

/** First resonance of the platform; dots while it is searched above the list. */
function platformFact(frame, delta) {
  const { before } = page;
  const first = (of) => (of.first?.index === undefined ? null : of.modes[of.first.index]);
  const own = first(frame);
  const sharing = sharingText(frame, page.about.considerable_share);
  const too = sharing ? `; ${sharing}` : "";
  if (own) {
    return [`${short(own.hz, 4)} Hz`, `mode ${frame.first.index + 1}${delta(before && first(before.frame)?.hz)}${too}`];
  }
  const now = page.view.dragging ? "searched when the platform rests" : "searching";
  return frame.first
    ? ["–", `${frame.first.reason}${too}`]
    : ["…", `above the ${frame.modes.length} lowest; ${now}${too}`];
}

function showKey() {
  const { frame } = page;
  const facts = frame ? factsOf(frame) : NAMES.map(() => ["–", ""]);
  fill($("key"), NAMES, facts);
  fill(
    $("hud"),
    OVER_VIEW.map(([, name]) => name),
    OVER_VIEW.map(([i]) => facts[i]),
  );
}

/** Fills a list of facts, whose elements are made once. */
function fill(place, names, facts) {
  if (place.children.length !== facts.length) {
    const entry = (name) =>
      element("div", {}, element("dt", {}, name), element("dd", {}, element("span"), element("small")));
    place.replaceChildren(...names.map(entry));
  }
  facts.forEach(([value, more], i) => {
    const fact = place.children[i].lastChild;
    put(fact.firstChild, value);
    put(fact.lastChild, more);
    fact.lastChild.title = more;
  });
}

const KILO_FROM = 1e4; // N/m, above which a stiffness is shown in kN/m

const stiffnessText = (value) =>
  Math.abs(value) >= KILO_FROM ? `${short(value / 1000, 4)} kN/m` : `${short(value, 4)} N/m`;

/** Values of the key figures and what is told about them. */
function factsOf(frame) {
  const { about, before } = page;
  const names = about.check.cables.map((cable) => cable.name);
  const highest = frame.cables.reduce((best, cable, i) => (cable.highest > frame.cables[best].highest ? i : best), 0);
  const lowest = frame.cables.reduce((best, cable, i) => (cable.lowest < frame.cables[best].lowest ? i : best), 0);
  const top = frame.cables[highest];
  const bottom = frame.cables[lowest];
  const [first] = frame.modes;
  const delta = (past) => (past ? ` (before ${short(past, 4)})` : "");
  const ofMaximum =
    frame.limited && Number.isFinite(top.maximum)
      ? `, ${short((100 * top.highest) / top.maximum, 3)} % of its maximum`
      : "";
  const ofMinimum = frame.limited ? `, minimum ${short(bottom.minimum, 3)} N` : "";
  const highestBefore = before && Math.max(...before.frame.cables.map((cable) => cable.highest));
  const lowestBefore = before && Math.min(...before.frame.cables.map((cable) => cable.lowest));
  return [
    [`${short(top.highest, 4)} N`, `${cableName(names[highest])}${ofMaximum}${delta(highestBefore)}`],
    [`${short(bottom.lowest, 4)} N`, `${cableName(names[lowest])}${ofMinimum}${delta(lowestBefore)}`],
    first ? [`${short(first.hz, 4)} Hz`, `of the ${KINDS[first.kind]}${delta(before?.frame.modes[0]?.hz)}`] : ["–", ""],
    platformFact(frame, delta),
    payloadFact(delta),
    [
      frame.stable === undefined ? "rigid" : stiffnessText(frame.minStiffness),
      `${frame.stable === false ? "unstable" : ""}${delta(before?.frame.minStiffness)}`,
    ],
  ];
}

function payloadFact(delta) {
  const {
    before,
    settled: { payload },
    view,
  } = page;
  if (!payload || view.dragging) {
    return ["…", ""];
  }
  const { maximum } = payload;
  if (payload.reason || !maximum?.payload_kg) {
    return ["–", payload.reason ?? "the cables have no maximum tension"];
  }
  const limiting = maximum.cables.filter((cable) => cable.limit_reached === "maximum").map((cable) => cable.name);
  const slack = maximum.cables.filter((cable) => cable.limit_reached === "minimum").map((cable) => cable.name);
  const least = slack.length ? `${cableNames(slack)} at the minimum` : "";
  const by = limiting.length ? `limited by ${cableNames(limiting)}` : least;
  return [`${short(maximum.payload_kg, 4)} kg`, `${by}${delta(before?.payload?.maximum?.payload_kg)}`];
}

function showWarnings() {
  const { frame, settled } = page;
  age("warnings", false);
  const none = frame ? "No remarks on this state." : "–";
  const all = settled.reason ? [settled.reason] : (settled.statics?.warnings ?? []);
  $("warnings").replaceChildren(...(all.length ? all : [none]).map((text) => element("li", {}, text)));
}

export function listen() {
  on("frame", showKey);
  on("border", showKey);
  on("platform", showKey);
  on("remember", showKey);
  on("empty", () => {
    showKey();
    showWarnings();
    put($("spoken"), "");
  });
  on("outdated", () => {
    age("warnings", true);
    put($("spoken"), "");
  });
  on("rested", speak);
  on("settled", showWarnings);
  on("settled", showKey);
}
