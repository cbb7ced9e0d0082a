// Workers of the page: the one for frames, and others for long computations, which are cancelled by ending the worker.

/**
 * Error of a request; `issues` are places in the robot file, `border` says why a pose has no equilibrium, `broken` is a
 * mistake in funicular.
 */
export class EngineError extends Error {
  constructor({ message, status, issues, border, broken }) {
    super(message);
    Object.assign(this, { status, issues: issues ?? [], border: border ?? null, broken });
  }
}

/** Error of a computation that the page has cancelled. */
export class Cancelled extends Error {}

/** Address of the worker's script, and the module that the first worker has compiled. */
let script = "";
let compiled = null;

/**
 * Makes the first engine. Its worker unpacks and compiles WebAssembly while the page makes its view; the other engines
 * get the compiled module.
 * @param {string} source text of the worker
 * @param {object} core `packed`: compressed WebAssembly in base64; or `address` of the file
 */
export function prepare(source, core) {
  script = URL.createObjectURL(new Blob([source], { type: "text/javascript" }));
  const first = new Engine(Promise.resolve(core));
  compiled = first.ready;
  return first;
}

/** Instance of funicular in a worker. */
export class Engine {
  #worker;
  #waiting = new Map();
  #next = 0;

  /** @param {Promise<object>} core `module`, or what it is compiled from */
  constructor(core = compiled) {
    this.#worker = new Worker(script);
    let run = null;
    /** Resolves when the worker has its script. */
    this.running = new Promise((resolve) => {
      run = resolve;
    });
    this.#worker.onmessage = ({ data }) => {
      if (data.running) {
        run();
        return;
      }
      const waiting = this.#waiting.get(data.id);
      this.#waiting.delete(data.id);
      if (data.error) {
        waiting?.reject(new EngineError(data.error));
      } else {
        waiting?.resolve(data);
      }
    };
    this.ready = core.then(({ module, packed, address }) => this.#post("start", { module, packed, address }));
    // Whoever calls the engine is told why it has not started.
    this.ready.catch(() => {});
  }

  /** Number of calls that have no answer yet. */
  get busy() {
    return this.#waiting.size;
  }

  /** Calls a function of the worker when it has started. */
  async call(call, more = {}) {
    await this.ready;
    return this.#post(call, more);
  }

  #post(call, more) {
    const id = this.#next++;
    return new Promise((resolve, reject) => {
      this.#waiting.set(id, { resolve, reject });
      this.#worker.postMessage({ id, call, ...more });
    });
  }

  /** Ends the worker and everything that it computes. */
  end() {
    this.#worker.terminate();
    this.#waiting.forEach(({ reject }) => reject(new Cancelled()));
    this.#waiting.clear();
  }
}

/** Number of workers for long computations: the frames and the page itself keep a core if there are enough. */
export const CORES = Math.max(1, Math.min(8, (navigator.hardwareConcurrency || 2) - 1));

/** Long computation in its own workers, of which only the latest counts. */
export class Job {
  #workers = [];

  /** Runs `work(engines)`; a run before is cancelled. Workers that were not needed by the last run are used again. */
  async run(count, work) {
    this.cancel();
    while (this.#workers.length < count) {
      this.#workers.push(new Engine());
    }
    const own = this.#workers.slice(0, count);
    return work(own);
  }

  /** Cancels the computation. A worker that is idle stays. */
  cancel() {
    const busy = this.#workers.filter((engine) => engine.busy);
    this.#workers = this.#workers.filter((engine) => !engine.busy);
    busy.forEach((engine) => engine.end());
  }
}
