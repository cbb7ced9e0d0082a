// Comparison of the cable models, on demand.

import { statics } from "./computation.js";
import { Cancelled, Job } from "./engine.js";
import { $, element, short } from "./format.js";
import { put } from "./messages.js";
import { on, page } from "./store.js";

const job = new Job();
let comparing = false;

async function compare() {
  const button = $("compare-run");
  if (comparing) {
    job.cancel();
    return;
  }
  if (!page.frame) {
    $("compare").replaceChildren(element("p", { class: "soft" }, `There is nothing to compare: ${page.reason}.`));
    return;
  }
  comparing = true;
  button.textContent = "Cancel";
  const begin = performance.now();
  const clock = setInterval(() => put($("compare-state"), `${((performance.now() - begin) / 1000).toFixed(0)} s`), 500);
  try {
    const request = { command: "compare", ...statics(), below_hz: Number((page.frame.belowHz || 20).toPrecision(4)) };
    const text = await job.run(1, async ([worker]) => (await worker.call("answer", { request })).text);
    show(JSON.parse(text));
  } catch (error) {
    const text = error instanceof Cancelled ? "Cancelled." : error.message;
    $("compare").replaceChildren(element("p", { class: "soft" }, text));
  }
  clearInterval(clock);
  put($("compare-state"), "");
  button.textContent = "Compare the models";
  comparing = false;
}

function show(found) {
  const rows = found.models.map((model) =>
    element(
      "tr",
      {},
      element("td", { class: "left" }, model.cable_model),
      element("td", {}, short(model.modes[0]?.frequency_hz, 5)),
      element("td", {}, String(model.missed ?? "")),
      element("td", {}, short(100 * model.largest_difference, 3)),
      element("td", {}, short(model.first_wrong_hz, 4)),
    ),
  );
  const heads = [
    ["Model", "", "left"],
    ["First", "[Hz]"],
    ["Missed", "modes"],
    ["Largest error", "[%]"],
    ["Wrong from", "[Hz]"],
  ];
  const head = heads.map(([text, unit, kind]) => element("th", { class: kind }, text, element("span", {}, unit)));
  $("compare").replaceChildren(
    element("p", { class: "advice" }, found.advice?.text ?? ""),
    element(
      "div",
      { class: "table" },
      element("table", {}, element("thead", {}, element("tr", {}, ...head)), element("tbody", {}, ...rows)),
    ),
  );
}

export function listen() {
  on("empty", () => {
    job.cancel();
    $("compare").replaceChildren();
  });
  on("outdated", () => {
    job.cancel();
    if ($("compare").childElementCount > 0) {
      $("compare").replaceChildren(element("p", { class: "soft" }, "The state has changed: compare again."));
    }
  });
  $("compare-run").addEventListener("click", compare);
}
