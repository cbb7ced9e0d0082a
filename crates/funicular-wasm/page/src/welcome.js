// The first ten seconds: what this is, and three things to see.

import { findFirst } from "./computation.js";
import { $, short } from "./format.js";
import { commit } from "./history.js";
import { rangeOf, freeAxes } from "./measures.js";
import { put, tell } from "./messages.js";
import { chooseMode } from "./modes.js";
import { holdLengths, presentPose, roundedLength, setLengths, setPose } from "./pose.js";
import { content, emit, on, page } from "./store.js";
import { cableName } from "./border.js";

const STEPS = 60; // of the way to the edge of the workspace
const PAUSE_MS = 16; // between them, so that the platform is seen to move
const SLACK = 0.002; // of its length, by which a cable is made longer at a time until it hangs
const SLACK_TRIES = 12;
const SAG = 0.05; // of its chord: sag from which a cable is seen to hang

let running = 0; // number of the presentation: another one, or a change of the robot, ends it

const pause = () => new Promise((done) => setTimeout(done, PAUSE_MS));

/** Moves the platform along its first free axis until it is beyond the workspace. */
async function edge() {
  const own = running;
  const pose = presentPose();
  const [k] = freeAxes(page.about.motion);
  const [low, high] = rangeOf(page.view, pose, k);
  emit("drag-begin");
  for (let at = pose[k]; own === running && !page.border && at < high + (high - low); at += (high - low) / STEPS) {
    const next = [...pose];
    next[k] = roundedLength(at);
    await setPose(next);
    await pause();
  }
  if (own === running) {
    commit();
  }
}

const hangs = ({ slack, sagRatio }) => slack === 1 || sagRatio >= SAG;

/** Holds the lengths, and makes the cable with the lowest tension longer until it hangs. */
async function slack() {
  const own = running;
  const { cables } = page.frame;
  const i = cables.reduce((best, cable, at) => (cable.lowest < cables[best].lowest ? at : best), 0);
  await holdLengths();
  const before = content.lengths[i];
  for (let k = 0; own === running && k < SLACK_TRIES && page.frame && !hangs(page.frame.cables[i]); k += 1) {
    await setLengths(content.lengths.map((length, at) => (at === i ? length * (1 + SLACK) : length)));
    await pause();
  }
  if (own !== running) {
    return;
  }
  commit();
  const cable = page.frame?.cables[i];
  const name = cableName(page.about.check.cables[i].name);
  const more = short(100 * (content.lengths[i] - before), 2);
  const longer = `${name[0].toUpperCase()}${name.slice(1)} is ${more} cm longer`;
  const seen = cable && hangs(cable);
  const held = `and hangs with ${short(cable?.tension, 2)} N: the other cables hold the platform.`;
  tell(`${longer} ${seen ? held : "and still in tension: the platform has followed it."}`, true);
}

/** Shows the first mode of the platform, or the lowest one, in motion. */
async function mode() {
  const { frame } = page;
  await findFirst(frame);
  if (page.frame === frame && frame.modes.length) {
    chooseMode(frame.first?.index ?? 0);
  }
}

const SHOWS = { edge, slack, mode };

export function listen() {
  on("robot", () => {
    const { length } = page.about.check.cables;
    put($("what"), `A platform that hangs on ${length} cable${length === 1 ? "" : "s"}.`);
  });
  on("forget", () => {
    running += 1;
  });
  document.querySelectorAll("[data-show]").forEach((button) =>
    button.addEventListener("click", () => {
      running += 1;
      if (!page.frame) {
        tell(`There is nothing to show: ${page.reason}.`, true);
        return;
      }
      SHOWS[button.dataset.show]();
    }),
  );
}
