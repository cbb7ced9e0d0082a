// Worker: one instance of funicular. It answers one message after the other, so the page never waits for it.

import { BrokenError, load } from "../../web/funicular.js";

let funicular = null;
let robot = null; // request of the robot that the frames have, to read it again in a new instance

const calls = {
  robot: ({ request }) => {
    const about = funicular.robot(request);
    robot = request;
    return { about };
  },
  frame: ({ kind, state, modes, points }) => {
    const begin = performance.now();
    const found = funicular.frame(kind, state, modes, points);
    return { ...found, milliseconds: performance.now() - begin };
  },
  mode: ({ index, points }) => ({ numbers: funicular.mode(index, points) }),
  response: ({ request }) => {
    const begin = performance.now();
    const found = funicular.response(request);
    return { ...found, milliseconds: performance.now() - begin };
  },
  answer: ({ request }) => ({ text: funicular.answerText(JSON.stringify(request)) }),
  // For tests: more modes than an address can count is a mistake of the caller, which panics.
  crash: () => funicular.frame(0, { length: 2 ** 32 - 1 }, 0, 0),
};

async function answer({ data }) {
  if (data.call === "start") {
    funicular = await load(data.module);
    postMessage({ id: data.id });
    return;
  }
  try {
    const found = calls[data.call](data);
    postMessage({ id: data.id, ...found }, found.numbers ? [found.numbers.buffer] : []);
  } catch (error) {
    const broken = error instanceof BrokenError;
    postMessage({ id: data.id, error: { message: error.message, status: error.status, issues: error.issues, broken } });
    if (broken) {
      // A mistake in the core: the page lives on with a new instance and the last robot.
      await funicular.renew();
      if (robot) {
        funicular.robot(robot);
      }
    }
  }
}

// Messages wait for the one before, also while an instance starts.
let before = Promise.resolve();
onmessage = (message) => {
  before = before.then(() => answer(message));
};
