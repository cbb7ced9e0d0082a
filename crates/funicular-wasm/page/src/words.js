// The same analysis on the command line and in Python, as text to copy.

const quoted = (text) => (/^[\w./:,=+-]+$/.test(text) ? text : `'${text.replaceAll("'", "'\\''")}'`);
const joined = (numbers) => numbers.map((value) => String(value)).join(",");

/** Options of a state for the program. */
function options(state) {
  const list = [];
  if (state.kind === "pose") {
    list.push(`--pose ${joined(state.pose)}`);
  } else if (state.kind === "lengths") {
    list.push(`--lengths-m ${joined(state.lengths)}`);
  }
  state.set.forEach(({ path, value }) => list.push(`--set ${quoted(`${path}=${value}`)}`));
  if (state.rule) {
    list.push(`--tension-rule ${state.rule}`);
  }
  return list;
}

/** Commands of the program for statics, modes and response. */
export function commands({ file, state, belowHz, response, gradient }) {
  const more = options(state);
  const command = (name, own) => [`funicular ${name} ${quoted(file)}`, ...more, ...own].join(" \\\n  ");
  return [
    command("statics", []),
    command("modes", [`--below-hz ${belowHz}`]),
    command("frf", [
      `--input ${response.input}`, `--output ${response.output}`, `--from-hz ${response.from}`, `--to-hz ${response.to}`,
      `--points ${response.points}`, ...(response.log ? ["--log"] : []),
    ]),
    ...(gradient ? [command("gradient", [`--below-hz ${gradient.belowHz}`, `--per ${gradient.per}`, `--hold ${gradient.hold}`])] : []),
  ].join("\n\n");
}

/** Script in Python for the same. */
export function python({ file, state, belowHz, response, gradient }) {
  const text = (value) => JSON.stringify(value);
  const set = state.set.length
    ? `.with_({${state.set.map(({ path, value }) => `${text(path)}: ${value}`).join(", ")}})`
    : "";
  const own = [];
  if (state.kind === "pose") {
    own.push(`pose=[${state.pose.join(", ")}]`);
  } else if (state.kind === "lengths") {
    own.push(`lengths_m=[${state.lengths.join(", ")}]`);
  }
  if (state.rule) {
    own.push(`tension_rule=${text(state.rule)}`);
  }
  const space = response.log ? "geomspace" : "linspace";
  return `import funicular
import numpy as np

robot = funicular.Robot.from_file(${text(file)})${set}
rest = robot.equilibrium(${own.join(", ")})
print(rest.tension_platform_n)
print(rest.modes(${belowHz}).frequency_hz)
hz = np.${space}(${response.from}, ${response.to}, ${response.points})
response = rest.frf(hz, ${text(response.input)}, ${text(response.output)})${gradient ? `
table = rest.gradient(below_hz=${gradient.belowHz}, per=${text(gradient.per)}, hold=${text(gradient.hold)})` : ""}`;
}
