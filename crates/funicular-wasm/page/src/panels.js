// Small curves of one measure beside each other, with a common scale: along the way of the platform, and along x, y, z.

import { escaped, short, tick } from "./format.js";
import { ticks } from "./figures.js";

const TOP = 18,
  BOTTOM = 20,
  LEFT = 40,
  GAP = 14,
  HIGH = 86;
const TICKS = 4; // of the values

/** Path through points, broken where a value is missing. */
function pathOf(points) {
  let pen = "M";
  return points
    .map(([x, y]) => {
      if (!Number.isFinite(y)) {
        pen = "M";
        return "";
      }
      const step = `${pen}${x.toFixed(1)} ${y.toFixed(1)}`;
      pen = "L";
      return step;
    })
    .join("");
}

/** Common range of values with a margin; null without values. */
export function rangeOfValues(panels) {
  const all = panels
    .flatMap(({ points, here }) => [...(points ?? []), ...(here ? [here] : [])])
    .map(([, value]) => value);
  const finite = all.filter(Number.isFinite);
  if (finite.length === 0) {
    return null;
  }
  const [low, high] = [finite.reduce((a, b) => Math.min(a, b)), finite.reduce((a, b) => Math.max(a, b))];
  const margin = high > low ? 0.06 * (high - low) : 0.05 * Math.max(Math.abs(high), 1e-9);
  return [low - margin, high + margin];
}

/**
 * Curves side by side, as the text of an SVG.
 * @param {object} of `label`, `unit`, `width`, `columns`, `panels`: list of `title`, `points` (list of [place, value],
 *   NaN where there is none; null if they are not known), `gaps` (true: poses without a value are grey), `range` of the
 *   places, `here` ([place, value] or null), `waiting` (words instead of points)
 */
export function panels({ label, unit, width, columns, panels: list }) {
  const range = rangeOfValues(list);
  const rows = Math.ceil(list.length / columns);
  const wide = (width - LEFT - GAP * columns) / columns;
  const height = rows * (TOP + HIGH + BOTTOM);
  const parts = [];
  const text = (x, y, words, anchor) =>
    parts.push(`<text x="${x.toFixed(1)}" y="${y.toFixed(1)}" text-anchor="${anchor}">${escaped(words)}</text>`);
  list.forEach((panel, i) => {
    const left = LEFT + (i % columns) * (wide + GAP);
    const top = TOP + Math.floor(i / columns) * (TOP + HIGH + BOTTOM);
    drawPanel(parts, text, { ...panel, left, top, wide, values: range, isFirst: i % columns === 0 });
  });
  const told = list.map(describe).filter(Boolean).join("; ");
  return (
    `<svg xmlns="http://www.w3.org/2000/svg" class="figure" role="img" width="${width}" height="${height}"` +
    ` viewBox="0 0 ${width} ${height}" aria-label="${escaped(`${label} [${unit}]: ${told || "no values yet"}`)}">` +
    `${parts.join("")}</svg>`
  );
}

function drawPanel(parts, text, { title, points, gaps, range, here, waiting, left, top, wide, values, isFirst }) {
  const x = (at) => left + (wide * (at - range[0])) / (range[1] - range[0] || 1);
  const y = (value) => (values ? top + (HIGH * (values[1] - value)) / (values[1] - values[0]) : NaN);
  text(left, top - 6, title, "start");
  if (points && gaps) {
    // Where there is no equilibrium, the ground is grey, half a step around each pose.
    const step = points.length > 1 ? (points[1][0] - points[0][0]) / 2 : 0;
    points
      .filter(([, value]) => !Number.isFinite(value))
      .forEach(([at]) => {
        const [from, to] = [Math.max(range[0], at - step), Math.min(range[1], at + step)].map(x);
        const wide = (to - from + 0.3).toFixed(1);
        parts.push(`<rect class="none" x="${from.toFixed(1)}" y="${top}" width="${wide}" height="${HIGH}"/>`);
      });
  }
  if (values) {
    for (const value of ticks(values[0], values[1], TICKS)) {
      const at = y(value).toFixed(1);
      parts.push(`<line class="grid" x1="${left}" y1="${at}" x2="${(left + wide).toFixed(1)}" y2="${at}"/>`);
      if (isFirst) {
        text(left - 5, y(value) + 4, tick(value), "end");
      }
    }
  }
  for (const at of ticks(range[0], range[1], Math.max(2, Math.floor(wide / 55)))) {
    text(x(at), top + HIGH + 13, tick(at), "middle");
  }
  parts.push(`<rect class="frame" x="${left.toFixed(1)}" y="${top}" width="${wide.toFixed(1)}" height="${HIGH}"/>`);
  if (points) {
    parts.push(`<path class="now" d="${pathOf(points.map(([at, value]) => [x(at), y(value)]))}"/>`);
  } else if (waiting) {
    text(left + wide / 2, top + HIGH / 2, waiting, "middle");
  }
  if (here) {
    const at = x(here[0]).toFixed(1);
    parts.push(`<line class="here-line" x1="${at}" x2="${at}" y1="${top}" y2="${top + HIGH}"/>`);
    if (Number.isFinite(here[1]) && values) {
      parts.push(`<circle class="here-dot" cx="${at}" cy="${y(here[1]).toFixed(1)}" r="3.5"/>`);
    }
  }
}

/** What a screen reader says of a panel; nothing without points. */
function describe({ title, points }) {
  const finite = (points ?? []).filter(([, value]) => Number.isFinite(value));
  if (finite.length === 0) {
    return points?.length ? `${title}: no equilibrium` : "";
  }
  const values = finite.map(([, value]) => value);
  const [low, high] = [Math.min(...values), Math.max(...values)];
  const without = points.length - finite.length;
  const rest = without ? `, ${without} of ${points.length} poses without` : "";
  return `${title}: ${short(low, 3)} to ${short(high, 3)}${rest}`;
}
