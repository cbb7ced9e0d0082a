// The page in a frame of another one, such as the cell of a notebook: it says that it is ready, and tells every change
// to a page that answers.

import { $ } from "./format.js";
import { told, restore } from "./link.js";
import { showLibrary } from "./robot.js";
import { tell } from "./messages.js";
import { on } from "./store.js";

let listener = null;

async function receive({ source, data }) {
  if (source !== window.parent || data?.funicular !== "listen") {
    return;
  }
  listener = source;
  if (data.state) {
    try {
      await restore(data.state);
      showLibrary();
    } catch (error) {
      tell(error.message);
    }
  }
}

/** Listens to the page around this one. */
export function listen() {
  if (window.parent === window) {
    return;
  }
  // The address of a frame is of no use to others.
  $("share").hidden = true;
  addEventListener("message", receive);
  window.parent.postMessage({ funicular: "ready" }, "*");
  on("committed", () => listener?.postMessage({ funicular: told() }, "*"));
}
