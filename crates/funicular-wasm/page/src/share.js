// State of the page in a link: compressed in the fragment, which browsers do not send anywhere.

const toBytes = async (stream) => new Uint8Array(await new Response(stream).arrayBuffer());

/** Error of a link that has no state. */
export class LinkError extends Error {}

const DAMAGED = "This link is damaged: a part of it is missing or was changed. Copy the whole link again.";
const MIN_LINK = 100; // characters: that of a robot of the library with its state has about 400
const MAX_SHOWN = 40; // characters of an address in a message

/** Fragment for a state. Its checksum tells a link in which a character was changed. */
export async function packed(state) {
  const stream = new Blob([JSON.stringify(state)]).stream().pipeThrough(new CompressionStream("deflate"));
  const bytes = await toBytes(stream);
  const text = Array.from(bytes, (byte) => String.fromCharCode(byte)).join("");
  return btoa(text).replaceAll("+", "-").replaceAll("/", "_").replace(/=+$/, "");
}

/**
 * State of a fragment.
 * @throws LinkError if it is none
 */
export async function unpacked(fragment) {
  if (fragment.length < MIN_LINK) {
    const shown = fragment.length > MAX_SHOWN ? `${fragment.slice(0, MAX_SHOWN)}…` : fragment;
    throw new LinkError(
      `“#${shown}” at the end of the address is no link of this page, or the rest of it is missing. ` +
        "The button “Copy link” makes links.",
    );
  }
  let state = null;
  try {
    const text = atob(fragment.replaceAll("-", "+").replaceAll("_", "/"));
    const bytes = Uint8Array.from(text, (c) => c.charCodeAt(0));
    // Links of the first versions of the page have no head and no checksum. RFC 1950: the head of a stream with both.
    const [method, flags] = bytes;
    const format = (method & 15) === 8 && (256 * method + flags) % 31 === 0 ? "deflate" : "deflate-raw";
    const stream = new Blob([bytes]).stream().pipeThrough(new DecompressionStream(format));
    state = JSON.parse(new TextDecoder("utf-8", { fatal: true }).decode(await toBytes(stream)));
  } catch {
    throw new LinkError(DAMAGED);
  }
  return checked(state);
}

const isText = (value) => typeof value === "string";
const isObject = (value) => value !== null && typeof value === "object" && !Array.isArray(value);
const isList = (value, one) => Array.isArray(value) && value.every(one);
const isCount = (low, high) => (value) => Number.isInteger(value) && value >= low && value <= high;
const areNumbers = (count) => (value) =>
  isList(value, Number.isFinite) && (count ? value.length === count : value.length > 0);
const isLimit = (value) => value === null || Number.isFinite(value);

/** Parts of a state, each of which may be missing. */
const PARTS = {
  hold: (value) => ["file", "pose", "lengths"].includes(value),
  pose: areNumbers(6),
  lengths: areNumbers(),
  start: areNumbers(7),
  rule: isText,
  pinned: (value) => isList(value, isText),
  more: isObject,
  model: isObject,
  mode: isCount(-1, 1e6),
  modes: isCount(1, 200),
  exaggeration: (value) => Number.isFinite(value) && value >= 0 && value <= 1000,
  camera: areNumbers(6),
  response: ({ input, output, from, to, log }) =>
    isText(input) && isText(output) && isLimit(from) && isLimit(to) && typeof log === "boolean",
};

/**
 * A state whose parts have the form that the page needs.
 * @throws LinkError for another one
 */
export function checked(state) {
  if (!isObject(state) || !isObject(state.robot)) {
    throw new LinkError(DAMAGED);
  }
  if (state.version !== 1) {
    throw new LinkError("This link is of another version of the page: open it with that one.");
  }
  const { name, text, set } = state.robot;
  const areSet = set === undefined || isList(set, (one) => isObject(one) && isText(one.path));
  const robot = isText(name) && (text === undefined || isText(text)) && areSet;
  const isMissing = (key) => state[key] === undefined || state[key] === null;
  const parts = Object.entries(PARTS).every(([key, is]) => isMissing(key) || is(state[key]));
  const held = { pose: state.pose, lengths: state.lengths };
  if (!robot || !parts || (state.hold in held && !held[state.hold])) {
    throw new LinkError(DAMAGED);
  }
  return state;
}
