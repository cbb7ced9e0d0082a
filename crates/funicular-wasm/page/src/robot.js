// The robot: choice from the library, files, and the editor of its text.

import { change, forget, stop } from "./computation.js";
import { Editor } from "./editor.js";
import { Cancelled } from "./engine.js";
import { $, element } from "./format.js";
import { commit } from "./history.js";
import { busy, tell, textOf } from "./messages.js";
import { allowed } from "./pose.js";
import { pinFirst, readParameters } from "./sliders.js";
import { content, emit, on, page, shown } from "./store.js";

const MAX_BYTES = 5e6; // of all files that are opened at once: more would take seconds, and no robot has it

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

/** Number of times that files were opened; of several the last one counts. */
let openings = 0;

/**
 * Why files are not read; null if they are. Robot files have some kilobytes, the largest of other programs some
 * hundred.
 */
function tooLarge(list) {
  const size = list.reduce((sum, file) => sum + file.size, 0);
  const [named, has] = list.length === 1 ? [list[0].name, "has"] : [`These ${list.length} files`, "have"];
  if (size <= MAX_BYTES) {
    return null;
  }
  return (
    `${named} ${has} ${(size / 1e6).toFixed(1)} MB, which is more than the ${MAX_BYTES / 1e6} MB that a robot may ` +
    "have: choose the file of the robot. The robot on the page is the one before."
  );
}

async function openFiles(list) {
  openings += 1;
  const own = openings;
  const chosen = [...list];
  const refusal = tooLarge(chosen);
  if (refusal || chosen.length === 0) {
    if (refusal) {
      tell(refusal);
    }
    return;
  }
  const done = busy(`Reading ${chosen.map(({ name }) => name).join(", ")}`, stop);
  try {
    const files = chosen.map(async (file) => ({ path: file.name, text: await file.text() }));
    await read(await Promise.all(files), () => own === openings);
  } catch (error) {
    const names = chosen.map(({ name }) => name).join(", ");
    if (own !== openings) {
      return;
    }
    if (error instanceof Cancelled) {
      tell(`Cancelled: ${names} was not read. The robot on the page is the one before.`, true);
    } else {
      const from = error.message.startsWith(names) ? "" : `${names}: `;
      tell(`${from}${importAdvice(error.message)}\nThe robot on the page is the one before.`);
    }
  } finally {
    done();
  }
}

/** Message of an import, with the way for values that the files lack: the page has no fields for them. */
const importAdvice = (message) =>
  /`(mass_kg_per_m|youngs_modulus_pa|diameter_m|lengths_m|pose)`/.test(message)
    ? `${message}\nThis page has no fields for these values: run \`funicular import\` with them as options, ` +
      "such as `--mass-kg-per-m`, and open the file that it writes."
    : message;

/** Shows the robot of files. `isLast()`: no others were opened meanwhile. */
async function read(files, isLast) {
  if (!isLast()) {
    return;
  }
  if (files.length === 1 && /\.toml$/i.test(files[0].path)) {
    await setRobot(files[0].path, files[0].text);
    showLibrary();
    return;
  }
  const { text } = await page.engine.call("answer", { request: { command: "import", files } });
  if (!isLast()) {
    return;
  }
  const found = JSON.parse(text);
  await setRobot(`${files[0].path.replace(/\.[^.]*$/, "")}.toml`, found.text);
  showLibrary();
  const told = [...found.assumed.map((line) => `assumed: ${line}`), ...found.lost.map((line) => `left out: ${line}`)];
  if (told.length && isLast()) {
    tell(`Imported.\n${told.join("\n")}`, true);
  }
}

/** Shows which robot of the library this is, or that it is another one. */
export function showLibrary() {
  const own = ROBOTS[content.robot.name] !== undefined && ROBOTS[content.robot.name] === content.robot.text;
  const title = (name, text) => /^name = "(.*)"/m.exec(text)?.[1] ?? name;
  const options = Object.entries(ROBOTS).map(([name, text]) => element("option", { value: name }, title(name, text)));
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

/** Listens to the library, files and the tabs of the panel. */
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
  $("open").addEventListener("click", () => $("files").click());
  $("files").addEventListener("change", () =>
    openFiles($("files").files).then(() => {
      $("files").value = "";
    }),
  );
  addEventListener("dragover", (event) => {
    event.preventDefault();
    $("drop").hidden = false;
  });
  addEventListener("dragleave", (event) => {
    $("drop").hidden = event.relatedTarget !== null ? $("drop").hidden : true;
  });
  addEventListener("drop", (event) => {
    event.preventDefault();
    $("drop").hidden = true;
    openFiles(event.dataTransfer.files);
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
