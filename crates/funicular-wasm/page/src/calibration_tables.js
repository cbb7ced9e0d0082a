// Tables of a calibration: rows with their residuals and boxes, values, poses to measure next.

import { element, short } from "./format.js";

const cell = (text, attributes = {}) => element("td", attributes, text);

/** Table in a box that scrolls. `heads`: texts of the columns, or objects with one that is `left` or `narrow`. */
function table(heads, rows, { tall = false, id } = {}) {
  const nameOf = (head) => head.left ?? head.narrow ?? head;
  const classOf = (head) => (head.left !== undefined ? "left" : head.narrow && "narrow");
  const head = element("tr", {}, ...heads.map((of) => element("th", { class: classOf(of) }, nameOf(of))));
  const body = element("table", { id }, element("thead", {}, head), element("tbody", {}, ...rows));
  const name = { tabindex: "0", role: "region", "aria-label": heads.map(nameOf).filter(Boolean).join(", ") };
  return element("div", { class: tall ? "table tall" : "table", ...name }, body);
}

/**
 * Rows of the readings: a box that leaves a row out, its residual of every cable, and what the fit would gain.
 * @param {object} of `numbers` of all rows, `rows` of the answer, `cables` (names), `isLeftOut(number)`,
 *   `change(number, isLeftOut)`
 */
export function rowsTable({ numbers, rows, cables, isLeftOut, change }) {
  const row = (number) => {
    const found = rows.find((of) => of.row === number);
    const residual = (cable) => found?.residuals.find((of) => of.cable === cable)?.residual_m;
    const box = element("input", { type: "checkbox", "data-row": number, "aria-label": `Row ${number}` });
    box.checked = !isLeftOut(number);
    box.addEventListener("change", () => change(number, !box.checked));
    const drop = found ? short(found.chi2_drop, 3) : "–";
    const isOutlier = Boolean(found?.outlier);
    return element(
      "tr",
      { class: isOutlier ? "beyond" : isLeftOut(number) ? "stale" : null },
      element("td", { class: "left" }, element("label", {}, box, ` ${number}`)),
      ...cables.map((cable) => cell(short(1000 * (residual(cable) ?? NaN), 3))),
      cell(isOutlier ? `${drop} outlier` : drop),
    );
  };
  const heads = [{ left: "row" }, ...cables.map((name) => `${name} [mm]`), { narrow: "χ² falls by without it" }];
  return table(heads, numbers.map(row), { tall: true, id: "calibrate-rows" });
}

/** Values: `path`, `unit`, `start`, `value`, `deviation`, `note`. */
export function valuesTable(values) {
  const row = ({ path, unit, start, value, deviation, note }) =>
    element(
      "tr",
      {},
      cell(path, { class: "left name" }),
      cell(short(start, 6)),
      cell(short(value, 6)),
      cell(short(deviation, 3)),
      cell(unit, { class: "left" }),
      cell(note, { class: "left" }),
    );
  const heads = [{ left: "value" }, "file", "calibrated", "±", { left: "unit" }, { left: "" }];
  return table(heads, values.map(row), { tall: true, id: "calibrate-values" });
}

/** Proposed poses of an answer. */
export function proposalsTable(proposals) {
  const row = (of) =>
    element(
      "tr",
      {},
      cell(String(of.number)),
      cell(of.position_m.map((value) => short(value, 4)).join(", ")),
      cell(of.total_m === undefined ? "" : short(1000 * of.total_m, 4)),
      cell(of.largest_m === undefined ? "" : short(1000 * of.largest_m, 3)),
      cell(of.largest_of, { class: "left" }),
    );
  const heads = ["next", "position [m]", { narrow: "all then ± [mm]" }, { narrow: "largest ± [mm]" }, { left: "of" }];
  return table(heads, proposals.map(row), { id: "calibrate-proposals" });
}
