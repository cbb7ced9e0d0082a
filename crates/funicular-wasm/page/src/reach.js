// Reach of the platform: how far it may go from where it is until the conditions of its workspace end, along rays that
// the core follows in a worker of its own. While the platform is dragged few rays follow it; when it rests, more come.

import { requestOf } from "./computation.js";
import { Cancelled, Engine } from "./engine.js";
import { $ } from "./format.js";
import { put } from "./messages.js";
import { raysOf, words } from "./reach_words.js";
import { on, page } from "./store.js";

const MAX_LEVEL = 3; // 258 rays in space, 64 in a plane
const DRAGGED_LEVEL = 1; // 18 rays in space, 16 in a plane
const SLOW_MS = 60; // a level that takes longer is left out while the platform is dragged

let engine = null;
let robot = ""; // request of the robot that the worker has, as a text
let wanted = null; // pose whose rays are not followed yet: position and quaternion
let running = false;
let highest = DRAGGED_LEVEL; // level while the platform is dragged

const isOn = () => $("reach").checked;

function clear(text = "") {
  page.view?.reach.set(null);
  page.view?.draw();
  put($("reach-note"), text);
}

/** Follows the rays of the latest pose, coarse first; a pose that comes meanwhile ends those of the one before. */
async function follow() {
  if (running) {
    return;
  }
  running = true;
  try {
    while (wanted && isOn()) {
      const pose = wanted;
      wanted = null;
      await raysFrom(pose);
    }
  } catch (error) {
    if (!(error instanceof Cancelled)) {
      robot = "";
      clear(error.message);
    }
  }
  running = false;
}

async function raysFrom(pose) {
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
  const last = () => (page.view.dragging ? highest : MAX_LEVEL);
  for (let level = 0; level <= last() && wanted === null && isOn(); level += 1) {
    const { numbers, about, milliseconds } = await engine.call("reach", { pose, level });
    if (milliseconds > SLOW_MS && level <= DRAGGED_LEVEL) {
      highest = Math.max(0, level - 1);
    }
    // While the platform moves on, the rays of its last pose are drawn as soon as they are complete.
    rays = [...rays, ...raysOf(numbers)];
    if (level >= Math.min(highest, last()) || wanted === null) {
      show({ from, rays, level, milliseconds, conditions: about.conditions, isInBox: about.is_in_box });
    }
    if (rays.length === 0) {
      return;
    }
  }
}

function show(found) {
  const { view } = page;
  if (!isOn() || !page.frame) {
    return;
  }
  view.reach.set(found.rays.length ? { ...found, size: view.size } : null);
  view.draw();
  put($("reach-note"), words(found));
  Object.assign($("reach-note").dataset, { rays: found.rays.length, milliseconds: found.milliseconds.toFixed(1) });
}

function want() {
  const { frame } = page;
  if (frame && isOn()) {
    wanted = [...frame.position, ...frame.quaternion];
    follow();
  }
}

/** Listens to the platform and to the box that switches the rays on. */
export function listen() {
  on("frame", want);
  on("drag-end", want);
  on("forget", () => {
    engine?.end();
    [engine, robot, wanted, highest] = [null, "", null, DRAGGED_LEVEL];
    clear();
  });
  on("empty", () => {
    wanted = null;
    clear();
  });
  $("reach").addEventListener("change", () => {
    clear();
    want();
  });
}
