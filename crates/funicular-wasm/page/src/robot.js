// The robot: choice from the library, files, and the editor of its text.

import { change } from "./computation.js";
import { Editor } from "./editor.js";
import { $, element } from "./format.js";
import { commit } from "./history.js";
import { tell, textOf } from "./messages.js";
import { allowed } from "./pose.js";
import { pinFirst, readParameters, showSliders } from "./sliders.js";
import { content, emit, on, page, shown } from "./store.js";

let editor = null;

/** Another robot: text, and what belongs to the old one goes. */
export async function setRobot(name, text, more = {}) {
  const next = { robot: { name, text, set: [] }, hold: "file", pose: null, lengths: null, start: null, rule: "", pinned: [], more: {}, model: {}, ...more };
  Object.assign(content, next);
  Object.assign(shown, { mode: -1, newRobot: true, response: more.response ?? null });
  page.view.setMode(null);
  page.frame = null;
  emit("forget");
  await readParameters();
  if (content.pinned.length === 0) {
    pinFirst();
  } else {
    showSliders();
  }
  change({ robot: true });
  commit();
}

function showRobot(isNew) {
  const { about, frame, view } = page;
  const { check } = about;
  $("name").textContent = about.name;
  $("source").textContent = check.source || "";
  document.title = `${about.name} – funicular`;
  editor.text = about.text;
  editor.issues = [];
  $("issues").replaceChildren();
  view.setRobot(about, frame && !isNew ? frame : null, !isNew);
  if (isNew) {
    page.before = null;
    view.remember(null);
    $("remember").setAttribute("aria-pressed", "false");
  }
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
  tell(issues.length ? `The robot file has ${issues.length === 1 ? "an error" : `${issues.length} errors`}: line ${issues[0].line}: ${issues[0].message}` : textOf(error));
  if (content.robot.set.length === 0) {
    editor.text = content.robot.text;
  }
  editor.issues = issues;
  $("issues").replaceChildren(...issues.map((issue) => element("li", {},
    element("button", { onclick: () => editor.show(issue.from_byte) }, `line ${issue.line}, column ${issue.column}`),
    `: ${issue.message}${issue.help ? ` (${issue.help})` : ""}`)));
}

/** Timer of the note on the last import; the next files end it, so that it does not hide what is told about them. */
let importNote = 0;

async function openFiles(list) {
  clearTimeout(importNote);
  const files = await Promise.all([...list].map(async (file) => ({ path: file.name, text: await file.text() })));
  if (files.length === 0) {
    return;
  }
  if (files.length === 1 && /\.toml$/i.test(files[0].path)) {
    await setRobot(files[0].path, files[0].text);
    showLibrary();
    return;
  }
  try {
    const { text } = await page.engine.call("answer", { request: { command: "import", files } });
    const found = JSON.parse(text);
    await setRobot(`${files[0].path.replace(/\.[^.]*$/, "")}.toml`, found.text);
    showLibrary();
    const told = [...found.assumed.map((line) => `assumed: ${line}`), ...found.lost.map((line) => `left out: ${line}`)];
    if (told.length) {
      importNote = setTimeout(() => tell(`Imported.\n${told.join("\n")}`, true), 400);
    }
  } catch (error) {
    tell(`${files.map((file) => file.path).join(", ")}: ${error.message}`);
  }
}

/** Shows which robot of the library this is, or that it is another one. */
export function showLibrary() {
  const own = ROBOTS[content.robot.name] !== undefined && ROBOTS[content.robot.name] === content.robot.text;
  const options = Object.entries(ROBOTS).map(([name, text]) => element("option", { value: name }, /^name = "(.*)"/m.exec(text)?.[1] ?? name));
  if (!own) {
    options.unshift(element("option", { value: "" }, content.robot.name || "own file"));
  }
  $("library").replaceChildren(...options);
  $("library").value = own ? content.robot.name : "";
}

/** Makes the editor. `schema`: JSON Schema of the robot file, for the completion of keys. */
function makeEditor(schema) {
  let typing = 0;
  editor = new Editor($("editor"), schema, (text) => {
    clearTimeout(typing);
    typing = setTimeout(async () => {
      content.robot = { ...content.robot, text, set: [] };
      showLibrary();
      change({ robot: true });
      await readParameters();
      commit();
    }, 300);
  });
}

/** Listens to the library, files and the tabs of the panel. */
export function listen(schema) {
  makeEditor(schema);
  on("robot", showRobot);
  on("robot-refused", showRefusal);
  on("restored", showLibrary);
  $("library").addEventListener("change", () => {
    const name = $("library").value;
    if (name) {
      setRobot(name, ROBOTS[name]).then(showLibrary);
    }
  });
  $("open").addEventListener("click", () => $("files").click());
  $("files").addEventListener("change", () => openFiles($("files").files).then(() => { $("files").value = ""; }));
  addEventListener("dragover", (event) => { event.preventDefault(); $("drop").hidden = false; });
  addEventListener("dragleave", (event) => { $("drop").hidden = event.relatedTarget !== null ? $("drop").hidden : true; });
  addEventListener("drop", (event) => {
    event.preventDefault();
    $("drop").hidden = true;
    openFiles(event.dataTransfer.files);
  });

  const tabs = [...document.querySelectorAll("[role=tab]")];
  const choose = (tab) => tabs.forEach((other) => {
    other.setAttribute("aria-selected", String(other === tab));
    other.tabIndex = other === tab ? 0 : -1;
    $(other.getAttribute("aria-controls")).hidden = other !== tab;
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
