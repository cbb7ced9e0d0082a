// Figures as SVG: frequency response and slice of the workspace.

import { escaped, short, tick } from "./format.js";

/** Ticks of a linear axis: about `count` round numbers. */
export function ticks(low, high, count) {
  const raw = (high - low) / Math.max(1, count);
  const power = 10 ** Math.floor(Math.log10(raw));
  const step = [1, 2, 5, 10].map((factor) => factor * power).find((size) => size >= raw * 0.999);
  const first = Math.ceil(low / step - 1e-9);
  const length = Math.floor(high / step + 1e-9) - first + 1;
  return Array.from({ length }, (_, i) => Number(((first + i) * step).toPrecision(12)));
}

const path = (points) => points.map(([x, y], i) => `${i ? "L" : "M"}${x.toFixed(1)} ${y.toFixed(1)}`).join("");

/** Figure of its parts. `told`: what a screen reader says; `data`: further attributes, each after a space. */
const figure = ({ told, data = "", width, height, parts }) =>
  `<svg xmlns="http://www.w3.org/2000/svg" class="figure" role="img" aria-label="${escaped(told)}"${data}` +
  ` width="${width}" height="${height}" viewBox="0 0 ${width} ${height}">${parts.join("")}</svg>`;

/**
 * Frequency response: magnitude (logarithmic) and phase.
 * @param {object} of `curves` (list of `{numbers, class}`: frequency, real, imaginary; the last is the present one),
 *   `peaks`, `modes` [Hz], `unit`, `log` (axis of frequencies), `width`
 */
export function response({ curves, peaks, modes, unit, title, log, width }) {
  const left = 58,
    right = 10,
    top = 16,
    high = 168,
    gap = 20,
    low = 74,
    bottom = 34;
  const height = top + high + gap + low + bottom;
  const present = curves.at(-1).numbers;
  const count = present.length / 3;
  const [from, to] = [present[0], present[3 * (count - 1)]];
  const inside = width - left - right;
  const scale = log ? (hz) => Math.log(hz / from) / Math.log(to / from) : (hz) => (hz - from) / (to - from);
  const x = (hz) => left + inside * scale(hz);

  // Range of the magnitudes, at most eight decades.
  const magnitudes = curves.map(({ numbers }) =>
    Array.from({ length: numbers.length / 3 }, (_, i) => Math.hypot(numbers[3 * i + 1], numbers[3 * i + 2])),
  );
  const positive = magnitudes.flat().filter((value) => value > 0);
  const most = Math.ceil(Math.log10(Math.max(...finite(positive, Math.max))) + 0.05);
  const least = Math.max(most - 8, Math.floor(Math.log10(Math.min(...finite(positive, Math.min)))));
  const y = (value) => top + (high * (most - Math.max(Math.log10(value), least))) / Math.max(1, most - least);
  const yPhase = (degrees) => top + high + gap + (low * (180 - degrees)) / 360;

  const parts = [];
  const line = (x1, y1, x2, y2, kind) =>
    parts.push(
      `<line x1="${x1.toFixed(1)}" y1="${y1.toFixed(1)}" x2="${x2.toFixed(1)}" y2="${y2.toFixed(1)}" class="${kind}"/>`,
    );
  const text = (at, down, words, anchor = "end") =>
    parts.push(`<text x="${at.toFixed(1)}" y="${down.toFixed(1)}" text-anchor="${anchor}">${words}</text>`);

  // Axes.
  const decades = Array.from({ length: 8 }, (_, k) => [1, 2, 5].map((factor) => factor * 10 ** (k - 4))).flat();
  const ofHz = log
    ? decades.filter((hz) => hz >= from * 0.999 && hz <= to * 1.001)
    : ticks(from, to, Math.max(3, Math.floor(inside / 60)));
  for (const hz of ofHz) {
    line(x(hz), top, x(hz), top + high, "grid");
    line(x(hz), top + high + gap, x(hz), top + high + gap + low, "grid");
    text(x(hz), height - bottom + 14, tick(hz), "middle");
  }
  const every = Math.ceil((most - least) / 6);
  for (let power = least; power <= most; power += every) {
    line(left, y(10 ** power), width - right, y(10 ** power), "grid");
    text(left - 6, y(10 ** power) + 4, `10<tspan dy="-5" font-size="8">${String(power).replace("-", "−")}</tspan>`);
  }
  for (const degrees of [-180, 0, 180]) {
    line(left, yPhase(degrees), width - right, yPhase(degrees), "grid");
    text(left - 6, yPhase(degrees) + 4, `${String(degrees).replace("-", "−")}°`);
  }
  text(left, 10, `${escaped(title)} [${escaped(unit)}]`, "start");
  text(left + inside / 2, height - 4, "frequency [Hz]", "middle");

  // Natural frequencies, curves, peaks.
  for (const hz of modes.filter((hz) => hz >= from && hz <= to)) {
    line(x(hz), top + high, x(hz), top + high + 7, "mode");
  }
  curves.forEach(({ numbers, kind }, c) => {
    const points = magnitudes[c].map((value, i) => [x(numbers[3 * i]), y(value || 10 ** least)]);
    parts.push(`<path d="${path(points)}" class="${kind}"/>`);
    let before = null;
    const phases = magnitudes[c].map((_, i) => {
      const degrees = (Math.atan2(numbers[3 * i + 2], numbers[3 * i + 1]) * 180) / Math.PI;
      const jump = before !== null && Math.abs(degrees - before) > 180;
      before = degrees;
      return `${i === 0 || jump ? "M" : "L"}${x(numbers[3 * i]).toFixed(1)} ${yPhase(degrees).toFixed(1)}`;
    });
    parts.push(`<path d="${phases.join("")}" class="${kind}"/>`);
  });
  const highest = [...peaks].sort((a, b) => b.magnitude - a.magnitude).slice(0, 4);
  const named = [];
  for (const { hz, magnitude } of highest) {
    parts.push(`<circle cx="${x(hz).toFixed(1)}" cy="${y(magnitude).toFixed(1)}" r="3" class="peak"/>`);
    const side = x(hz) > width - 70 ? "end" : "start";
    if (named.some((other) => Math.abs(other - x(hz)) < 46)) {
      continue;
    }
    named.push(x(hz));
    text(x(hz) + (side === "end" ? -5 : 5), Math.max(top + 9, y(magnitude) - 2), short(hz, 4), side);
  }
  const summary = highest.length
    ? `Highest peak ${short(highest[0].magnitude)} ${unit} at ${short(highest[0].hz)} hertz`
    : "No peak in this range";
  return figure({ told: `Frequency response. ${summary}`, width, height, parts });
}

/**
 * Record in time.
 * @param {object} of `curves` (list of {times, values, kind}; the last is the present one), `label`, `factor` (of the
 *   values), `width`
 */
export function history({ curves, label, factor, width }) {
  const left = 58,
    right = 10,
    top = 16,
    high = 120,
    bottom = 34;
  const height = top + high + bottom;
  const inside = width - left - right;
  const end = Math.max(...curves.map(({ times }) => times.at(-1)));
  const extremes = curves.flatMap(({ values }) => [
    values.reduce((a, b) => Math.min(a, b)),
    values.reduce((a, b) => Math.max(a, b)),
  ]);
  const most = 1.05 * factor * Math.max(...extremes.map(Math.abs), 1e-300);
  const x = (t) => left + (inside * t) / end;
  const y = (value) => top + (high * (most - value)) / (2 * most);
  const parts = [];
  for (const t of ticks(0, end, Math.max(3, Math.floor(inside / 60)))) {
    const at = x(t).toFixed(1);
    parts.push(
      `<line class="grid" x1="${at}" y1="${top}" x2="${at}" y2="${top + high}"/>` +
        `<text x="${at}" y="${top + high + 14}" text-anchor="middle">${tick(t)}</text>`,
    );
  }
  for (const value of ticks(-most, most, 5)) {
    const at = y(value).toFixed(1);
    parts.push(
      `<line class="grid" x1="${left}" y1="${at}" x2="${width - right}" y2="${at}"/>` +
        `<text x="${left - 6}" y="${(y(value) + 4).toFixed(1)}" text-anchor="end">${tick(value)}</text>`,
    );
  }
  for (const { times, values, kind } of curves) {
    parts.push(`<path class="${kind}" d="${path(Array.from(times, (t, i) => [x(t), y(factor * values[i])]))}"/>`);
  }
  const present = curves.at(-1);
  parts.push(
    `<text x="${left}" y="10">${escaped(label)}</text>` +
      `<text x="${left + inside / 2}" y="${height - 4}" text-anchor="middle">time [s]</text>`,
  );
  parts.push(`<line class="here" data-clock x1="${left}" x2="${left}" y1="${top}" y2="${top + high}"/>`);
  const told = `${label} from ${short(factor * present.values[0])} at the beginning, over ${short(end, 3)} seconds`;
  const data = ` data-left="${left}" data-inside="${inside}" data-end="${end}"`;
  return figure({ told, data, width, height, parts });
}

/**
 * Effects as bars from a common zero, the largest first. Elements of HTML, so that long names break into lines.
 * @param {object} of `rows` (list of {name, path, value, past}), `label`, `unit`
 */
export function bars({ rows, label, unit }) {
  const most = Math.max(...rows.flatMap(({ value, past }) => [Math.abs(value), Math.abs(past ?? 0)]));
  const row = ({ name, path, value, past }) => {
    const place = (50 + (50 * past) / most).toFixed(1);
    const mark =
      past === undefined ? "" : `<b class="past" title="before: ${short(past, 3)} ${unit}" style="left:${place}%"></b>`;
    const words = `${value < 0 ? "−" : "+"}${short(Math.abs(value), 3)} ${unit}`;
    const [from, wide] = [value < 0 ? 50 + (50 * value) / most : 50, (50 * Math.abs(value)) / most];
    const told = escaped(`${name}: ${words}. Add a slider`);
    const breaking = escaped(name).replaceAll(".", ".<wbr>").replaceAll("_", "_<wbr>");
    const extent = `left:${from.toFixed(1)}%;width:${wide.toFixed(1)}%`;
    return (
      `<li data-path="${escaped(path)}"><button aria-label="${told}">${breaking}</button>` +
      `<span class="bar-track"><i class="${value < 0 ? "less" : "more"}" style="${extent}"></i>${mark}</span>` +
      `<b>${escaped(words)}</b></li>`
    );
  };
  return (
    `<p class="soft">${escaped(label)}</p>` +
    `<ul class="bars" aria-label="${escaped(label)}">${rows.map(row).join("")}</ul>`
  );
}

/** Extremum as a list of one, without spreading long lists into arguments. */
const finite = (values, of) => [values.length ? values.reduce((a, b) => of(a, b)) : 1];

const VIRIDIS = ["#440154", "#46327e", "#365c8d", "#277f8e", "#1fa187", "#4ac16d", "#a0da39", "#fde725"];

/** Red, green and blue, 0 to 255, of a fraction from 0 to 1 in a map. */
export function mapNumbers(fraction) {
  const at = Math.max(0, Math.min(1, fraction)) * (VIRIDIS.length - 1);
  const low = Math.min(VIRIDIS.length - 2, Math.floor(at));
  const parts = [VIRIDIS[low], VIRIDIS[low + 1]].map((hex) => [1, 3, 5].map((k) => parseInt(hex.slice(k, k + 2), 16)));
  return parts[0].map((value, k) => Math.round(value + (parts[1][k] - value) * (at - low)));
}

/** Colour of a fraction from 0 to 1 in a map. */
const mapColor = (fraction) => `rgb(${mapNumbers(fraction).join(",")})`;

/**
 * Slice of the workspace: cells with a value or without an equilibrium.
 * @param {object} of `axes` (names), `ranges` ([low, high] of both axes), `cells` (list of {u, v, du, dv, value}),
 *   `here` (u, v of the platform), `label`, `unit`, `width`
 */
export function slice({ axes, ranges, cells, here, label, unit, width }) {
  const left = 44,
    right = 12,
    top = 8,
    bottom = 76;
  const inside = width - left - right;
  const [[u0, u1], [v0, v1]] = ranges;
  const high = Math.min(420, Math.max(120, (inside * (v1 - v0)) / (u1 - u0)));
  const height = top + high + bottom;
  const x = (u) => left + (inside * (u - u0)) / (u1 - u0);
  const y = (v) => top + (high * (v1 - v)) / (v1 - v0);
  const values = cells.map((cell) => cell.value).filter(Number.isFinite);
  const [least, most] = [finite(values, Math.min)[0], finite(values, Math.max)[0]];
  const parts = [];
  for (const { u, v, du, dv, value } of cells) {
    const fraction = most > least ? (value - least) / (most - least) : 0.5;
    const color = Number.isFinite(value) ? mapColor(fraction) : "var(--none)";
    const [x0, x1] = [Math.max(u0, u - du / 2), Math.min(u1, u + du / 2)].map(x);
    const [y0, y1] = [Math.min(v1, v + dv / 2), Math.max(v0, v - dv / 2)].map(y);
    parts.push(
      `<rect x="${x0.toFixed(2)}" y="${y0.toFixed(2)}" width="${(x1 - x0 + 0.3).toFixed(2)}"` +
        ` height="${(y1 - y0 + 0.3).toFixed(2)}" fill="${color}" shape-rendering="crispEdges"/>`,
    );
  }
  for (const u of ticks(u0, u1, 6)) {
    const at = x(u).toFixed(1);
    parts.push(
      `<line class="axis" x1="${at}" y1="${top + high}" x2="${at}" y2="${top + high + 4}"/>` +
        `<text x="${at}" y="${top + high + 16}" text-anchor="middle">${tick(u)}</text>`,
    );
  }
  for (const v of ticks(v0, v1, 5)) {
    const at = y(v).toFixed(1);
    parts.push(
      `<line class="axis" x1="${left - 4}" y1="${at}" x2="${left}" y2="${at}"/>` +
        `<text x="${left - 7}" y="${(y(v) + 4).toFixed(1)}" text-anchor="end">${tick(v)}</text>`,
    );
  }
  parts.push(`<rect class="frame" x="${left}" y="${top}" width="${inside}" height="${high}"/>`);
  parts.push(
    `<text x="${left + inside / 2}" y="${top + high + 31}" text-anchor="middle">${axes[0]} [m]</text>` +
      `<text transform="translate(11 ${top + high / 2}) rotate(-90)" text-anchor="middle">${axes[1]} [m]</text>`,
  );
  const cross = ([u, v]) => `M${x(u) - 7} ${y(v)}H${x(u) + 7}M${x(u)} ${y(v) - 7}V${y(v) + 7}`;
  if (here) {
    parts.push(`<path class="here" d="${cross(here)}"/>`);
  }
  // Scale.
  const bar = top + high + 42;
  for (let i = 0; i < 60; i += 1) {
    parts.push(
      `<rect x="${(left + (inside * i) / 60).toFixed(1)}" y="${bar}" width="${(inside / 60 + 0.4).toFixed(1)}"` +
        ` height="9" fill="${mapColor(i / 59)}"/>`,
    );
  }
  const unitText = unit && unit !== "1" ? ` ${unit}` : "";
  if (values.length) {
    const ofUnit = escaped(unitText);
    parts.push(
      `<text x="${left}" y="${bar + 22}">${short(least)}${ofUnit}</text>` +
        `<text x="${left + inside}" y="${bar + 22}" text-anchor="end">${short(most)}${ofUnit}</text>`,
    );
  }
  parts.push(`<text x="${left + inside / 2}" y="${bar + 22}" text-anchor="middle">${escaped(label)}</text>`);
  const held = values.length;
  const span = held ? `, from ${short(least)} to ${short(most)}${unitText}` : "";
  const told = `${label} at ${cells.length} poses; ${held} of them have a value${span}`;
  const svg = figure({ told, width, height, parts });
  const at = (px, py) => [u0 + ((px - left) / inside) * (u1 - u0), v1 - ((py - top) / high) * (v1 - v0)];
  return { svg, at, cross };
}

/** Symbols' colours of the cables in a figure of residuals, for any colour vision. */
const CABLE_COLORS = ["#0072b2", "#d55e00", "#009e73", "#cc79a7", "#e69f00", "#56b4e9", "#7a7a7a", "#8a3ffc"];

/** Residuals of every cable over the rows: `rows` of a calibration, `cables` (names), `width`. */
export function residuals({ rows, cables, width }) {
  const [left, right, top, high] = [44, 10, 18, 120];
  const inside = width - left - right;
  const places = rows.flatMap(({ row, residuals: list }) =>
    list.map(({ cable, residual_m: residual }) => ({ row, cable: cables.indexOf(cable), mm: 1000 * residual })),
  );
  const most = Math.max(...places.map(({ mm }) => Math.abs(mm)), 1e-9);
  const [first, last] = [Math.min(...rows.map(({ row }) => row)), Math.max(...rows.map(({ row }) => row))];
  const x = (row) => left + inside * (last > first ? 0.02 + (0.96 * (row - first)) / (last - first) : 0.5);
  const y = (mm) => top + (high * (most - mm)) / (2 * most);
  const parts = ticks(-most, most, 4).map(
    (mm) =>
      `<line class="grid" x1="${left}" y1="${y(mm).toFixed(1)}" x2="${width - right}" y2="${y(mm).toFixed(1)}"/>` +
      `<text x="${left - 5}" y="${(y(mm) + 4).toFixed(1)}" text-anchor="end">${tick(mm)}</text>`,
  );
  const named = ticks(first, Math.max(last, first + 1), 8).filter((row) => Number.isInteger(row) && row <= last);
  parts.push(
    ...named.map((row) => `<text x="${x(row).toFixed(1)}" y="${top + high + 14}" text-anchor="middle">${row}</text>`),
    ...places.map(({ row, cable, mm }) => {
      const told = `${cables[cable]}, row ${row}: ${short(mm, 3)} mm`;
      const color = CABLE_COLORS[cable % CABLE_COLORS.length];
      const at = `cx="${x(row).toFixed(1)}" cy="${y(mm).toFixed(1)}"`;
      return `<circle ${at} r="3" fill="${color}"><title>${escaped(told)}</title></circle>`;
    }),
    `<text x="${left}" y="11">residual [mm]</text>`,
    `<text x="${left + inside / 2}" y="${top + high + 28}" text-anchor="middle">row</text>`,
  );
  const told = `Residuals of ${places.length} readings in ${rows.length} rows, at most ${short(most, 3)} mm`;
  return figure({ told, width, height: top + high + 32, parts });
}

/** Moves the line of the present time in the figure that an element begins with. */
export function moveClock(holder, t) {
  const figure = holder.firstElementChild;
  const line = figure?.querySelector("[data-clock]");
  if (line) {
    const { left, inside, end } = figure.dataset;
    const at = (Number(left) + (Number(inside) * t) / Number(end)).toFixed(1);
    line.setAttribute("x1", at);
    line.setAttribute("x2", at);
  }
}
