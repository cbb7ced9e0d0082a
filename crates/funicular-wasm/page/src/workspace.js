// Slice of the workspace: a quantity over two axes, computed in workers, coarse first and then finer.

import { Cancelled, Job } from "./engine.js";
import { slice } from "./figures.js";
import { $, element, short } from "./format.js";
import { freeAxes, keyOf, measureOf, MEASURES, rangeOf, sampleGrid } from "./measures.js";
import { age, put } from "./messages.js";

/** Numbers of intervals along the longer axis, one level after the other: each has the points of the one before. */
const LEVELS = [8, 16, 32, 64];
/** Cells of a level, which replace those of the level before. */
function cellsOf({ columns, values, steps: [du, dv], ends: [[u0], [v0]] }) {
  return values.map((value, at) => {
    const [i, j] = [at % columns, Math.floor(at / columns)];
    return { u: u0 + i * du, v: v0 + j * dv, du, dv, value };
  });
}

export class Workspace {
  #page;
  #job = new Job();
  #result = null;
  #before = null;
  #running = false;

  constructor(page) {
    this.#page = page;
    $("quantity").replaceChildren(...MEASURES.map(({ name, label }) => element("option", { value: name }, label)));
    $("quantity").value = "tension-max";
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
    const old = !here || keyOf(this.#page.request(), here, this.#result.indices) !== this.#result.key;
    if ($("map").classList.contains("stale") !== old) {
      age("map", old);
      put(this.note, old ? "This slice is of an earlier state: compute it again." : this.told);
    }
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
    const measure = measureOf($("quantity").value);
    const { label, unit } = measure;
    const axes = [...plane].map((axis) => "xyz".indexOf(axis));
    if (axes.some((k) => !freeAxes(about.motion).includes(k))) {
      this.#page.tell("the platform moves in another plane: choose that plane for the slice");
      return;
    }

    const ranges = axes.map((k) => rangeOf(view, here, k));
    const request = this.#page.request();
    const key = keyOf(request, here, axes);
    const told = { axes: [...plane], indices: axes, ranges, label, here, key, cells: [], unit };
    this.#result = told;
    this.#show(true);
    const of = { request, measure, axes, ranges, here, levels: LEVELS, known: new Map() };
    const show = (grid) => {
      told.cells = cellsOf(grid);
      this.#draw();
    };
    const progress = (part) => {
      $("slice-progress").value = part;
    };
    try {
      await this.#job.run(this.#page.cores, (workers) => sampleGrid(workers, of, show, progress));
    } catch (error) {
      if (!(error instanceof Cancelled)) {
        this.#page.tell(error.message);
      }
    }
    this.#show(false);
    $("map").dataset.done = String(Number($("map").dataset.done ?? 0) + 1);
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
