// Files that a person opens or drops: a robot file, files of other programs, or a table of readings.

import { stop } from "./computation.js";
import { Cancelled } from "./engine.js";
import { $ } from "./format.js";
import { importFiles } from "./importing.js";
import { busy, tell } from "./messages.js";
import { setRobot, showLibrary } from "./robot.js";
import { emit } from "./store.js";

const MAX_BYTES = 5e6; // of all files that are opened at once: more would take seconds, and no robot has it

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
      tell(`${from}${error.message}\nThe robot on the page is the one before.`);
    }
  } finally {
    done();
  }
}

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
  if (files.length === 1 && /\.csv$/i.test(files[0].path)) {
    emit("readings", files[0].path, files[0].text);
    return;
  }
  await importFiles(files, isLast);
}

/** Listens to the button and to files that are dropped. */
export function listen() {
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
}
