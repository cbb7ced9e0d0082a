// Workers of the page: the one for frames, and others for long computations, which are cancelled by ending the worker.

/** Error of a request; `issues` are places in the robot file, `broken` is a mistake in funicular. */
export class EngineError extends Error {
  constructor({ message, status, issues, broken }) {
    super(message);
    Object.assign(this, { status, issues: issues ?? [], broken });
  }
}

/** Error of a computation that the page has cancelled. */
export class Cancelled extends Error {}

/** Compiled module and address of the worker's script. */
let module = null;
let script = "";

/** Prepares the engine. `bytes`: WebAssembly; `source`: text of the worker. */
export async function prepare(bytes, source) {
  module = await WebAssembly.compile(bytes);
  script = URL.createObjectURL(new Blob([source], { type: "text/javascript" }));
}

/** Instance of funicular in a worker. */
export class Engine {
  #worker;
  #waiting = new Map();
  #next = 0;

  constructor() {
    this.#worker = new Worker(script);
    this.#worker.onmessage = ({ data }) => {
      const waiting = this.#waiting.get(data.id);
      this.#waiting.delete(data.id);
      if (data.error) {
        waiting?.reject(new EngineError(data.error));
      } else {
        waiting?.resolve(data);
      }
    };
    this.ready = this.call("start", { module });
  }

  /** Number of calls that have no answer yet. */
  get busy() {
    return this.#waiting.size;
  }

  /** Calls a function of the worker. */
  call(call, more = {}) {
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
    await Promise.all(own.map((engine) => engine.ready));
    return work(own);
  }

  /** Cancels the computation. A worker that is idle stays. */
  cancel() {
    const busy = this.#workers.filter((engine) => engine.busy);
    this.#workers = this.#workers.filter((engine) => !engine.busy);
    busy.forEach((engine) => engine.end());
  }
}
