// Reach of the platform: how far it may go from where it is until the conditions of its workspace end, along rays that
// the core follows in a worker of its own. While the platform is dragged few rays follow it; when it rests, more come.

import { requestOf } from "./computation.js";
import { Cancelled, Engine } from "./engine.js";
import { $ } from "./format.js";
import { put } from "./messages.js";
import { raysOf, words } from "./reach_words.js";
import { on, page } from "./store.js";

const RESTED_LEVEL = 3; // 258 rays in space, 64 in a plane: with 66 the net is coarse
const DRAGGED_LEVEL = 1; // 18 rays in space, 16 in a plane
const LONG_MS = 1000; // a level that takes longer is the last: the next one takes about four times as long
const SLOW_MS = 60; // a level that takes longer is left out while the platform is dragged

let engine = null;
let robot = ""; // request of the robot that the worker has, as a text
let wanted = null; // `pose` whose rays are not followed yet, position and quaternion, and their last `level`
let running = false;
let atLevel = 0; // that the worker follows
let highest = DRAGGED_LEVEL; // level while the platform is dragged

const isOn = () => $("reach").checked;

function clear(text = "") {
  page.view?.reach.set(null);
  page.view?.draw();
  put($("reach-note"), text);
  delete $("reach-note").dataset.rays;
}

/** Follows the rays of the latest pose, coarse first; a pose that comes meanwhile ends those of the one before. */
async function follow() {
  if (running) {
    return;
  }
  running = true;
  try {
    while (wanted && isOn()) {
      const next = wanted;
      wanted = null;
      await raysFrom(next);
    }
  } catch (error) {
    if (!(error instanceof Cancelled)) {
      robot = "";
      clear(error.message);
    }
  }
  running = false;
  if (wanted && isOn()) {
    follow(); // what came while the worker ended
  }
}

async function raysFrom({ pose, level: last }) {
  engine ??= new Engine();
  const request = requestOf();
  const text = JSON.stringify(request);
  if (robot !== text) {
    robot = "";
    await engine.call("robot", { request });
    robot = text;
  }
  const from = pose.slice(0, 3);
  let rays = [];
  delete $("reach-note").dataset.done;
  for (let level = 0; level <= last && isOn(); level += 1) {
    atLevel = level;
    const { numbers, about, milliseconds } = await engine.call("reach", { pose, level });
    if (level <= DRAGGED_LEVEL) {
      highest = fitting(level, milliseconds);
    }
    rays = [...rays, ...raysOf(numbers)];
    const { conditions, is_in_box: isInBox, triangles } = about;
    // Each pose of a drag gets the rays of its level, so that the net does not flicker; then the next pose counts.
    if (level >= Math.min(highest, last) || rays.length === 0) {
      show({ from, rays, milliseconds, conditions, isInBox, triangles });
      if (wanted !== null || rays.length === 0 || milliseconds > LONG_MS) {
        break;
      }
    }
  }
  $("reach-note").dataset.done = last === RESTED_LEVEL ? "rested" : "dragged";
}

/** Level of a drag after a level has taken so long; each has about twice the rays of the one before. */
function fitting(level, milliseconds) {
  if (milliseconds > SLOW_MS && level > 0) {
    return level - 1;
  }
  return level === highest && milliseconds < SLOW_MS / 4 ? Math.min(DRAGGED_LEVEL, highest + 1) : highest;
}

function show(found) {
  const { view } = page;
  if (!isOn() || !page.frame) {
    return;
  }
  view.reach.set(found.rays.length ? found : null);
  view.draw();
  put($("reach-note"), words(found));
  Object.assign($("reach-note").dataset, { rays: found.rays.length, milliseconds: found.milliseconds.toFixed(1) });
}

function want(level) {
  const { frame } = page;
  if (frame && isOn()) {
    wanted = { pose: [...frame.position, ...frame.quaternion], level };
    follow();
  }
}

function end() {
  engine?.end();
  [engine, robot] = [null, ""];
}

/** Listens to the platform and to the box that switches the rays on. */
export function listen() {
  on("frame", () => want(highest));
  on("rested", () => want(RESTED_LEVEL));
  // The many rays of a platform at rest do not keep the few of one that moves on waiting.
  on("outdated", () => {
    if (running && atLevel > DRAGGED_LEVEL) {
      end();
    }
  });
  on("forget", () => {
    end();
    [wanted, highest] = [null, DRAGGED_LEVEL];
    clear();
  });
  on("empty", () => {
    wanted = null;
    clear();
  });
  $("reach").addEventListener("change", () => {
    clear();
    want(RESTED_LEVEL);
  });
}
