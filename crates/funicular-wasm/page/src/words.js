// The same analysis on the command line and in Python, as text to copy.

const quoted = (text) => (/^[\w./:,=+-]+$/.test(text) ? text : `'${text.replaceAll("'", "'\\''")}'`);
const joined = (numbers) => numbers.map((value) => String(value)).join(",");

/** Options of the program for keys of a request. A switch has no value; one that is off is left out. */
const optionsOf = (keys) =>
  Object.entries(keys)
    .filter(([, value]) => value !== false)
    .map(([key, value]) => {
      const option = `--${key.replaceAll("_", "-")}`;
      return value === true ? option : `${option} ${quoted(Array.isArray(value) ? joined(value) : String(value))}`;
    });

/** Value as Python writes it. */
function literal(value) {
  if (typeof value === "boolean") {
    return value ? "True" : "False";
  }
  return Array.isArray(value) ? `[${value.map(literal).join(", ")}]` : JSON.stringify(value);
}

/** Keywords of Python for keys of a request. A switch that is off is left out. */
const keywordsOf = (keys) =>
  Object.entries(keys)
    .filter(([, value]) => value !== false)
    .map(([key, value]) => `${key}=${literal(value)}`);

/** Options of the program for changed values. */
const changesOf = (set) => {
  const textOf = (value) => (Array.isArray(value) ? JSON.stringify(value) : value);
  return set.map(({ path, value }) => `--set ${quoted(`${path}=${textOf(value)}`)}`);
};

/** Keys of a request for a state: pose or lengths, rule, and everything that the page was made with. */
function keysOf({ kind, pose, lengths, rule, more }) {
  const place = { pose: { pose }, lengths: { lengths_m: lengths } }[kind] ?? {};
  return { ...place, ...(rule ? { tension_rule: rule } : {}), ...more };
}

/** Command of the program for a calibration. `request`: the request, whose robot may have changes. */
export function calibrateCommand({ file, readings, request }) {
  const { command: name, robot, readings: _, unknowns, grid = [], leave_out: rows = [], ...rest } = request;
  const keys = { unknowns, ...(rows.length ? { leave_out: rows } : {}), ...rest };
  const axes = grid.map(({ axis, from, to, count }) => `--grid ${axis}=${from}:${to}:${count}`);
  const words = [`--readings ${quoted(readings)}`, ...optionsOf(keys), ...axes, ...changesOf(robot.set)];
  return [`funicular ${name} ${quoted(file)}`, ...words].join(" \\\n  ");
}

/** Commands of the program for statics, modes and response. */
export function commands({ file, state, model, belowHz, response, gradient }) {
  const rest = [...optionsOf(keysOf(state)), ...changesOf(state.set)];
  const command = (name, own) => [`funicular ${name} ${quoted(file)}`, ...rest, ...own].join(" \\\n  ");
  const models = optionsOf(model);
  const list = [
    command("statics", []),
    command("modes", [...models, `--below-hz ${belowHz}`]),
    command("frf", [
      ...models,
      `--input ${response.input}`,
      `--output ${response.output}`,
      `--from-hz ${response.from}`,
      `--to-hz ${response.to}`,
      `--points ${response.points}`,
      ...(response.log ? ["--log"] : []),
    ]),
  ];
  if (gradient) {
    const { per, hold } = gradient;
    list.push(command("gradient", [...models, `--below-hz ${gradient.belowHz}`, `--per ${per}`, `--hold ${hold}`]));
  }
  return list.join("\n\n");
}

/** Script in Python for the same. */
export function python({ file, state, model, belowHz, response, gradient }) {
  const text = (value) => JSON.stringify(value);
  const set = state.set.length
    ? `.with_({${state.set.map(({ path, value }) => `${text(path)}: ${literal(value)}`).join(", ")}})`
    : "";
  const models = keywordsOf(model);
  const call = (...own) => [...own, ...models].join(", ");
  const space = response.log ? "geomspace" : "linspace";
  const own = gradient && [`below_hz=${gradient.belowHz}`, `per=${text(gradient.per)}`, `hold=${text(gradient.hold)}`];
  const table = gradient ? `\ntable = rest.gradient(${call(...own)})` : "";
  return `import funicular
import numpy as np

robot = funicular.Robot.from_file(${text(file)})${set}
rest = robot.equilibrium(${keywordsOf(keysOf(state)).join(", ")})
print(rest.tension_platform_n)
print(rest.modes(${call(belowHz)}).frequency_hz)
hz = np.${space}(${response.from}, ${response.to}, ${response.points})
response = rest.frf(${call("hz", text(response.input), text(response.output))})${table}`;
}
