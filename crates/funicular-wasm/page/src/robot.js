// The robot: choice from the library, and the editor of its text.

import { change, forget } from "./computation.js";
import { Editor } from "./editor.js";
import { $, element } from "./format.js";
import { commit } from "./history.js";
import { titles } from "./library.js";
import { tell, textOf } from "./messages.js";
import { allowed } from "./pose.js";
import { pinFirst, readParameters } from "./sliders.js";
import { content, emit, on, page, shown } from "./store.js";

let editor = null;

/** Timer of the last change in the editor; another robot ends it, so that the old text does not replace it. */
let typing = 0;

/**
 * Shows another robot; what belongs to the old one goes.
 * @param {object} more parts of the content besides the text
 * @param {object} display parts of what is shown: `mode`, `modes`, `response`, `exaggeration`, `camera`
 */
export async function setRobot(name, text, more = {}, display = {}) {
  clearTimeout(typing);
  const next = {
    robot: { name, text, set: [] },
    hold: "file",
    pose: null,
    lengths: null,
    start: null,
    rule: "",
    pinned: [],
    more: {},
    model: {},
    ...more,
  };
  Object.assign(content, next);
  forget(display);

  // The robot is shown first; the panel of its values follows.
  page.pending += 1;
  try {
    await change({ robot: true });
    await readParameters();
  } finally {
    page.pending -= 1;
  }
  if (content.pinned.length === 0) {
    pinFirst();
  }
  commit();
}

/** Takes the names and texts of the robot away. A robot that is refused is known by its file. */
function forgetRobot() {
  const { name, text } = content.robot;
  $("name").textContent = name;
  $("source").textContent = "";
  document.title = name ? `${name} – funicular` : "funicular";
  shown.issues = [];
  $("issues").replaceChildren();
  showText(text);
  page.view.clear();
  page.view.remember(null);
  $("remember").setAttribute("aria-pressed", "false");
}

function showRobot(isNew) {
  const { about, frame, view } = page;
  const { check } = about;
  $("name").textContent = about.name;
  $("source").textContent = check.source || "";
  document.title = `${about.name} – funicular`;
  shown.issues = [];
  showText(about.text);
  $("issues").replaceChildren();
  view.setRobot(about, frame && !isNew ? frame : null, !isNew);
  if (check.state === "none" && content.hold === "file") {
    // A robot file without a state: the middle between the anchors is a place to start from.
    const pose = [...view.center.toArray().map((value) => Number(value.toPrecision(3))), 0, 0, 0];
    Object.assign(content, { hold: "pose", pose: allowed(pose) });
    commit();
  }
  if (shown.camera) {
    view.camera6 = shown.camera;
    shown.camera = null;
  }
}

function showRefusal(error) {
  const { issues } = error;
  const count = issues.length === 1 ? "an error" : `${issues.length} errors`;
  if (issues.length === 0) {
    tell(textOf(error));
  } else if (content.robot.set.length) {
    tell(`A value of the robot is refused: ${issues[0].message}`);
  } else {
    tell(`The robot file has ${count}: line ${issues[0].line}: ${issues[0].message}`);
  }
  shown.issues = issues;
  showText(content.robot.set.length === 0 ? content.robot.text : null);
  $("issues").replaceChildren(
    ...issues.map((issue) =>
      element(
        "li",
        {},
        element(
          "button",
          { onclick: () => editor?.show(issue.from_byte) },
          `line ${issue.line}, column ${issue.column}`,
        ),
        `: ${issue.message}${issue.help ? ` (${issue.help})` : ""}`,
      ),
    ),
  );
}

/** Shows which robot of the library this is, or that it is another one. */
export function showLibrary() {
  const own = ROBOTS[content.robot.name] !== undefined && ROBOTS[content.robot.name] === content.robot.text;
  const options = titles(ROBOTS).map(([name, title]) => element("option", { value: name }, title));
  if (!own) {
    options.unshift(element("option", { value: "" }, content.robot.name || "own file"));
  }
  $("library").replaceChildren(...options);
  $("library").value = own ? content.robot.name : "";
}

/** Shows the text of the robot in the editor, if it was opened, with its errors; null leaves the text. */
function showText(text) {
  if (editor) {
    if (text !== null) {
      editor.text = text;
    }
    editor.issues = shown.issues;
  }
}

/** Makes the editor when its tab is opened for the first time: it is not needed to show a robot. */
async function openEditor() {
  if (editor) {
    return;
  }
  editor = new Editor($("editor"), (text) => {
    clearTimeout(typing);
    typing = setTimeout(async () => {
      content.robot = { ...content.robot, text, set: [] };
      showLibrary();
      change({ robot: true });
      await readParameters();
      commit();
    }, 300);
  });
  const isOfFile = shown.issues.length && content.robot.set.length === 0;
  showText(isOfFile ? content.robot.text : (page.about?.text ?? content.robot.text));
  editor.schema = JSON.parse((await page.engine.call("answer", { request: { command: "schema" } })).text);
}

/** Listens to the library and the tabs of the panel. */
export function listen() {
  on("forget", forgetRobot);
  on("robot", showRobot);
  on("robot-refused", showRefusal);
  on("restored", () => {
    clearTimeout(typing);
    showLibrary();
  });
  $("library").addEventListener("change", () => {
    const name = $("library").value;
    if (name) {
      setRobot(name, ROBOTS[name]).then(showLibrary);
    }
  });
  const tabs = [...document.querySelectorAll("[role=tab]")];
  const choose = (tab) =>
    tabs.forEach((other) => {
      other.setAttribute("aria-selected", String(other === tab));
      other.tabIndex = other === tab ? 0 : -1;
      $(other.getAttribute("aria-controls")).hidden = other !== tab;
      if (other === tab && tab.id === "tab-file") {
        openEditor();
      }
    });
  tabs.forEach((tab, i) => {
    tab.addEventListener("click", () => choose(tab));
    tab.addEventListener("keydown", ({ key }) => {
      const next = { ArrowRight: tabs[i + 1], ArrowLeft: tabs[i - 1] }[key];
      if (next) {
        choose(next);
        next.focus();
      }
    });
  });
}
