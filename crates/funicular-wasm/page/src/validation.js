// Every comparison with reference numbers, computed again in this browser. The module that holds them is a file beside
// the page, loaded when somebody asks for it.

import { Cancelled, Engine } from "./engine.js";
import { $, element, short } from "./format.js";
import { put } from "./messages.js";

const FILE = "funicular-validate.wasm";

let engine = null; // at work; null while nothing is computed

async function run() {
  if (engine) {
    engine.end();
    return;
  }
  if (location.protocol === "file:") {
    show(
      `The reference numbers are a file of their own, ${FILE}, which a page without a server cannot load. ` +
        "Open the page from a server, or run `funicular validate`.",
    );
    return;
  }
  const begin = performance.now();
  const seconds = () => ((performance.now() - begin) / 1000).toFixed(1);
  const clock = setInterval(() => put($("validate-state"), `${seconds()} s`), 200);
  $("validate-run").textContent = "Cancel";
  $("validate").replaceChildren();
  try {
    engine = new Engine(Promise.resolve({ address: new URL(FILE, location.href).href }));
    const { text } = await engine.call("answer", { request: { command: "validate" } });
    showFound(JSON.parse(text), seconds());
  } catch (error) {
    show(error instanceof Cancelled ? "Cancelled." : error.message);
  }
  engine?.end();
  engine = null;
  clearInterval(clock);
  put($("validate-state"), "");
  $("validate-run").textContent = "Validate";
}

const show = (text) => $("validate").replaceChildren(element("p", { class: "soft" }, text));

function showFound({ comparisons, passed, sections }, seconds) {
  const cell = (text, kind) => element("td", { class: kind }, text);
  const rows = sections.map(({ title, rows: list }) => {
    const good = list.filter(({ pass }) => pass).length;
    return element(
      "tr",
      { class: good < list.length ? "beyond" : "" },
      cell(title, "left name"),
      cell(`${good} of ${list.length}`),
    );
  });
  const worst = sections
    .flatMap(({ rows: list }) => list)
    .filter(({ pass }) => !pass)
    .map(
      (row) =>
        `${row.case}, ${row.quantity}: difference ${short(row.difference, 2)}, tolerance ${short(row.tolerance, 2)}`,
    );
  const verdict = passed === comparisons ? `All ${comparisons}` : `${passed} of ${comparisons}`;
  $("validate").replaceChildren(
    element(
      "p",
      { class: "advice" },
      `${verdict} comparisons are within their tolerance, in ${seconds} s on this computer.`,
    ),
    ...worst.map((text) => element("p", { class: "soft" }, text)),
    element(
      "div",
      { class: "table" },
      element(
        "table",
        {},
        element(
          "thead",
          {},
          element("tr", {}, element("th", { class: "left" }, "Section"), element("th", {}, "passed")),
        ),
        element("tbody", {}, ...rows),
      ),
    ),
  );
}

export const listen = () => $("validate-run").addEventListener("click", run);
