// The facts that most people look for first, and the remarks on the state.

import { $, element, short } from "./format.js";
import { put } from "./messages.js";
import { KINDS } from "./modes.js";
import { on, page } from "./store.js";

function showKey() {
  const { about, before, frame } = page;
  if (!frame) {
    return;
  }
  const names = about.check.cables.map((cable) => cable.name);
  const highest = frame.cables.reduce((best, cable, i) => (cable.highest > frame.cables[best].highest ? i : best), 0);
  const lowest = frame.cables.reduce((best, cable, i) => (cable.lowest < frame.cables[best].lowest ? i : best), 0);
  const top = frame.cables[highest];
  const ofPlatform = (of) => of?.modes.find((mode) => mode.platformShare >= about.platform_share);
  const [first, platform] = [frame.modes[0], ofPlatform(frame)];
  const delta = (past) => (past ? ` (before ${short(past, 4)})` : "");
  const facts = [
    ["Highest tension", `${short(top.highest, 4)} N`, `cable ${names[highest]}${frame.limited && Number.isFinite(top.maximum) ? `, ${short((100 * top.highest) / top.maximum, 3)} % of its maximum` : ""}${delta(before && Math.max(...before.frame.cables.map((cable) => cable.highest)))}`],
    ["Lowest tension", `${short(frame.cables[lowest].lowest, 4)} N`, `cable ${names[lowest]}${frame.limited ? `, minimum ${short(frame.cables[lowest].minimum, 3)} N` : ""}${delta(before && Math.min(...before.frame.cables.map((cable) => cable.lowest)))}`],
    ["First resonance", first ? `${short(first.hz, 4)} Hz` : "–", first ? `of the ${KINDS[first.kind]}${delta(before?.frame.modes[0]?.hz)}` : ""],
    ["First resonance of the platform", platform ? `${short(platform.hz, 4)} Hz` : "–", platform ? `mode ${frame.modes.indexOf(platform) + 1}${delta(ofPlatform(before?.frame)?.hz)}` : frame.modes.length ? `above the ${frame.modes.length} lowest` : ""],
    payloadFact(delta),
    ["Stiffness in the softest direction", frame.stable === undefined ? "rigid" : `${short(frame.minStiffness, 4)} N/m`, `${frame.stable === false ? "unstable" : ""}${delta(before?.frame.minStiffness)}`],
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

function payloadFact(delta) {
  const { before, settled: { payload }, view } = page;
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
  return ["Maximum payload", `${short(maximum.payload_kg, 4)} kg`, `${by}${delta(before?.payload?.maximum?.payload_kg)}`];
}

function showWarnings() {
  const { settled } = page;
  const warnings = settled.statics?.warnings ?? [];
  const all = settled.reason ? [settled.reason] : warnings;
  $("warnings").replaceChildren(...(all.length ? all : ["No remarks on this state."]).map((text) => element("li", {}, text)));
}

export function listen() {
  on("frame", showKey);
  on("remember", showKey);
  on("settled", showWarnings);
  on("settled", showKey);
}
