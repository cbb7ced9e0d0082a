// The state on the screen within the text of a robot file, so that a saved robot comes back as it was.

/** Lines of a text with the table that each is in: `state`, `cables` with its number, or others. */
function placed(text) {
  let table = "";
  let cable = -1;
  return text.split("\n").map((line) => {
    const head = /^\s*\[(\[?)\s*([^\]]+?)\s*\]\]?/.exec(line);
    if (head) {
      table = head[2];
      cable += table === "cables" && head[1] ? 1 : 0;
    }
    return { line, table, cable, isHead: Boolean(head) };
  });
}

const isLength = ({ line, table }) => table === "cables" && /^\s*unstrained_length_m\s*=/.test(line);

/** Text without the state of the file: no table of it, and no lengths. */
const without = (text) => placed(text).filter((one) => one.table !== "state" && !isLength(one));

const ended = (lines) => `${lines.join("\n").trimEnd()}\n`;

/** Robot file whose state is a pose: x, y, z [m], roll, pitch, yaw [degrees]. */
export function withPose(text, pose) {
  const list = (numbers) => `[${numbers.map(float).join(", ")}]`;
  const turned = pose.slice(3).some((angle) => angle !== 0);
  const lines = without(text).map(({ line }) => line);
  const state = ["", "[state]", `position_m = ${list(pose.slice(0, 3))}`];
  return ended([ended(lines).trimEnd(), ...state, ...(turned ? [`roll_pitch_yaw_deg = ${list(pose.slice(3))}`] : [])]);
}

/** Robot file whose state is the unstrained length [m] of each cable. */
export function withLengths(text, lengths) {
  const lines = without(text).flatMap(({ line, table, cable, isHead }) =>
    isHead && table === "cables" ? [line, `unstrained_length_m = ${float(lengths[cable])}`] : [line],
  );
  return ended(lines);
}

/** Number as TOML writes a float. */
const float = (value) => (Number.isInteger(value) ? value.toFixed(1) : String(value)).replace("e+", "e");
