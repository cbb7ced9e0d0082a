// funicular in Node, a page or a worker. The module lies beside this file.

import { load } from "./funicular.js";

export { BrokenError, Funicular, RequestError, load } from "./funicular.js";

/** Address of the module. */
export const wasm = new URL("./funicular.wasm", import.meta.url);

/**
 * Loads the module that lies beside this file.
 * @returns {Promise<import("./funicular.js").Funicular>}
 */
export async function start() {
  if (wasm.protocol !== "file:") {
    return load(await fetch(wasm));
  }
  const { readFile } = await import("node:fs/promises");
  return load(await readFile(wasm));
}
