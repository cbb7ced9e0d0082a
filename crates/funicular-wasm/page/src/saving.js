// Files of results and pictures, and the same analysis as text to copy.

import { mayChoose, RESPONSE_POINTS, statics } from "./computation.js";
import { $, copy, save } from "./format.js";
import { card } from "./card.js";
import { drawing } from "./drawing.js";
import { Cancelled, Job } from "./engine.js";
import { address } from "./link.js";
import { age, busy, put, tell } from "./messages.js";
import { withLengths, withPose } from "./state_text.js";
import { content, on, page, shown } from "./store.js";
import { commands, python } from "./words.js";

const job = new Job();

/** Figures that can be saved: where they are, and what makes them. */
const FIGURES = {
  response: ["bode", "There is no frequency response to save at this state."],
  map: ["map", "There is no slice of the workspace yet: press “Compute” below “Workspace” first."],
  release: ["release", "There is no release yet: press “Release” below “Release of a payload” first."],
};

function fileName() {
  const name = (content.robot.name || page.about?.name || "robot").replace(/^.*[/\\]/, "").replace(/\.toml$/, "");
  return `${name.replace(/[^\w.-]+/g, "-").toLowerCase()}.toml`;
}

/** Derivatives of the chosen frequency, the last of their table; none if no frequency is chosen. */
function gradientOf() {
  const mode = page.frame.modes[shown.mode];
  if (!mode) {
    return null;
  }
  const belowHz = Number((1.0001 * mode.hz).toPrecision(7));
  return { belowHz, per: $("influence-per").value, hold: $("influence-hold").value };
}

/** Empties the commands: the words would compute nothing. */
function showNone() {
  [$("commands"), $("python")].forEach((place) => {
    age(place.id, false);
    put(place, `There are no results: ${page.reason}.`);
  });
}

function showWords() {
  ["commands", "python"].forEach((id) => age(id, false));
  const state = {
    kind: content.hold,
    pose: content.pose,
    lengths: content.lengths,
    set: content.robot.set,
    rule: mayChoose() ? content.rule : "",
    more: content.more,
  };
  const of = {
    file: fileName(),
    state,
    model: content.model,
    belowHz: Number((page.frame.belowHz || 20).toPrecision(3)),
    response: { ...(shown.response ?? {}), points: RESPONSE_POINTS },
    gradient: gradientOf(),
  };
  put($("commands"), commands(of));
  put($("python"), python(of));
}

async function saveAs(kind) {
  const name = fileName().replace(/\.toml$/, "");
  document.querySelector(".menu").open = false;
  if (kind === "toml") {
    await saveRobot(`${name}.toml`);
  } else if (!page.frame && kind !== "map") {
    tell(`There is nothing to save: ${page.reason}.`, true);
  } else if (kind === "card") {
    save(`${name}-card.png`, await card(await address()), "image/png");
  } else if (kind === "png" && !page.view.isDrawn) {
    tell("This browser draws no 3D view: save the picture as SVG, which has the same lines.", true);
  } else if (kind === "png") {
    save(`${name}.png`, await page.view.png(), "image/png");
  } else if (kind === "svg") {
    save(`${name}.svg`, drawing(page.view), "image/svg+xml");
  } else if (FIGURES[kind]) {
    const place = $(FIGURES[kind][0]);
    const figure = place.querySelector("svg");
    if (figure && place.classList.contains("stale")) {
      tell("This figure is of an earlier state: compute it again before you save it.", true);
    } else if (figure) {
      save(`${name}-${kind}.svg`, styled(figure.outerHTML), "image/svg+xml");
    } else {
      tell(FIGURES[kind][1], true);
    }
  } else {
    const own = await results();
    if (kind === "json") {
      save(`${name}.json`, JSON.stringify(own, null, 2), "application/json");
    } else {
      save(`${name}.csv`, csv(own), "text/csv");
    }
  }
}

/** Saves the robot file with the state on the screen; one with an error as it was typed. */
async function saveRobot(name) {
  const { set, text } = content.robot;
  if (shown.refused && set.length > 0) {
    tell(`There is no robot file to save: ${page.reason}. Correct the value, or press “Reset all values”.`, true);
    return;
  }
  save(name, shown.refused ? text : await textWithState(), "application/toml");
  if (shown.refused) {
    tell("The robot file was saved with its error.", true);
  }
}

/** Text of the robot with the pose or the lengths of the page; the reader checks it. */
async function textWithState() {
  const { text } = page.about;
  const { hold, pose, lengths } = content;
  if (hold === "file") {
    return text;
  }
  const changed = hold === "pose" ? withPose(text, pose) : withLengths(text, lengths);
  try {
    await page.engine.call("answer", { request: { command: "check", robot: { text: changed } } });
    return changed;
  } catch (error) {
    tell(`The file keeps the state that it had: the reader refuses the one on the screen. ${error.message}`);
    return text;
  }
}

/** Figure of the page with its style inside, so that it looks alike in other programs. */
function styled(figure) {
  const style = getComputedStyle(document.documentElement);
  const color = (name) => style.getPropertyValue(name).trim();
  const rules = [
    `.axis{stroke:${color("--soft")}}`,
    `.frame{fill:none;stroke:${color("--soft")}}`,
    ".here{fill:none;stroke:#d1249d;stroke-width:2.5}",
    `text{fill:${color("--soft")}}`,
    `.grid{stroke:${color("--line")}}`,
    ".mode{stroke:#777}",
    `.now{fill:none;stroke:${color("--accent")};stroke-width:1.6}`,
    ".past{fill:none;stroke:#777;stroke-dasharray:4 3}",
    `.peak{fill:${color("--accent")}}`,
    "svg{font:11px sans-serif}",
  ].join("");
  const paper = `<rect width="100%" height="100%" fill="${color("--paper")}"/>`;
  return figure.replaceAll("var(--none)", color("--none")).replace(/>/, `><style>${rules}</style>${paper}`);
}

/** Results of the program for the present state, in its JSON. */
async function results() {
  const state = statics();
  const { input, output, from, to, log } = shown.response;
  const belowHz = page.frame.belowHz || 20;
  const done = busy("Computing the results for the file", () => job.cancel());
  try {
    return await job.run(1, async ([worker]) => {
      const ask = async (command, more = {}) => {
        const request = { command, ...state, ...more };
        return JSON.parse((await worker.call("answer", { request })).text);
      };
      const own = { statics: await ask("statics"), modes: await ask("modes", { ...content.model, below_hz: belowHz }) };
      if (from !== null) {
        const range = { from_hz: from, to_hz: to, points: RESPONSE_POINTS, log };
        own.frf = await ask("frf", { ...content.model, input, output, ...range });
      }
      return own;
    });
  } finally {
    done();
  }
}

function csv({ statics: rest, modes, frf }) {
  const cell = (value) => {
    const text = value === undefined ? "" : String(value);
    return /[",\n]/.test(text) ? `"${text.replaceAll('"', '""')}"` : text;
  };
  const line = (keys, row) => keys.map((key) => cell(row[key])).join(",");
  const table = (keys, rows) => [keys.join(","), ...rows.map((row) => line(keys, row))].join("\n");
  const parts = [
    table(
      [
        "name",
        "unstrained_length_m",
        "tension_platform_n",
        "tension_anchor_n",
        "sag_ratio",
        "lambda2",
        "minimum_tension_n",
        "maximum_tension_n",
      ],
      rest.cables,
    ),
    table(["frequency_hz", "damping_ratio", "kind", "platform_energy_fraction"], modes.modes),
  ];
  if (frf) {
    const rows = frf.frequency_hz.map((hz, i) => ({ frequency_hz: hz, real: frf.real[i], imag: frf.imag[i] }));
    parts.push(table(["frequency_hz", "real", "imag"], rows));
  }
  return `${parts.join("\n\n")}\n`;
}

/** Listens to the menu of files and the buttons that copy. */
export function listen() {
  on("rest", showWords);
  on("empty", showNone);
  on("outdated", () => ["commands", "python"].forEach((id) => age(id, true)));
  on("mode", () => {
    if (page.frame) {
      showWords();
    }
  });
  const save = (kind) =>
    saveAs(kind).catch((error) => {
      if (!(error instanceof Cancelled)) {
        tell(error.message);
      }
    });
  document.querySelectorAll("[data-save]").forEach((button) => {
    button.addEventListener("click", () => save(button.dataset.save));
  });
  document.querySelectorAll("[data-copy]").forEach((button) => {
    button.addEventListener("click", () => copy($(button.dataset.copy).textContent, button));
  });
}
