// Undo and redo: steps of the content of the page.

import { change, forget } from "./computation.js";
import { $ } from "./format.js";
import { content, emit } from "./store.js";

const MAX_HISTORY = 200;
const history = { past: [], future: [], present: "" };

/** Stores the present content as a step that undo goes back to. */
export function commit() {
  const now = JSON.stringify(content);
  if (now === history.present) {
    return;
  }
  if (history.present !== "") {
    history.past.push(history.present);
    history.past.splice(0, history.past.length - MAX_HISTORY);
  }
  history.present = now;
  history.future = [];
  show();
  emit("committed");
}

function step(from, to) {
  if (from.length === 0) {
    return;
  }
  const old = content.robot;
  to.push(history.present);
  history.present = from.pop();
  Object.assign(content, JSON.parse(history.present));
  if (old.name !== content.robot.name) {
    forget();
  }
  show();
  emit("committed");
  emit("restored", old.text !== content.robot.text);
  change({ robot: true });
}

function show() {
  $("undo").disabled = history.past.length === 0;
  $("redo").disabled = history.future.length === 0;
}

/** Listens to the buttons and the keys. */
export function listen() {
  show();
  $("undo").addEventListener("click", () => step(history.past, history.future));
  $("redo").addEventListener("click", () => step(history.future, history.past));
  addEventListener("keydown", (event) => {
    const typing = event.target.closest?.(".cm-editor, input:not([type=range]), textarea");
    if ((event.ctrlKey || event.metaKey) && event.key.toLowerCase() === "z" && !typing) {
      event.preventDefault();
      (event.shiftKey ? $("redo") : $("undo")).click();
    }
  });
}
