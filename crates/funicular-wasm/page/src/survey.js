// The chosen measure around the platform: along its way while it is dragged, along x, y, z through its pose, and as the
// colours of the floor, so that the workspace is seen before one leaves it. Workers compute while the platform rests.

import { holdsLengths, statics } from "./computation.js";
import { Cancelled, CORES, Job } from "./engine.js";
import { mapNumbers } from "./figures.js";
import { $, element, short } from "./format.js";
import { freeAxes, keyOf, measureOf, MEASURES, rangeOf, sampleGrid, valuesAt } from "./measures.js";
import { age, put, tell } from "./messages.js";
import { panels } from "./panels.js";
import { presentPose } from "./pose.js";
import { content, on, page } from "./store.js";

const AXIS_POINTS = 25; // per curve
const LEVELS = [6, 12, 24]; // intervals of the floor along its longer axis
const MAX_WAY = 400; // points of the way; with more, every second one goes
const DRAWN_MS = 100; // between two drawings while the platform is dragged
const NARROW = 480; // pixels: two curves side by side instead of four

const job = new Job();
let measure = MEASURES[0];
let way = { robot: null, points: [], last: null, length: 0 };
let curves = []; // of each axis: `key`, `points`
let floor = null; // `key`, `known`, `grid`

/** Request of the state, with the robot as the page has it. */
const request = () => ({ ...statics(), robot: content.robot });

/** A point of the way for each frame of one robot with one set of values. */
function extendWay() {
  const { frame } = page;
  if (way.robot !== content.robot) {
    way = { robot: content.robot, points: [], last: null, length: 0 };
  }
  const value = measure?.of(frame);
  if (way.last) {
    way.length += Math.hypot(...frame.position.map((at, k) => at - way.last[k]));
  }
  way.last = frame.position;
  const point = [way.length, value ?? NaN];
  if (way.points.at(-1)?.[0] === way.length) {
    way.points.pop();
  }
  way.points.push(point);
  if (way.points.length > MAX_WAY) {
    way.points = way.points.filter((_, i) => i % 2 === 0 || i === way.points.length - 1);
  }
}

function startWay() {
  const { frame } = page;
  way = { robot: content.robot, points: [], last: null, length: 0 };
  if (frame) {
    extendWay();
  }
}

/** Shows the curves and the floor that belong to the state; the others are hidden. */
function show() {
  age("curves", false);
  $("measure-note").hidden = !measure?.name.endsWith("platform-frequency");
  const { about, frame, view } = page;
  const here = frame && presentPose();
  if (!here || !measure) {
    $("curves").replaceChildren();
    showFloor(null);
    return;
  }
  const asked = request();
  const dot = holdsLengths() ? NaN : (measure.of(frame) ?? NaN);
  const along = freeAxes(about.motion).map((k) => {
    const known = curves.find((one) => one.axis === k && one.key === keyOf(asked, here, [k]));
    const range = rangeOf(view, here, k);
    return {
      title: `along ${"xyz"[k]} [m]`,
      points: known?.points ?? null,
      gaps: true,
      range: [Math.min(range[0], here[k]), Math.max(range[1], here[k])],
      here: [frame.position[k], dot],
      waiting: view.dragging ? "" : "…",
    };
  });
  const wayPanel = {
    title: "along the way [m]",
    points: way.points.length > 1 ? way.points : null,
    range: [0, Math.max(way.length, 0.1)],
    here: way.points.length > 1 ? way.points.at(-1) : null,
    waiting: "drag the platform",
  };
  const width = Math.max(280, $("curves").clientWidth || 600);
  const of = { label: measure.label, unit: measure.unit, width, columns: width < NARROW ? 2 : along.length + 1 };
  $("curves").innerHTML = panels({ ...of, panels: [wayPanel, ...along] });
  put($("curves-note"), heldNote());
  const isOwn = floor?.grid && floor.key === keyOf(asked, here, floor.axes) && floor.measure === measure;
  showFloor(isOwn ? floor : null);
}

const heldNote = () => (holdsLengths() ? "of poses with their tension rule, not of the held lengths" : "");

let shownFloor = null;

function showFloor(of) {
  if (shownFloor === of?.grid) {
    return;
  }
  shownFloor = of?.grid ?? null;
  const legend = $("floor-legend");
  const values = of ? of.grid.values.filter(Number.isFinite) : [];
  legend.hidden = values.length === 0;
  if (values.length === 0) {
    page.view.setPlane(null);
    return;
  }
  const [low, high] = [Math.min(...values), Math.max(...values)];
  const color = (value) =>
    Number.isFinite(value) ? mapNumbers(high > low ? (value - low) / (high - low) : 0.5) : null;
  const { columns, rows, ends, steps } = of.grid;
  const corner = (a, b) => {
    const place = [...of.base];
    place[of.axes[0]] = ends[0][a] + (a ? 0.5 : -0.5) * steps[0];
    place[of.axes[1]] = ends[1][b] + (b ? 0.5 : -0.5) * steps[1];
    return place;
  };
  const corners = [corner(0, 0), corner(1, 0), corner(1, 1), corner(0, 1)];
  page.view.setPlane({ corners, columns, rows, colors: of.grid.values.map(color) });
  const stops = [0, 0.25, 0.5, 0.75, 1].map((at) => `rgb(${mapNumbers(at).join(" ")})`).join(",");
  const ends2 = [low, high].map((value) => short(value, 3));
  legend.replaceChildren(
    element("span", {}, `${of.measure.label} at ${of.where}`),
    element(
      "span",
      { class: "scale" },
      `${ends2[0]} `,
      element("i", { style: `background:linear-gradient(90deg,${stops})` }),
      ` ${ends2[1]} ${of.measure.unit}`,
    ),
    element("span", {}, "no colour: no equilibrium"),
  );
}

let waiting = 0;

/** Draws within a tenth of a second: each picture of a drag has no time for it. Meanwhile the figures are pale. */
function showSoon() {
  age("curves", true);
  waiting ||= setTimeout(() => {
    waiting = 0;
    show();
  }, DRAWN_MS);
}

/** Computes what is missing for the present state: first the curves, then the floor. */
async function compute() {
  const { about, frame, view } = page;
  const here = frame && presentPose();
  if (!here || !measure || view.dragging) {
    return;
  }
  const asked = request();
  const own = measure;
  const axes = freeAxes(about.motion);
  try {
    await job.run(CORES, async (workers) => {
      const missing = axes.filter((k) => !curves.some((one) => one.axis === k && one.key === keyOf(asked, here, [k])));
      await Promise.all(
        missing.map(async (k, i) => {
          const [low, high] = rangeOf(view, here, k);
          const places = Array.from({ length: AXIS_POINTS }, (_, j) => low + ((high - low) * j) / (AXIS_POINTS - 1));
          const poses = places.map((at) => here.map((value, j) => (j === k ? at : value)));
          const values = await valuesAt(workers[i % workers.length], asked, own, poses);
          const points = places.map((at, j) => [at, values[j]]);
          curves = [...curves.filter((one) => one.axis !== k), { axis: k, key: keyOf(asked, here, [k]), points }];
          show();
        }),
      );
      await computeFloor(workers, { asked, here, own, axes: axes.length === 3 ? [0, 1] : axes });
    });
    $("curves").dataset.done = String(Number($("curves").dataset.done ?? 0) + 1);
  } catch (error) {
    if (!(error instanceof Cancelled)) {
      tell(error.message, true);
    }
  }
}

async function computeFloor(workers, { asked, here, own, axes }) {
  const { view } = page;
  const key = keyOf(asked, here, axes);
  if (axes.length < 2) {
    return;
  }
  if (floor?.key !== key || floor.measure !== own) {
    const off = [0, 1, 2].find((k) => !axes.includes(k));
    const base = here.slice(0, 3);
    base[off] = off === 2 ? view.ground.floor : base[off];
    const where = `${"xyz"[off]} = ${short(here[off], 4)} m`;
    floor = { key, measure: own, axes, base, where, known: new Map(), grid: null };
  }
  if (floor.complete) {
    return;
  }
  const into = floor;
  const ranges = axes.map((k) => rangeOf(view, here, k));
  const of = { request: asked, measure: own, axes, ranges, here, levels: LEVELS, known: into.known };
  await sampleGrid(workers, of, (grid) => {
    into.grid = grid;
    show();
  });
  into.complete = true;
}

function forget() {
  job.cancel();
  [curves, floor, shownFloor] = [[], null, null];
  startWay();
  $("curves").replaceChildren();
  $("floor-legend").hidden = true;
}

/** Listens to the choice of the measure and to the platform. */
export function listen() {
  const options = MEASURES.map(({ name, label, unit }) => element("option", { value: name }, `${label} [${unit}]`));
  $("measure").replaceChildren(...options, element("option", { value: "" }, "nothing"));
  $("measure").addEventListener("change", () => {
    job.cancel();
    measure = measureOf($("measure").value);
    curves = [];
    startWay();
    show();
    compute();
  });
  on("forget", forget);
  on("empty", () => {
    job.cancel();
    startWay();
    show();
  });
  on("outdated", () => job.cancel());
  on("drag-begin", startWay);
  on("frame", () => {
    extendWay();
    if (page.view.dragging) {
      showSoon();
    } else {
      show();
    }
  });
  on("platform", () => {
    extendWay();
    show();
  });
  on("rested", () => {
    show();
    compute();
  });
  new ResizeObserver(show).observe($("curves"));
}
