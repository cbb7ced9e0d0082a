// Files of CASPR, WireX and MoorDyn become a robot: values that they lack are asked for, and a robot without a state is
// shown at a pose with an equilibrium.

import { $, element, plain } from "./format.js";
import { accept, refuse, tell } from "./messages.js";
import { goToEquilibrium } from "./places.js";
import { setRobot, showLibrary } from "./robot.js";
import { FIELDS, keysOf, missing, numbersOf, ROPES, typical } from "./ropes.js";
import { page } from "./store.js";

const ROPE_MM = 6; // diameter that is assumed at first
const ROPE_KEYS = ["mass_kg_per_m", "axial_stiffness_n"];

const ask = async (files, more) =>
  JSON.parse((await page.engine.call("answer", { request: { command: "import", files, ...more } })).text);

let answer = null; // resolves the dialog that is open

/** Row of a value with its unit, marked as assumed until a person changes it. */
function rowOf(key, numbers) {
  const { words, unit, factor } = FIELDS[key];
  const shown = numbers.map((value) => plain(value / factor)).join(", ");
  const field = element("input", { "data-import": key, value: shown, inputmode: "decimal" });
  const mark = element("span", { class: "assumed" }, "assumed");
  field.addEventListener("input", () => {
    mark.textContent = "";
    accept(field);
  });
  return element("div", { class: "import-field" }, element("label", {}, `${words} [${unit}] `, field), mark);
}

/** Kind and diameter of a typical rope, which fill the values of ropes that nobody has typed. */
function ropeRow(fill) {
  const kind = element("select", {}, ...ROPES.map(([value, words]) => element("option", { value }, words)));
  const diameter = element("input", { value: ROPE_MM, inputmode: "decimal" });
  const filled = () => {
    const own = numbersOf(diameter.value, { factor: 1e-3, count: 1 });
    if (!own || own[0] <= 0) {
      refuse(diameter, `“${diameter.value}” is not a diameter: give a positive number of millimetres`);
      return;
    }
    accept(diameter);
    fill(typical(kind.value, own[0]));
  };
  [kind, diameter].forEach((field) => field.addEventListener("input", filled));
  return element(
    "div",
    { class: "import-field" },
    element("label", {}, "Typical rope ", kind),
    element("label", {}, "diameter [mm] ", diameter),
  );
}

/**
 * Asks for values; resolves to the numbers of each with those that are assumed, or to null if a person cancels.
 * @param {string[]} keys
 * @param {string} about what the files are
 */
function asked(keys, about) {
  const ropes = keys.filter((key) => ROPE_KEYS.includes(key));
  const first = { ...typical(ROPES[0][0], ROPE_MM / 1000) };
  const rows = keys.map((key) => rowOf(key, key in first ? [first[key]] : FIELDS[key].assumed));
  const fill = (values) =>
    rows.forEach((row) => {
      const field = row.querySelector("input");
      const key = field.dataset.import;
      if (key in values && row.querySelector(".assumed").textContent) {
        field.value = plain(values[key] / FIELDS[key].factor);
      }
    });
  $("import-fields").replaceChildren(...(ropes.length ? [ropeRow(fill)] : []), ...rows);
  $("import-about").textContent =
    `${about} do not give these values. The ones here are typical and marked as assumed: ` +
    "replace those that you know. Frequencies and sag depend on them.";
  $("import").showModal();
  return new Promise((resolve) => {
    answer = resolve;
  });
}

/** Reads the fields of the dialog; null if one is wrong, which is marked then. */
function readFields() {
  const values = {};
  let wrong = null;
  const assumed = [];
  document.querySelectorAll("[data-import]").forEach((field) => {
    const key = field.dataset.import;
    const { words, unit, count } = FIELDS[key];
    const numbers = numbersOf(field.value, FIELDS[key]);
    if (!numbers || (count === 1 && numbers[0] <= 0)) {
      const what = count === 1 ? "a positive number" : `${count} numbers with spaces between them`;
      refuse(field, `“${field.value}” is not ${what}`);
      wrong ??= field;
      return;
    }
    values[key] = numbers;
    if (field.closest(".import-field").querySelector(".assumed").textContent) {
      assumed.push(`${words}: ${field.value} ${unit}`);
    }
  });
  wrong?.focus();
  return wrong ? null : { values, assumed };
}

/** Imports files, asking for what they lack; null if a person cancels. */
async function imported(files, names) {
  const more = {};
  let assumed = [];
  for (;;) {
    try {
      return { found: await ask(files, more), more, assumed };
    } catch (error) {
      const keys = missing(error.message).filter((key) => !(key in more));
      if (keys.length === 0) {
        throw error;
      }
      const own = await asked(keys, names);
      if (!own) {
        return null;
      }
      Object.assign(more, keysOf(own.values));
      assumed = [...assumed, ...own.assumed];
    }
  }
}

/** Text of the robot file with what was assumed at its head. */
function withAssumed(text, assumed) {
  const lines = ["Assumed on the page, because the files do not give it:", ...assumed.map((line) => `- ${line}`)];
  return assumed.length ? `${lines.map((line) => `# ${line}\n`).join("")}#\n${text}` : text;
}

/** Shows the robot of files of another program. `isLast()`: no others were opened meanwhile. */
export async function importFiles(files, isLast) {
  const names = files.map(({ path }) => path).join(", ");
  const own = await imported(files, names);
  if (!own || !isLast()) {
    return;
  }
  const name = `${files[0].path.replace(/\.[^.]*$/, "")}.toml`;
  const show = async ({ text }, assumed) => {
    await setRobot(name, withAssumed(text, assumed));
    showLibrary();
    return page.frame !== null || (page.about !== null && (await goToEquilibrium()));
  };
  let { found, assumed } = own;
  let rests = await show(found, assumed);
  if (!rests && isLast() && found.assumed.some((line) => line.includes("center_of_mass_m"))) {
    // The centre of mass of the file is none of a real robot: the platform hangs with its origin below the cables.
    assumed = [...assumed, `${FIELDS.center_of_mass_m.words}: 0, 0, 0 m, because no pose rests with that of the file`];
    found = await ask(files, { ...own.more, center_of_mass_m: [0, 0, 0] });
    rests = await show(found, assumed);
  }
  if (!isLast() || !rests) {
    return;
  }
  const told = [
    ...assumed.map((line) => `assumed on this page: ${line}`),
    ...found.assumed.map((line) => `assumed: ${line}`),
    ...found.lost.map((line) => `left out: ${line}`),
  ];
  tell(told.length ? `Imported.\n${told.join("\n")}` : "Imported.", true);
}

/** Listens to the dialog. */
export function listen() {
  const end = (value) => {
    answer?.(value);
    answer = null;
  };
  $("import-form").addEventListener("submit", (event) => {
    event.preventDefault();
    const own = readFields();
    if (own) {
      end(own);
      $("import").close();
    }
  });
  $("import").addEventListener("close", () => end(null));
}
