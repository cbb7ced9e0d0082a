// Slice of the workspace: a quantity over two axes, computed in workers, coarse first and then finer.

import { Cancelled, Job } from "./engine.js";
import { slice } from "./figures.js";
import { $, element, short } from "./format.js";
import { age, put } from "./messages.js";

/** Numbers of intervals along the longer axis, one level after the other: each has the points of the one before. */
const LEVELS = [8, 16, 32, 64];
const CHUNK = 24; // poses per message: short enough that all workers end together

const QUANTITIES = [
  ["tension-max", "tension_max_n", "Highest tension"],
  ["tension-min", "tension_min_n", "Lowest tension"],
  ["first-platform-frequency", "first_platform_frequency_hz", "First resonance of the platform"],
  ["first-frequency", "first_frequency_hz", "First resonance"],
  ["stiffness-min", "stiffness_min_n_per_m", "Minimum stiffness"],
];

export class Workspace {
  #page;
  #job = new Job();
  #result = null;
  #before = null;
  #running = false;

  constructor(page) {
    this.#page = page;
    $("quantity").replaceChildren(...QUANTITIES.map(([value, , text]) => element("option", { value }, text)));
    $("slice-run").addEventListener("click", () => (this.#running ? this.#job.cancel() : this.run()));
    $("slice").addEventListener("change", () => {
      if (this.#result) {
        this.run();
      }
    });
    $("slice").addEventListener("submit", (event) => event.preventDefault());
    $("map").addEventListener("click", (event) => this.#go(event));
    new ResizeObserver(() => this.#draw()).observe($("map"));
  }

  /** The state has changed: a computation that runs is for another state and ends. */
  outdated() {
    if (this.#running) {
      this.#job.cancel();
    }
  }

  /**
   * The platform has moved: so does its cross in the figure. The figure is of an earlier state if anything else has
   * changed than the position in its plane.
   */
  moved() {
    const cross = $("map").querySelector(".here");
    if (!cross || !this.cross) {
      return;
    }
    const here = this.#page.here();
    const at = this.#page.state().frame?.position ?? here;
    cross.setAttribute("d", at ? this.cross(this.#result.indices.map((k) => at[k])) : "");
    const old = !here || this.#keyOf(here, this.#result.indices) !== this.#result.key;
    if ($("map").classList.contains("stale") !== old) {
      age("map", old);
      put(this.note, old ? "This slice is of an earlier state: compute it again." : this.told);
    }
  }

  /** Everything that a slice depends on, as a text: the request without the position in its plane. */
  #keyOf(here, indices) {
    const { pose: _, lengths_m: __, ...rest } = this.#page.request();
    return JSON.stringify([rest, here.map((value, k) => (indices.includes(k) ? null : value))]);
  }

  /** Another robot. */
  forget() {
    this.#job.cancel();
    this.#result = this.#before = this.cross = null;
    age("map", false);
    $("map").replaceChildren();
  }

  /** Keeps the present slice to show it beside later ones. */
  remember(on) {
    this.#before = on ? this.#result : null;
    this.#draw();
  }

  async run() {
    const { about, reason, view } = this.#page.state();
    const here = about && this.#page.here();
    if (!here) {
      this.#page.tell(`There is no pose through which the slice goes: ${reason}.`, true);
      return;
    }
    const plane = $("plane").value;
    const [quantity, column, label] = QUANTITIES.find(([name]) => name === $("quantity").value);
    const axes = [...plane].map((axis) => "xyz".indexOf(axis));
    const [low, high] = view.box.map((point) => point.toArray());
    const ranges = axes.map((k) => {
      // A planar robot or a robot with all anchors in one plane: at least a part of its size.
      const flat = high[k] - low[k] < 0.05 * view.size;
      return flat ? [here[k] - 0.3 * view.size, here[k] + 0.3 * view.size] : [low[k], high[k]];
    });
    const { name, normal } = about.motion;
    if (name === "planar" && axes.some((k) => Math.abs(normal[k]) > 0.99)) {
      this.#page.tell("the platform moves in another plane: choose that plane for the slice");
      return;
    }

    const spans = ranges.map(([a, b]) => b - a);
    const counts = (level) => spans.map((span) => Math.max(2, Math.round((level * span) / Math.max(...spans))));
    const [nu, nv] = counts(LEVELS.at(-1));
    const known = new Map();
    const request = this.#page.request();
    const told = {
      axes: [plane[0], plane[1]],
      indices: axes,
      ranges,
      label,
      here,
      key: this.#keyOf(here, axes),
      cells: [],
      unit: "",
    };
    this.#result = told;
    this.#show(true);
    try {
      await this.#job.run(this.#page.cores, async (workers) => {
        for (const level of LEVELS) {
          const stride = LEVELS.at(-1) / level;
          const todo = [];
          for (let i = 0; i <= nu; i += stride) {
            for (let j = 0; j <= nv; j += stride) {
              if (!known.has(i * 1000 + j)) {
                todo.push([i, j]);
              }
            }
          }
          await this.#level(workers, todo, { known, request, quantity, column, told, nu, nv, stride, here });
        }
      });
    } catch (error) {
      if (!(error instanceof Cancelled)) {
        this.#page.tell(error.message);
      }
    }
    this.#show(false);
    $("map").dataset.done = String(Number($("map").dataset.done ?? 0) + 1);
  }

  /** Computes the points of a level; every worker takes the next chunk when it has finished one. */
  async #level(workers, todo, of) {
    const { known, request, quantity, column, told, nu, nv, stride, here } = of;
    const total = todo.length;
    const { axes } = { axes: told.indices };
    const value = (k, i) => told.ranges[k][0] + ((told.ranges[k][1] - told.ranges[k][0]) * i) / (k === 0 ? nu : nv);
    const { pose: _, lengths_m: __, ...rest } = request;
    const take = async (worker) => {
      while (todo.length) {
        const chunk = todo.splice(0, CHUNK);
        const poses = chunk.map(([i, j]) => {
          const pose = [...here];
          [pose[axes[0]], pose[axes[1]]] = [value(0, i), value(1, j)];
          return pose;
        });
        const own = { command: "map", ...rest, quantities: [quantity], poses };
        const { columns, units } = JSON.parse((await worker.call("answer", { request: own })).text);
        told.unit = units[column];
        chunk.forEach(([i, j], k) => known.set(i * 1000 + j, columns[column][k] ?? NaN));
        $("slice-progress").value = 1 - todo.length / total;
      }
    };
    await Promise.all(workers.map(take));

    // The cells of a level replace those of the level before.
    const size = [0, 1].map((k) => (stride * (told.ranges[k][1] - told.ranges[k][0])) / (k === 0 ? nu : nv));
    told.cells = [];
    for (let i = 0; i <= nu; i += stride) {
      for (let j = 0; j <= nv; j += stride) {
        told.cells.push({ u: value(0, i), v: value(1, j), du: size[0], dv: size[1], value: known.get(i * 1000 + j) });
      }
    }
    this.#draw();
  }

  #show(running) {
    this.#running = running;
    $("slice-run").textContent = running ? "Cancel" : "Compute";
    $("slice-progress").hidden = !running;
  }

  #draw() {
    const told = this.#result;
    if (!told || told.cells.length === 0) {
      return;
    }
    const place = this.#page.state().frame?.position ?? told.here;
    const here = told.indices.map((k) => place[k]);
    const width = Math.max(260, $("map").clientWidth);
    const { svg, at, cross } = slice({ ...told, here, width });
    Object.assign(this, { at, cross });
    const before = this.#before && this.#before !== told ? this.#before : null;
    const past = before ? slice({ ...before, here: null, label: `${before.label}, before`, width }).svg : "";
    $("map").innerHTML = svg + past;
    const fixed = [0, 1, 2].find((k) => !told.indices.includes(k));
    const off = `${"xyz"[fixed]} = ${short(told.here[fixed], 4)} m`;
    this.told =
      `At ${off}, with the orientation of the platform. Grey: no equilibrium within the tension limits. ` +
      "A click moves the platform there.";
    this.note = element("p", { class: "soft" }, this.told);
    $("map").append(this.note);
    age("map", false);
    this.moved();
  }

  #go(event) {
    const svg = event.target.closest("svg");
    if (!svg || !this.at || svg !== $("map").firstElementChild) {
      return;
    }
    const box = svg.getBoundingClientRect();
    const scale = svg.viewBox.baseVal.width / box.width;
    const [u, v] = this.at((event.clientX - box.left) * scale, (event.clientY - box.top) * scale);
    const pose = this.#page.here();
    const [i, j] = this.#result.indices;
    const [[u0, u1], [v0, v1]] = this.#result.ranges;
    if (!pose || u < u0 || u > u1 || v < v0 || v > v1) {
      return;
    }
    [pose[i], pose[j]] = [u, v].map(this.#page.rounded);
    this.#page.go(pose);
  }
}
