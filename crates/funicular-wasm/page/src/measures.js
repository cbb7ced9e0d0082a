// Measures of a pose that can be drawn: as curves, as a slice of the workspace, and as the colours of the floor.

/**
 * Names and columns of the core's maps, words, and the value of a frame. A frame has no payload, which takes too long
 * for every picture. The first one is drawn until another is chosen: it is smooth, while the first resonance of the
 * platform jumps where a motion is split over two modes.
 */
export const MEASURES = [
  {
    name: "platform-frequency",
    column: "platform_frequency_hz",
    label: "Frequency of the platform, smooth",
    unit: "Hz",
    of: (frame) => frame.about.platform_frequency_hz ?? undefined,
  },
  {
    name: "first-platform-frequency",
    column: "first_platform_frequency_hz",
    label: "First resonance of the platform",
    unit: "Hz",
    of: (frame) => frame.modes[frame.first?.index]?.hz,
  },
  {
    name: "tension-max",
    column: "tension_max_n",
    label: "Highest tension",
    unit: "N",
    of: (frame) => Math.max(...frame.cables.map((cable) => cable.highest)),
  },
  {
    name: "tension-min",
    column: "tension_min_n",
    label: "Lowest tension",
    unit: "N",
    of: (frame) => Math.min(...frame.cables.map((cable) => cable.lowest)),
  },
  {
    name: "clearance",
    column: "clearance_m",
    label: "Clearance",
    unit: "m",
    // A frame of a file that says nothing of distances has none.
    of: (frame) => frame.about.clearance?.distance_m,
  },
  { name: "payload-max", column: "payload_max_kg", label: "Maximum payload", unit: "kg", of: () => undefined },
  {
    name: "stiffness-min",
    column: "stiffness_min_n_per_m",
    label: "Softest stiffness",
    unit: "N/m",
    of: (frame) => frame.minStiffness,
  },
  {
    name: "first-frequency",
    column: "first_frequency_hz",
    label: "First resonance of all",
    unit: "Hz",
    of: (frame) => frame.modes[0]?.hz,
  },
];

export const measureOf = (name) => MEASURES.find((one) => one.name === name) ?? null;

const FLAT = 0.05; // of the robot's size: anchors that spread less along an axis are in one plane
const WIDE = 0.3; // of the robot's size: half of the range along such an axis

/** Range of an axis 0 to 2 in which poses are computed, around a pose: that of the anchors. */
export function rangeOf({ box, size }, here, k) {
  const [low, high] = box.map((point) => point.toArray()[k]);
  return high - low < FLAT * size ? [here[k] - WIDE * size, here[k] + WIDE * size] : [low, high];
}

/** Axes along which the platform can move: all, or those of the plane of a planar robot. */
export const freeAxes = ({ name, normal }) => [0, 1, 2].filter((k) => name !== "planar" || Math.abs(normal[k]) < 0.99);

/** Poses of a request without its state. */
export function withoutState({ pose: _, lengths_m: __, ...rest }) {
  return rest;
}

/** Everything that values depend on, as a text, without the coordinates `free` of the position. */
export const keyOf = (request, here, free) =>
  JSON.stringify([withoutState(request), here.map((value, k) => (free.includes(k) ? null : value))]);

/** Values of a measure at poses, computed by a worker: list with NaN where there is none. */
export async function valuesAt(worker, request, measure, poses) {
  const asked = { command: "map", ...withoutState(request), quantities: [measure.name], poses };
  const { columns } = JSON.parse((await worker.call("answer", { request: asked })).text);
  return columns[measure.column].map((value) => value ?? NaN);
}

const CHUNK = 24; // poses per message: short enough that all workers end together

/**
 * Values over a grid of two axes, coarse first; each level has the points of the one before.
 * @param {Array} workers
 * @param {object} of `request`, `measure`, `axes` (two of 0 to 2), `ranges`, `here`, `levels` (intervals along the
 *   longer axis), `known` (values so far, by places; filled)
 * @param {Function} show told after each level: `columns`, `rows`, `values` by rows, `steps` of both axes
 * @param {Function} progress told the finished fraction of a level
 */
export async function sampleGrid(workers, of, show, progress = () => {}) {
  const { request, measure, axes, ranges, here, levels, known } = of;
  const spans = ranges.map(([a, b]) => b - a);
  const finest = levels.at(-1);
  const [nu, nv] = spans.map((span) => Math.max(2, Math.round((finest * span) / Math.max(...spans))));
  const place = (k, i) => ranges[k][0] + (spans[k] * i) / (k === 0 ? nu : nv);
  for (const level of levels) {
    const stride = finest / level;
    const list = (n) => Array.from({ length: Math.floor(n / stride) + 1 }, (_, i) => i * stride);
    const [us, vs] = [list(nu), list(nv)];
    const todo = vs.flatMap((j) => us.map((i) => [i, j])).filter(([i, j]) => !known.has(`${i} ${j}`));
    const total = todo.length;
    const take = async (worker) => {
      while (todo.length) {
        const chunk = todo.splice(0, CHUNK);
        const poses = chunk.map(([i, j]) => {
          const pose = [...here];
          [pose[axes[0]], pose[axes[1]]] = [place(0, i), place(1, j)];
          return pose;
        });
        const values = await valuesAt(worker, request, measure, poses);
        chunk.forEach(([i, j], k) => known.set(`${i} ${j}`, values[k]));
        progress(1 - todo.length / total);
      }
    };
    await Promise.all(workers.map(take));
    const values = vs.flatMap((j) => us.map((i) => known.get(`${i} ${j}`)));
    const steps = [(stride * spans[0]) / nu, (stride * spans[1]) / nv];
    const ends = [us, vs].map((of, k) => [place(k, of[0]), place(k, of.at(-1))]);
    show({ columns: us.length, rows: vs.length, values, steps, ends });
  }
}
