// The state of the page as a link, and as the start of a page that `funicular live` has made.

import { mayChoose } from "./computation.js";
import { copy, element, $ } from "./format.js";
import { tell } from "./messages.js";
import { setRobot, showLibrary } from "./robot.js";
import { checked, LinkError, packed, unpacked } from "./share.js";
import { content, page, shown } from "./store.js";

/** Everything that a link holds. A robot of the library is named, not copied. */
function linkState() {
  const { robot, ...rest } = content;
  const own = ROBOTS[robot.name] === robot.text ? { ...robot, text: undefined } : robot;
  const { mode, modes, response, exaggeration } = shown;
  return { version: 1, ...rest, robot: own, mode, modes, response, exaggeration, camera: page.view.camera6 };
}

/**
 * Everything for a page around this one: a link, with the text of the robot, and the tension rule only where it counts.
 */
export const told = () => {
  const rule = mayChoose() ? content.rule : "";
  return JSON.parse(JSON.stringify({ ...linkState(), robot: content.robot, rule }));
};

/**
 * Restores the state of a link.
 * @throws LinkError if it is none; the page is unchanged then
 */
export async function restore(state) {
  checked(state);
  const text = state.robot.text ?? ROBOTS[state.robot.name];
  if (text === undefined) {
    throw new LinkError(
      `The robot “${state.robot.name}” of this link is not in the library of this page: it is of another version.`,
    );
  }
  const { hold, pose, lengths, pinned, response, more, model } = state;
  // Lengths without a pose from which the search starts are solved once as the program solves them.
  const start = state.start ?? null;
  const rule = state.rule === "lowest" ? "" : (state.rule ?? "");
  if (rule && ![...$("rule").options].some(({ value }) => value === rule)) {
    $("rule").append(element("option", { value: rule }, rule));
  }
  const display = {
    mode: state.mode ?? -1,
    modes: state.modes ?? 20,
    response: response ?? null,
    exaggeration: state.exaggeration ?? 1,
    camera: state.camera,
  };
  page.view.exaggeration = display.exaggeration;
  $("exaggeration").value = display.exaggeration;
  $("count").value = display.modes;
  $("rule").value = rule;
  const own = {
    robot: { name: state.robot.name, text, set: state.robot.set ?? [] },
    hold: hold ?? "file",
    pose: pose ?? null,
    lengths: lengths ?? null,
    start,
    rule,
    pinned: pinned ?? [],
    more: more ?? {},
    model: model ?? {},
  };
  await setRobot(state.robot.name, text, own, display);
}

/** Link in the address; empty if there is none. The name of a place on the page is none. */
export function linkOfAddress() {
  const fragment = location.hash.slice(1);
  return $(fragment) ? "" : fragment;
}

/** Restores the state of the address. */
export const restoreAddress = async () => restore(await unpacked(linkOfAddress()));

/** Address with the state of the page. */
export async function address() {
  return `${location.href.split("#")[0]}#${await packed(linkState())}`;
}

/** Listens to the button and to links that are opened in this page. */
export function listen() {
  $("share").addEventListener("click", async () => {
    window.history.replaceState(null, "", await address());
    await copy(location.href, $("share"));
  });
  addEventListener("hashchange", async () => {
    if (linkOfAddress() === "") {
      return;
    }
    try {
      await restoreAddress();
      showLibrary();
    } catch (error) {
      const name = page.about?.name ?? content.robot.name;
      tell(`${error.message} The robot on the page is still the one before, ${name}.`);
    }
  });
}
