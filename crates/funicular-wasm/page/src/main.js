// The page: its parts are made, then the first robot is shown.

import * as calibration from "./calibration.js";
import * as comparison from "./comparison.js";
import { isIdle, statics } from "./computation.js";
import { CORES, prepare } from "./engine.js";
import { $ } from "./format.js";
import * as embedded from "./embedded.js";
import * as gallery from "./gallery.js";
import * as history from "./history.js";
import * as importing from "./importing.js";
import * as influence from "./influence.js";
import * as key from "./key.js";
import * as link from "./link.js";
import * as messages from "./messages.js";
import { age, tell } from "./messages.js";
import * as modes from "./modes.js";
import * as opening from "./opening.js";
import * as parts from "./parts.js";
import * as places from "./places.js";
import * as pose from "./pose.js";
import * as reach from "./reach.js";
import * as release from "./release.js";
import * as response from "./response.js";
import * as robot from "./robot.js";
import * as saving from "./saving.js";
import * as sliders from "./sliders.js";
import * as simulation from "./simulation.js";
import * as stop from "./stop.js";
import { LinkError } from "./share.js";
import { content, emit, on, page, shown } from "./store.js";
import * as survey from "./survey.js";
import * as tensions from "./tensions.js";
import * as validation from "./validation.js";
import { View } from "./view.js";
import * as welcome from "./welcome.js";
import { Workspace } from "./workspace.js";

const FIRST_ROBOT = "cogiro";

/** Keeps the present state as “before”, or forgets it. */
function remember() {
  if (!page.before && !page.frame) {
    tell(`There is nothing to remember: ${page.reason}.`, true);
    return;
  }
  page.before = page.before ? null : { frame: page.frame, response: page.answered, payload: page.settled.payload };
  $("remember").setAttribute("aria-pressed", String(page.before !== null));
  page.view.remember(page.before?.frame ?? null);
  emit("remember");
}

function setTheme(theme) {
  document.documentElement.dataset.theme = theme;
  page.view?.recolor();
  if (page.frame) {
    page.view.setFrame(page.frame);
  }
}

/** WebAssembly in this file, or beside it. */
function core() {
  const own = $("core");
  return own ? { packed: own.textContent } : { address: new URL("funicular.wasm", location.href).href };
}

function makeWorkspace() {
  const workspace = new Workspace({
    request: () => ({ ...statics(), robot: content.robot }),
    state: () => page,
    here: pose.presentPose,
    go: (to) => pose.setPose(to).then(history.commit),
    rounded: pose.roundedLength,
    tell,
    cores: CORES,
  });
  on("outdated", () => workspace.outdated());
  on("frame", () => workspace.moved());
  on("empty", () => workspace.moved());
  on("forget", () => workspace.forget());
  on("remember", () => workspace.remember(page.before !== null));
}

/**
 * The robot of the address, of a page that was made with one, or the first of the library. After a link that cannot be
 * read, the robot is named as the one that stands in for it.
 */
async function firstRobot() {
  let wrong = null;
  try {
    const given = JSON.parse($("start").textContent);
    if (link.linkOfAddress()) {
      await link.restoreAddress();
    } else if (given) {
      await link.restore(given);
    } else {
      await robot.setRobot(FIRST_ROBOT, ROBOTS[FIRST_ROBOT]);
    }
  } catch (error) {
    if (!(error instanceof LinkError)) {
      throw error;
    }
    wrong = error;
    await robot.setRobot(FIRST_ROBOT, ROBOTS[FIRST_ROBOT]);
  }
  robot.showLibrary();
  if (wrong) {
    tell(`${wrong.message} This is not its robot, but the first one of the library, ${page.about.name}.`);
  }
}

async function start() {
  setTheme(matchMedia("(prefers-color-scheme: dark)").matches ? "dark" : "light");
  $("version").textContent = VERSION;
  page.engine = prepare(WORKER, core());
  await page.engine.running;
  page.view = new View($("view"), pose.handles);
  makeWorkspace();

  // The order of listeners is the order in which a frame is shown: the view first, whose colours the table takes.
  messages.listen();
  robot.listen();
  const all = [
    parts,
    pose,
    tensions,
    modes,
    key,
    response,
    sliders,
    influence,
    release,
    stop,
    simulation,
    survey,
    places,
    reach,
    calibration,
    opening,
    importing,
    welcome,
    gallery,
    history,
    link,
    embedded,
    saving,
    comparison,
    validation,
  ];
  all.forEach((part) => part.listen());
  on("frame", () => {
    if (performance.getEntriesByName("frame").length === 0) {
      performance.mark("frame");
    }
  });
  ["frame", "empty"].forEach((event) =>
    on(event, () => {
      if (event === "frame" || shown.refused || shown.broken) {
        $("loading")?.remove();
      }
    }),
  );
  // While a frame takes long, the figures are those of the state before.
  const ofFrame = (old) => ["key", "tensions", "modes"].forEach((id) => age(id, old));
  on("outdated", () => {
    ofFrame(true);
    age("bode", true);
  });
  ["frame", "empty", "border"].forEach((event) => on(event, () => ofFrame(false)));
  on("border", () => age("bode", false));
  on("rested", () => {
    $("state").dataset.settled = String(Number($("state").dataset.settled ?? 0) + 1);
  });
  $("remember").addEventListener("click", remember);
  const { dataset } = document.documentElement;
  $("theme").addEventListener("click", () => setTheme(dataset.theme === "dark" ? "light" : "dark"));
  const dark = matchMedia("(prefers-color-scheme: dark)");
  dark.addEventListener("change", ({ matches }) => setTheme(matches ? "dark" : "light"));
  performance.mark("ready");
  await firstRobot();
  performance.mark("complete");
}

// For tests: the state and the numbers of the page, as data.
window.funicular = {
  get content() {
    return content;
  },
  get frame() {
    return page.frame;
  },
  get border() {
    return page.border && { pose: page.border.pose, message: page.border.error.message };
  },
  get response() {
    return page.answered;
  },
  get freedoms() {
    return page.about.degrees_of_freedom;
  },
  get asked() {
    return { response: shown.response };
  },
  get times() {
    return page.times;
  },
  get idle() {
    return isIdle();
  },
  get view() {
    return page.view;
  },
  get engine() {
    return page.engine;
  },
  ask: async (request) => JSON.parse((await page.engine.call("answer", { request })).text),
  timeOfResponse: async () => {
    const { input, output, from, to, log } = shown.response;
    const request = { input, output, from_hz: from, to_hz: to, points: 1000, log };
    return (await page.engine.call("response", { request })).milliseconds;
  },
  crash: () => page.engine.call("crash"),
};

start().catch((error) => {
  $("loading")?.remove();
  tell(`The page cannot start: ${error.message}`);
});
