// The program funicular in a page, a worker or Node: a command line in; output, messages, exit code and written files
// out. The files are in memory. No dependencies.
//
//   const program = await loadProgram(await fetch("program.wasm"), { "robots/own.toml": text });
//   const { code, output, written } = await program.run(["statics", "robots/own.toml"]);
//
// It gives the module what a system gives to a program (WASI, preview 1): arguments, files, clock, random numbers.

const OK = 0;
const BAD_FILE = 8; // numbers of errors are those of WASI
const EXISTS = 20;
const INVALID = 28;
const IS_FOLDER = 31;
const NOT_THERE = 44;
const NO_SUCH_CALL = 52;
const NO_FOLDER = 54;
const NOT_EMPTY = 55;

const UNKNOWN = 0; // kinds of files; a terminal would be a character device
const FOLDER = 3;
const REGULAR = 4;

const CREATE = 1;
const MUST_BE_FOLDER = 2;
const MUST_BE_NEW = 4;
const TRUNCATE = 8;
const ALL_RIGHTS = 0xffffffffffffffffn;
const ROOT = 3; // first number of a file that is none of the standard ones
const RANDOM_AT_ONCE = 65536;

/** End of the program with its exit code. */
class Exit extends Error {
  constructor(code) {
    super(`exit code ${code}`);
    this.code = code;
  }
}

let nodes = 0;

function newFile(data = new Uint8Array()) {
  nodes += 1;
  return { id: nodes, kind: REGULAR, data, size: data.length, isWritten: false };
}

function newFolder() {
  nodes += 1;
  return { id: nodes, kind: FOLDER, entries: new Map(), size: 0 };
}

const contentOf = (file) => file.data.slice(0, file.size);

/** Bytes are written at a place of a file, which grows. */
function put(file, at, bytes) {
  const end = at + bytes.length;
  if (end > file.data.length) {
    const more = new Uint8Array(Math.max(end, 2 * file.data.length));
    more.set(file.data.subarray(0, file.size));
    file.data = more;
  }
  file.data.set(bytes, at);
  file.size = Math.max(file.size, end);
  file.isWritten = true;
}

/** Folder tree in memory. Paths begin at its root, with or without `/`. */
export class Files {
  root = newFolder();

  /** @param {Record<string, string | Uint8Array>} [contents] by path */
  constructor(contents = {}) {
    for (const [path, content] of Object.entries(contents)) {
      this.write(path, content);
    }
  }

  /** Parts of a path from a folder, without `.` and `..`. */
  static parts(path, from = []) {
    const found = path.startsWith("/") ? [] : [...from];
    for (const part of path.split("/")) {
      if (part === "..") found.pop();
      else if (part !== "" && part !== ".") found.push(part);
    }
    return found;
  }

  /** File or folder of parts, or undefined. */
  at(parts) {
    return parts.reduce((node, part) => node?.entries?.get(part), this.root);
  }

  /** Writes a file and the folders of its path. */
  write(path, content) {
    const parts = Files.parts(path);
    const name = parts.pop();
    let folder = this.root;
    for (const part of parts) {
      if (!folder.entries.has(part)) folder.entries.set(part, newFolder());
      folder = folder.entries.get(part);
    }
    folder.entries.set(name, newFile(typeof content === "string" ? new TextEncoder().encode(content) : content));
  }

  /** Content of a file, or undefined. */
  read(path) {
    const node = this.at(Files.parts(path));
    return node?.kind === REGULAR ? contentOf(node) : undefined;
  }

  /** Paths and nodes of all files. */
  *all(folder = this.root, before = "") {
    for (const [name, node] of folder.entries) {
      if (node.kind === FOLDER) yield* this.all(node, `${before}${name}/`);
      else yield [`${before}${name}`, node];
    }
  }
}

/** One run: what the module calls. */
class System {
  chunks = [];
  memory = null;
  #open = new Map();

  constructor(files, words) {
    this.files = files;
    this.words = words.map((word) => new TextEncoder().encode(`${word}\0`));
    this.#open.set(ROOT, { node: files.root, parts: [] });
  }

  get #view() {
    return new DataView(this.memory.buffer);
  }

  #bytes(at, length) {
    return new Uint8Array(this.memory.buffer, at, length);
  }

  #number(at, value) {
    this.#view.setUint32(at, value, true);
    return OK;
  }

  #path(fd, at, length) {
    return Files.parts(new TextDecoder().decode(this.#bytes(at, length)), this.#open.get(fd)?.parts);
  }

  /** Folder and name of a path. */
  #place(fd, at, length) {
    const parts = this.#path(fd, at, length);
    const name = parts.pop();
    const folder = this.files.at(parts);
    return { name, entries: folder?.entries, node: name === undefined ? this.files.root : folder?.entries?.get(name) };
  }

  #stat(at, { id, kind, size }) {
    const view = this.#view;
    this.#bytes(at, 64).fill(0);
    view.setBigUint64(at + 8, BigInt(id), true);
    view.setUint8(at + 16, kind);
    view.setBigUint64(at + 24, 1n, true);
    view.setBigUint64(at + 32, BigInt(size), true);
    return OK;
  }

  /** Places in memory of a list of buffers. */
  #buffers(at, count) {
    const view = this.#view;
    return Array.from({ length: count }, (_, i) => {
      const of = at + 8 * i;
      return this.#bytes(view.getUint32(of, true), view.getUint32(of + 4, true));
    });
  }

  #words(words, pointers, text) {
    let at = text;
    words.forEach((word, i) => {
      this.#number(pointers + 4 * i, at);
      this.#bytes(at, word.length).set(word);
      at += word.length;
    });
    return OK;
  }

  /** Functions by the names of WASI. A function that is not there says so to the program. */
  imports() {
    const known = this.#calls();
    return new Proxy(known, { get: (of, name) => of[name] ?? (() => NO_SUCH_CALL) });
  }

  #calls() {
    const open = this.#open;
    return {
      args_sizes_get: (count, size) => {
        this.#number(count, this.words.length);
        return this.#number(
          size,
          this.words.reduce((sum, word) => sum + word.length, 0),
        );
      },
      args_get: (pointers, text) => this.#words(this.words, pointers, text),
      environ_sizes_get: (count, size) => this.#number(count, 0) || this.#number(size, 0),
      environ_get: () => OK,
      sched_yield: () => OK,
      proc_exit: (code) => {
        throw new Exit(code);
      },
      random_get: (at, length) => {
        for (let done = 0; done < length; done += RANDOM_AT_ONCE) {
          // A view of the memory itself is refused where it is shared; a copy never is.
          const some = crypto.getRandomValues(new Uint8Array(Math.min(RANDOM_AT_ONCE, length - done)));
          this.#bytes(at + done, some.length).set(some);
        }
        return OK;
      },
      clock_time_get: (clock, _, at) => {
        const ms = clock === 0 ? Date.now() : performance.now();
        this.#view.setBigUint64(at, BigInt(Math.round(ms * 1e6)), true);
        return OK;
      },
      // Nothing sleeps: every wait is over at once.
      poll_oneoff: (from, to, count, found) => {
        for (let i = 0; i < count; i += 1) {
          this.#bytes(to + 32 * i, 32).fill(0);
          this.#bytes(to + 32 * i, 8).set(this.#bytes(from + 48 * i, 8));
        }
        return this.#number(found, count);
      },

      fd_prestat_get: (fd, at) => (fd === ROOT ? this.#number(at, 0) || this.#number(at + 4, 1) : BAD_FILE),
      fd_prestat_dir_name: (_, at) => {
        this.#bytes(at, 1).set([47]); // the root is called /
        return OK;
      },
      fd_close: (fd) => (open.delete(fd) || fd < ROOT ? OK : BAD_FILE),
      fd_sync: () => OK,
      fd_datasync: () => OK,
      fd_fdstat_set_flags: () => OK,
      fd_fdstat_get: (fd, at) => {
        if (fd >= ROOT && !open.has(fd)) return BAD_FILE;
        this.#bytes(at, 24).fill(0);
        this.#view.setUint8(at, fd < ROOT ? UNKNOWN : open.get(fd).node.kind);
        this.#view.setBigUint64(at + 8, ALL_RIGHTS, true);
        this.#view.setBigUint64(at + 16, ALL_RIGHTS, true);
        return OK;
      },
      fd_filestat_get: (fd, at) => {
        if (fd < ROOT) return this.#stat(at, { id: 0, kind: UNKNOWN, size: 0 });
        return open.has(fd) ? this.#stat(at, open.get(fd).node) : BAD_FILE;
      },
      fd_filestat_set_size: (fd, size) => {
        const { node } = open.get(fd) ?? {};
        if (node?.kind !== REGULAR) return BAD_FILE;
        if (Number(size) > node.size) put(node, Number(size), new Uint8Array());
        node.size = Number(size);
        node.isWritten = true;
        return OK;
      },
      fd_seek: (fd, offset, whence, at) => {
        const file = open.get(fd);
        if (file === undefined) return BAD_FILE;
        const from = [0, file.position, file.node.size][whence];
        if (from === undefined || from + Number(offset) < 0) return INVALID;
        file.position = from + Number(offset);
        this.#view.setBigUint64(at, BigInt(file.position), true);
        return OK;
      },
      fd_read: (fd, at, count, found) => {
        if (fd === 0) return this.#number(found, 0);
        const file = open.get(fd);
        if (file?.node.kind !== REGULAR) return file === undefined ? BAD_FILE : IS_FOLDER;
        let sum = 0;
        for (const buffer of this.#buffers(at, count)) {
          const part = file.node.data.subarray(file.position, Math.min(file.node.size, file.position + buffer.length));
          buffer.set(part);
          file.position += part.length;
          sum += part.length;
        }
        return this.#number(found, sum);
      },
      fd_write: (fd, at, count, found) => {
        const file = open.get(fd);
        if (fd >= ROOT && file?.node.kind !== REGULAR) return BAD_FILE;
        let sum = 0;
        for (const buffer of this.#buffers(at, count)) {
          if (fd < ROOT) {
            this.chunks.push({ isError: fd === 2, bytes: buffer.slice() });
          } else {
            put(file.node, file.appends ? file.node.size : file.position, buffer);
            file.position = file.appends ? file.node.size : file.position + buffer.length;
          }
          sum += buffer.length;
        }
        return this.#number(found, sum);
      },
      fd_readdir: (fd, at, length, cookie, used) => {
        const { node } = open.get(fd) ?? {};
        if (node?.kind !== FOLDER) return node === undefined ? BAD_FILE : NO_FOLDER;
        let end = 0;
        let next = Number(cookie);
        for (const [name, of] of [...node.entries].slice(next)) {
          next += 1;
          const text = new TextEncoder().encode(name);
          const entry = new Uint8Array(24 + text.length);
          const view = new DataView(entry.buffer);
          view.setBigUint64(0, BigInt(next), true);
          view.setBigUint64(8, BigInt(of.id), true);
          view.setUint32(16, text.length, true);
          view.setUint8(20, of.kind);
          entry.set(text, 24);
          const part = entry.subarray(0, length - end);
          this.#bytes(at + end, part.length).set(part);
          end += part.length;
          if (end === length) break;
        }
        return this.#number(used, end);
      },

      path_open: (fd, _, path, length, how, __, ___, flags, at) => {
        const { name, entries, node: found } = this.#place(fd, path, length);
        let node = found;
        if (node === undefined) {
          if (entries === undefined || !(how & CREATE)) return NOT_THERE;
          node = newFile();
          node.isWritten = true;
          entries.set(name, node);
        } else if (how & MUST_BE_NEW) return EXISTS;
        if (how & MUST_BE_FOLDER && node.kind !== FOLDER) return NO_FOLDER;
        if (how & TRUNCATE && node.kind === REGULAR) {
          node.size = 0;
          node.isWritten = true;
        }
        const number = Math.max(...open.keys()) + 1;
        open.set(number, { node, parts: this.#path(fd, path, length), position: 0, appends: Boolean(flags & 1) });
        return this.#number(at, number);
      },
      path_filestat_get: (fd, _, path, length, at) => {
        const { node } = this.#place(fd, path, length);
        return node === undefined ? NOT_THERE : this.#stat(at, node);
      },
      path_create_directory: (fd, path, length) => {
        const { name, entries, node } = this.#place(fd, path, length);
        if (node !== undefined) return EXISTS;
        if (entries === undefined) return NOT_THERE;
        entries.set(name, newFolder());
        return OK;
      },
      path_rename: (fd, path, length, to, toPath, toLength) => {
        const old = this.#place(fd, path, length);
        const made = this.#place(to, toPath, toLength);
        if (old.node === undefined || made.entries === undefined) return NOT_THERE;
        if (made.node?.kind === FOLDER && made.node.entries.size > 0) return NOT_EMPTY;
        old.entries.delete(old.name);
        made.entries.set(made.name, old.node);
        return OK;
      },
      path_link: (fd, _, path, length, to, toPath, toLength) => {
        const old = this.#place(fd, path, length);
        const made = this.#place(to, toPath, toLength);
        if (old.node === undefined || made.entries === undefined) return NOT_THERE;
        if (made.node !== undefined) return EXISTS;
        made.entries.set(made.name, old.node);
        return OK;
      },
      path_readlink: (fd, path, length) => (this.#place(fd, path, length).node === undefined ? NOT_THERE : INVALID),
      path_remove_directory: (fd, path, length) => {
        const { name, entries, node } = this.#place(fd, path, length);
        if (node === undefined) return NOT_THERE;
        if (node.kind !== FOLDER) return NO_FOLDER;
        if (node.entries.size > 0) return NOT_EMPTY;
        entries.delete(name);
        return OK;
      },
      path_unlink_file: (fd, path, length) => {
        const { name, entries, node } = this.#place(fd, path, length);
        if (node === undefined) return NOT_THERE;
        if (node.kind === FOLDER) return IS_FOLDER;
        entries.delete(name);
        return OK;
      },
    };
  }
}

const joined = (chunks) => {
  const all = new Uint8Array(chunks.reduce((sum, { bytes }) => sum + bytes.length, 0));
  chunks.reduce((at, { bytes }) => (all.set(bytes, at), at + bytes.length), 0);
  return new TextDecoder().decode(all);
};

/** The program with files that stay from run to run. */
export class Program {
  #module;

  /** @param {WebAssembly.Module} module @param {Files} files */
  constructor(module, files) {
    this.#module = module;
    this.files = files;
  }

  /**
   * Runs a command line without the name of the program, such as `["statics", "robots/cogiro.toml"]`.
   * @returns {Promise<{code: number, output: string, stdout: string, stderr: string,
   *   written: Record<string, Uint8Array>}>}
   *   exit code; everything that a terminal shows, in its order; both parts of it; files that this run has written
   */
  async run(words) {
    for (const [, node] of this.files.all()) node.isWritten = false;
    const system = new System(this.files, ["funicular", ...words]);
    const { exports } = await WebAssembly.instantiate(this.#module, { wasi_snapshot_preview1: system.imports() });
    system.memory = exports.memory;
    let code = 0;
    try {
      exports._start();
    } catch (end) {
      code = end instanceof Exit ? end.code : 101;
      if (!(end instanceof Exit)) {
        const bytes = new TextEncoder().encode(`the program stopped: ${end.message}\n`);
        system.chunks.push({ isError: true, bytes });
      }
    }
    const written = [...this.files.all()].filter(([, node]) => node.isWritten);
    return {
      code,
      output: joined(system.chunks),
      stdout: joined(system.chunks.filter(({ isError }) => !isError)),
      stderr: joined(system.chunks.filter(({ isError }) => isError)),
      written: Object.fromEntries(written.map(([path, node]) => [path, contentOf(node)])),
    };
  }
}

/**
 * Loads the program.
 * @param {Response | BufferSource | WebAssembly.Module} source answer of `fetch`, bytes, or a compiled module
 * @param {Record<string, string | Uint8Array>} [contents] files by path
 */
export async function loadProgram(source, contents = {}) {
  const bytes = typeof Response !== "undefined" && source instanceof Response ? await source.arrayBuffer() : source;
  const module = bytes instanceof WebAssembly.Module ? bytes : await WebAssembly.compile(bytes);
  return new Program(module, new Files(contents));
}
