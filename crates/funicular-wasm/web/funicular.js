// funicular in a page, a worker or Node: requests in JSON, results in JSON. No dependencies.
//
//   const funicular = await load(await fetch("funicular.wasm"));
//   const found = funicular.answer({ command: "statics", pose: [1, 2, 1.5] }, robotFile);
//   console.log(found.cables[0].tension_platform_n);

/** Error of a request without results. `status`: 1 if the robot has no such solution, 2 if the request has to change. */
export class RequestError extends Error {
  constructor(message, status) {
    super(message);
    this.name = "RequestError";
    this.status = status;
  }
}

/** Error of a mistake in funicular, or of exhausted memory. The instance is broken: await `renew()`. */
export class BrokenError extends Error {
  constructor(message, cause) {
    super(message, { cause });
    this.name = "BrokenError";
  }
}

/** Instance of funicular. It runs on the thread that calls it; a worker keeps a page responsive. */
export class Funicular {
  #module;
  #exports = null;
  #broken = "this instance has not been started: await `renew()`";

  /** @param {WebAssembly.Module} module */
  constructor(module) {
    this.#module = module;
  }

  /** Starts a new instance. Nothing of the previous one is kept. */
  async renew() {
    this.#exports = (await WebAssembly.instantiate(this.#module)).exports;
    this.#broken = "";
  }

  /** True if the instance has to be started again with `renew()` before the next request. */
  get broken() {
    return this.#broken !== "";
  }

  /**
   * Answers a request and returns the results as an object.
   * @param {object} request keys as described in docs/web.md
   * @param {string} [robotFile] text of the robot file, if the request does not have it
   * @param {string} [robotName] name of the robot file in messages
   */
  answer(request, robotFile, robotName) {
    return JSON.parse(this.answerText(JSON.stringify(withRobot(request, robotFile, robotName))));
  }

  /** Answers a request in text and returns the results as text, with every digit that the program prints. */
  answerText(request) {
    const status = this.#call(request, [], (exports) => exports.funicular_answer());
    const text = this.#output();
    if (status !== 0) {
      throw new RequestError(text, status);
    }
    return text;
  }

  /**
   * Reads the robot of the frames and returns its description.
   * @param {object} request keys of `stiffness`: robot, state, loads, tensions, linearisation
   * @throws RequestError with `issues`, the places of errors in the robot file; there is no robot then, and `frame`,
   *   `platform`, `mode` and `response` are refused until one is read
   */
  robot(request) {
    return this.#numbers(JSON.stringify({ ...request, command: "stiffness" }), [], (of) => of.funicular_robot()).about;
  }

  /**
   * Computes a frame: equilibrium, curves of the cables, and lowest natural frequencies.
   * @param {number} kind 0: state of the robot; 1: pose, with 3, 6 or 7 numbers; 2: unstrained lengths; 3: pose from
   *   which the search starts (7 numbers), and unstrained lengths
   * @param {ArrayLike<number>} state the numbers
   * @param {number} modes number of frequencies
   * @param {number} points number of points per cable
   * @returns {{numbers: Float64Array, about: object}} layout: docs/web.md
   * @throws RequestError, with `border` if the robot cannot rest there: `push`, `minimum` and `maximum` name the cables
   *   that prevent it. There is no frame then, and `platform`, `mode` and `response` are refused until there is one
   */
  frame(kind, state, modes, points) {
    return this.#numbers("", state, (of) => of.funicular_frame(kind, modes, points));
  }

  /**
   * Continues the list of modes of the last frame up to the first mode of the platform, with most of its kinetic energy
   * there. `numbers`: those of all these modes, as at the end of a frame; `about.index`: place of the last one, from 0.
   * @throws RequestError with `status` 1 if there is no such mode
   */
  platform() {
    return this.#numbers("", [], (of) => of.funicular_platform());
  }

  /** Displacements (x, y, z) of points on all cables in a mode of the last frame. */
  mode(index, points) {
    return this.#numbers("", [], (of) => of.funicular_mode(index, points)).numbers;
  }

  /** Response at the equilibrium of the last frame, by a request of `frf`. */
  response(request) {
    const whole = { robot: { text: "" }, ...request, command: "frf" };
    return this.#numbers(JSON.stringify(whole), [], (of) => of.funicular_response());
  }

  /**
   * Follows rays from a pose to where the conditions of `workspace` end.
   * @param {ArrayLike<number>} pose position [m] and quaternion w, x, y, z
   * @param {number} level 0 to 3: each has the rays between those of the levels below
   * @returns {{numbers: Float64Array, about: object}} x, y, z, distance [m], and 1 at the border per ray; `about`: the
   *   conditions in words, and whether they are kept at the pose and the pose is in the box of the search
   */
  reach(pose, level) {
    return this.#numbers("", pose, (of) => of.funicular_reach(level));
  }

  /**
   * Reads a table in CSV into columns, as a request of `calibrate` has them in `readings`.
   * @param {string} text the table
   * @param {string} [name] its name in messages
   */
  table(text, name = "table") {
    return this.#numbers(`${name.replaceAll("\n", " ")}\n${text}`, [], (of) => of.funicular_table()).about;
  }

  /** Calls a function of frames and returns a copy of its numbers and its text as an object. */
  #numbers(text, state, call) {
    const status = this.#call(text, state, call);
    const answer = this.#output();
    if (status !== 0) {
      const { message, issues, border } = JSON.parse(answer);
      throw Object.assign(new RequestError(message, status), { issues, border });
    }
    const { funicular_numbers_output, funicular_numbers_length, memory } = this.#exports;
    const at = funicular_numbers_output() >>> 0;
    const numbers = new Float64Array(memory.buffer, at, funicular_numbers_length() >>> 0).slice();
    return { numbers, about: answer === "" ? null : JSON.parse(answer) };
  }

  /** Writes a text and numbers, and calls an exported function. A trap breaks the instance. */
  #call(text, numbers, call) {
    if (this.broken) {
      throw new BrokenError(this.#broken);
    }
    const bytes = new TextEncoder().encode(text);
    const { funicular_input, funicular_numbers, memory } = this.#exports;
    try {
      const at = funicular_input(bytes.length) >>> 0;
      // Each view is made after the allocation, because older views are empty if the memory has grown.
      new Uint8Array(memory.buffer, at, bytes.length).set(bytes);
      const state = funicular_numbers(numbers.length) >>> 0;
      new Float64Array(memory.buffer, state, numbers.length).set(numbers);
      return call(this.#exports);
    } catch (trap) {
      this.#broken = this.#messageAboutTrap(trap);
      throw new BrokenError(this.#broken, trap);
    }
  }

  #output() {
    const { funicular_output, funicular_output_length, memory } = this.#exports;
    const length = funicular_output_length() >>> 0;
    return new TextDecoder().decode(new Uint8Array(memory.buffer, funicular_output() >>> 0, length));
  }

  /** Message that a panic has left; without a message, memory or the stack was exhausted. */
  #messageAboutTrap(trap) {
    try {
      const text = this.#output();
      if (text.startsWith("mistake in funicular")) {
        return text;
      }
    } catch {
      // The text cannot be read, because the instance is broken.
    }
    return `funicular stopped without a message (${trap.message}): memory or stack ran out; ask for less at once, or ` +
      "report it with the request and its robot file. This instance is broken: make a new one";
  }
}

function withRobot(request, text, name = "") {
  return text === undefined ? request : { ...request, robot: { ...request.robot, name, text } };
}

/**
 * Loads funicular.
 * @param {Response | BufferSource | WebAssembly.Module} source answer of `fetch`, bytes, or a compiled module
 */
export async function load(source) {
  const bytes = typeof Response !== "undefined" && source instanceof Response ? await source.arrayBuffer() : source;
  const module = bytes instanceof WebAssembly.Module ? bytes : await WebAssembly.compile(bytes);
  const funicular = new Funicular(module);
  await funicular.renew();
  return funicular;
}
