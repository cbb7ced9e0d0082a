// A pose with an equilibrium for a robot whose state has none: searched on a grid around its anchors.

import { candidates, innermost } from "./candidates.js";
import { statics } from "./computation.js";
import { Cancelled, Job } from "./engine.js";
import { $ } from "./format.js";
import { commit } from "./history.js";
import { measureOf, valuesAt } from "./measures.js";
import { busy, tell } from "./messages.js";
import { allowed, roundedLength, setPose } from "./pose.js";
import { content, on, page, shown } from "./store.js";

const job = new Job();

/** Searches a pose with an equilibrium; null if the grid has none. */
export async function searchPose() {
  const { check, motion } = page.about;
  const poses = candidates({ anchors: check.cables.map((cable) => cable.anchor_m), motion }).map(allowed);
  const { lengths_m: _, ...asked } = { ...statics(), robot: content.robot };
  const done = busy("Searching a pose with an equilibrium", () => job.cancel());
  try {
    const measure = measureOf("tension-max");
    const values = await job.run(1, ([worker]) => valuesAt(worker, asked, measure, poses));
    const found = innermost(poses, values);
    return found && [...found.slice(0, 3).map(roundedLength), ...found.slice(3)];
  } finally {
    done();
  }
}

/** Goes to a pose with an equilibrium, or says that none was found. Resolves to whether there is one. */
export async function goToEquilibrium() {
  try {
    const pose = await searchPose();
    if (pose) {
      await setPose(pose);
      commit();
      return page.frame !== null;
    }
    tell(
      "No pose with an equilibrium was found between the anchors and below them: check mass, tension limits and signs.",
    );
  } catch (error) {
    tell(error instanceof Cancelled ? "Cancelled: no pose was searched." : error.message, error instanceof Cancelled);
  }
  return false;
}

export function listen() {
  const show = () => {
    $("find-pose").hidden = page.frame !== null || page.about === null || !shown.broken || shown.refused;
  };
  ["frame", "frame-refused", "empty", "forget"].forEach((event) => on(event, show));
  on("forget", () => job.cancel());
  $("find-pose").addEventListener("click", goToEquilibrium);
}
