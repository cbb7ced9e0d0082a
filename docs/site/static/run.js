// Runs the examples of a page in the page: the program as a WebAssembly module, with the files of the documents in
// memory. Nothing is requested from a network. The site has this script where the program was built (runnable.py).

(() => {
  const FOLDER = document.currentScript.src.replace(/[^/]*$/, "");
  const { files: NAMES, writes: WRITES, endings: NOT_HERE, commands: NO_COMMANDS, long: LONG } = RUNNABLE;
  const known = new Set(NAMES);
  const ENDINGS =
    "toml csv tsv json jsonl uff unv xml yaml yml m mat dat stl txt sdf urdf py html svg pdf vti vtk npz tex md";
  const FILE = new RegExp(`^[\\w./-]+\\.(${ENDINGS.replaceAll(" ", "|")}|nc|gcode)$`);

  /** Words of a command line as a shell reads them, and the file of `> FILE`. */
  function words(line) {
    const found = [...line.matchAll(/(?:[^\s'"\\]|\\.|'[^']*'|"(?:[^"\\]|\\.)*")+/g)].map(([word]) =>
      word.replace(/'([^']*)'|"((?:[^"\\]|\\.)*)"|\\(.)/g, (_, single, double, one) => single ?? double ?? one),
    );
    const at = found.indexOf(">");
    return at < 0 ? { words: found } : { words: found.slice(0, at), to: found[at + 1] };
  }

  /** Command lines of a block, with continued lines joined; null for what is no command. */
  function linesOf(text, isConsole) {
    const joined = text.replace(/\\\n\s*/g, " ").split("\n");
    const asked = isConsole ? joined.filter((line) => line.startsWith("$ ")).map((line) => line.slice(2)) : joined;
    return asked
      .map((line) => line.replace(/\s+#\s.*$/, "").trim())
      .filter((line) => line !== "" && !line.startsWith("#"));
  }

  /** Why lines cannot run here, or an empty text. */
  function reason(lines) {
    const made = new Set();
    for (const line of lines) {
      if (!/^funicular\s/.test(line)) return `\`${line.split(/\s/)[0]}\` is another program`;
      if (/[|;&<`$]|>>/.test(line.replace(/'[^']*'|"[^"]*"/g, ""))) return "it needs a shell";
      const { words: all, to } = words(line);
      if (LONG.some((part) => line.includes(part))) return "it takes minutes on one thread";
      if (NO_COMMANDS[all[1]]) return NO_COMMANDS[all[1]];
      for (const [i, word] of all.entries()) {
        const option = all[i - 1]?.replace(/^--/, "").replaceAll("-", "_");
        const ending = word.match(/\.(\w+)$/)?.[1];
        const isWritten = all[i - 1] === "-o" || (all[i - 1]?.startsWith("--") && WRITES.includes(option));
        if (ending && NOT_HERE[ending]) return NOT_HERE[ending];
        if (/^[A-Z][A-Z-]*(\.\w+|…)?$/.test(word) && i > 0) return `\`${word}\` stands for your own word or file`;
        if (isWritten) made.add(word);
        else if (FILE.test(word) && !known.has(word) && !made.has(word)) return `\`${word}\` is a file of your own`;
      }
      if (to) made.add(to);
    }
    return "";
  }

  let loading = null;
  let worker = null;
  let waiting = null;

  function load() {
    loading ??= new Promise((resolve, reject) => {
      const script = document.createElement("script");
      script.src = `${FOLDER}program_data.js`;
      script.onload = async () => {
        try {
          const bytes = Uint8Array.from(atob(PROGRAM_DATA.wasm), (letter) => letter.charCodeAt(0));
          const unpacked = new Blob([bytes]).stream().pipeThrough(new DecompressionStream("gzip"));
          resolve({
            wasm: await new Response(unpacked).arrayBuffer(),
            files: PROGRAM_DATA.files,
            code: PROGRAM_DATA.code,
          });
        } catch (error) {
          reject(error);
        }
      };
      script.onerror = () => reject(new Error("the program is not beside this page"));
      document.head.append(script);
    });
    return loading;
  }

  async function started() {
    if (worker) return worker;
    const { wasm, files, code } = await load();
    const address = URL.createObjectURL(new Blob([code], { type: "text/javascript" }));
    worker = new Worker(address);
    worker.onmessage = ({ data }) => waiting?.(data);
    worker.onerror = (event) => waiting?.({ error: event.message });
    worker.postMessage({ wasm, files });
    return worker;
  }

  /** Runs a command line in the worker; one at a time. */
  async function run(line) {
    const of = await started();
    const asked = words(line.replace(/^\$\s*/, "").replace(/^funicular\s+/, ""));
    return new Promise((resolve) => {
      waiting = resolve;
      of.postMessage({ words: asked.words, to: asked.to });
    });
  }

  function stop() {
    worker?.terminate();
    worker = null;
    waiting?.({ stopped: true });
  }

  function made(tag, properties, ...children) {
    const element = Object.assign(document.createElement(tag), properties);
    element.append(...children);
    return element;
  }

  /** What a run has written: pages in frames, everything as a download. */
  function shownFiles(written) {
    const list = made("ul", { className: "run-files" });
    for (const [path, bytes] of Object.entries(written)) {
      const ending = path.match(/\.(\w+)$/)?.[1] ?? "";
      const type =
        { html: "text/html", svg: "image/svg+xml", pdf: "application/pdf" }[ending] ?? "application/octet-stream";
      const href = URL.createObjectURL(new Blob([bytes], { type }));
      const item = made(
        "li",
        {},
        made("a", { href, download: path.replace(/.*\//, "") }, path),
        ` (${bytes.length} bytes)`,
      );
      if (ending === "html") {
        const frame = made("iframe", { src: href, title: path, className: "run-page" });
        frame.setAttribute("sandbox", "allow-scripts allow-downloads");
        item.append(frame);
      }
      if (ending === "svg") item.append(made("img", { src: href, alt: path }));
      list.append(item);
    }
    return list;
  }

  function begin(block, pre, lines) {
    const before = [...pre.childNodes];
    const field = made("textarea", {
      className: "run-lines",
      spellcheck: false,
      rows: lines.length,
      value: lines.join("\n"),
    });
    field.setAttribute("aria-label", "Command lines");
    const go = made("button", { type: "button" }, "Run");
    const end = made("button", { type: "button", disabled: true }, "Stop");
    const back = made("button", { type: "button" }, "Reset");
    const state = made("span", { className: "run-state" });
    state.setAttribute("role", "status");
    const files = made("div", {});
    const bar = made("div", { className: "run-bar" }, field, go, end, back, state);
    block.before(bar);
    block.after(files);

    async function compute() {
      go.disabled = true;
      end.disabled = false;
      state.textContent = "running …";
      pre.replaceChildren();
      files.replaceChildren();
      let code = 0;
      for (const line of linesOf(field.value, false)) {
        pre.append(`$ ${line}\n`);
        if (!/^(\$\s*)?funicular(\s|$)/.test(line)) {
          pre.append("only `funicular` is here\n");
          code = 127;
          break;
        }
        const found = await run(line);
        if (found.stopped || found.error) {
          state.textContent = found.error ?? "stopped";
          code = null;
          break;
        }
        pre.append(found.stderr + found.stdout); // messages first, as the documents show them
        files.append(shownFiles(found.written));
        code = found.code;
        if (code !== 0) break;
      }
      if (code !== null) state.textContent = code === 0 ? "done" : `exit code ${code}`;
      go.disabled = false;
      end.disabled = true;
    }

    go.onclick = () => compute().catch((error) => (state.textContent = error.message));
    end.onclick = stop;
    back.onclick = () => {
      field.value = lines.join("\n");
      pre.replaceChildren(...before);
      files.replaceChildren();
      state.textContent = "";
    };
    field.onkeydown = (event) => {
      if (event.key === "Enter" && !event.shiftKey) {
        event.preventDefault();
        if (!go.disabled) go.click();
      }
    };
    go.click();
  }

  for (const block of document.querySelectorAll("div.highlight-console, div.highlight-sh")) {
    const pre = block.querySelector("pre");
    const lines = linesOf(pre.textContent, block.classList.contains("highlight-console"));
    if (!lines.some((line) => line.startsWith("funicular "))) continue;
    const why = reason(lines);
    if (why !== "") {
      const told = made("p", { className: "run-not" });
      told.append(
        "Not run in this page: ",
        ...why.split("`").map((part, i) => (i % 2 ? made("code", {}, part) : part)),
        ".",
      );
      block.after(told);
      continue;
    }
    const open = made("button", { type: "button", className: "run-open" }, "Run in this page");
    open.onclick = () => {
      open.remove();
      begin(block, pre, lines);
    };
    block.after(open);
  }
})();
