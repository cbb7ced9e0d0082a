// Worker: one instance of funicular. It answers one message after the other, so the page never waits for it.

import { BrokenError, load } from "../../web/funicular.js";

let funicular = null;
let robot = null; // request of the robot that the frames have, to read it again in a new instance

const calls = {
  robot: ({ request }) => {
    robot = null;
    const about = funicular.robot(request);
    robot = request;
    return { about };
  },
  frame: ({ kind, state, modes, points }) => {
    const begin = performance.now();
    const found = funicular.frame(kind, state, modes, points);
    return { ...found, milliseconds: performance.now() - begin };
  },
  platform: () => funicular.platform(),
  mode: ({ index, points }) => ({ numbers: funicular.mode(index, points) }),
  response: ({ request }) => {
    const begin = performance.now();
    const found = funicular.response(request);
    return { ...found, milliseconds: performance.now() - begin };
  },
  reach: ({ pose, level }) => {
    const begin = performance.now();
    const found = funicular.reach(pose, level);
    return { ...found, milliseconds: performance.now() - begin };
  },
  table: ({ text, name }) => ({ columns: funicular.table(text, name) }),
  answer: ({ request }) => ({ text: funicular.answerText(JSON.stringify(request)) }),
  // For tests: more modes than an address can count is a mistake of the caller, which panics.
  crash: () => funicular.frame(0, { length: 2 ** 32 - 1 }, 0, 0),
};

/** Bytes of a text in base64; the loop is for browsers before 2025. */
function decoded(text) {
  if (Uint8Array.fromBase64) {
    return Uint8Array.fromBase64(text);
  }
  const characters = atob(text);
  const bytes = new Uint8Array(characters.length);
  for (let i = 0; i < bytes.length; i += 1) {
    bytes[i] = characters.charCodeAt(i);
  }
  return bytes;
}

/** Compiles WebAssembly while it is unpacked, or while it arrives from a server. */
async function compiled({ packed, address }) {
  let stream;
  if (packed) {
    stream = new Blob([decoded(packed)]).stream().pipeThrough(new DecompressionStream("gzip"));
  } else {
    const response = await fetch(address);
    if (!response.ok) {
      throw new Error(`${address} is missing: the server answers with ${response.status}`);
    }
    stream = response.body;
  }
  return WebAssembly.compileStreaming(new Response(stream, { headers: { "content-type": "application/wasm" } }));
}

async function answer({ data }) {
  try {
    if (data.call === "start") {
      const module = data.module ?? (await compiled(data));
      funicular = await load(module);
      postMessage({ id: data.id, module });
      return;
    }
    const found = calls[data.call](data);
    postMessage({ id: data.id, ...found }, found.numbers ? [found.numbers.buffer] : []);
  } catch (error) {
    const broken = error instanceof BrokenError;
    const { message, status, issues, border } = error;
    postMessage({ id: data.id, error: { message, status, issues, border, broken } });
    if (broken) {
      // A mistake in the core: the page lives on with a new instance and the last robot, unless it is the mistake.
      await funicular.renew();
      try {
        if (robot) {
          funicular.robot(robot);
        }
      } catch {
        robot = null;
      }
    }
  }
}

// The page makes its view, which blocks it for a while, when the worker has its script.
postMessage({ running: true });

// Messages wait for the one before, also while an instance starts.
let before = Promise.resolve();
onmessage = (message) => {
  before = before.then(() => answer(message));
};
