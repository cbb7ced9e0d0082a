// Builds the page: a folder for a server, and one file that opens without a server.
//
// node build.mjs FOLDER LICENCES     FOLDER has funicular.wasm; the page is written into it. LICENCES is the file of
// the licences of all crates in the module

import { build } from "esbuild";
import { readdirSync, readFileSync, writeFileSync } from "node:fs";
import { dirname, join } from "node:path";
import { fileURLToPath } from "node:url";
import { brotliCompressSync, gzipSync } from "node:zlib";

const here = dirname(fileURLToPath(import.meta.url));
const folder = process.argv[2];
const version = /^version = "(.*)"/m.exec(readFileSync(join(here, "../../../Cargo.toml"), "utf8"))[1];

// Robots of the library: their texts are part of the page.
const robots = Object.fromEntries(
  readdirSync(join(here, "../../../robots"))
    .filter((name) => name.endsWith(".toml") && name !== "Cargo.toml")
    .sort()
    .map((name) => [name.replace(".toml", ""), readFileSync(join(here, "../../../robots", name), "utf8")]),
);

const common = {
  bundle: true,
  minify: true,
  format: "iife",
  target: "es2022",
  legalComments: "none",
  write: false,
  logLevel: "warning",
  absWorkingDir: here,
};
const text = async (options) => (await build({ ...common, ...options })).outputFiles[0].text;
const worker = await text({ entryPoints: ["src/worker.js"] });
const define = { WORKER: JSON.stringify(worker), ROBOTS: JSON.stringify(robots), VERSION: JSON.stringify(version) };
const whole = await build({ ...common, entryPoints: ["src/main.js"], define, metafile: true });
const script = whole.outputFiles[0].text;
const style = await text({ entryPoints: ["style.css"], format: undefined });

// Licences of the libraries in the page.
const inputs = Object.keys(whole.metafile.inputs).map((path) => /^node_modules\/((?:@[^/]+\/)?[^/]+)/.exec(path)?.[1]);
const libraries = [...new Set(inputs.filter(Boolean))].sort().map((name) => {
  const about = JSON.parse(readFileSync(join(here, "node_modules", name, "package.json"), "utf8"));
  const file = readdirSync(join(here, "node_modules", name)).find((entry) => /^licen[cs]e/i.test(entry));
  if (about.license !== "MIT" || file === undefined) {
    throw new Error(
      `${name} has the licence ${about.license}, and ${file ?? "no"} text of it: check whether the page may contain it`,
    );
  }
  return `${name} ${about.version}\n\n${readFileSync(join(here, "node_modules", name, file), "utf8").trim()}`;
});
const licences = [readFileSync(process.argv[3], "utf8").trim(), ...libraries].join("\n\n----\n\n");

const template = readFileSync(join(here, "index.html"), "utf8");
const put = (page, name, content) => page.replace(`<!-- ${name} -->`, () => content);
const inScript = (code) => code.replaceAll("</script", "<\\/script").replaceAll("<!--", "<\\!--");
const wasm = readFileSync(join(folder, "funicular.wasm"));
const packed = gzipSync(wasm, { level: 1 });

const common2 = put(template, "licences", licences.replaceAll("&", "&amp;").replaceAll("<", "&lt;"));
const inFolder = put(
  put(put(common2, "style", '<link rel="stylesheet" href="page.css">'), "core", ""),
  "script",
  '<script src="page.js"></script>',
);
const alone = put(
  put(
    put(common2, "style", `<style>${style}</style>`),
    "core",
    `<script id="core" type="application/octet-stream">${packed.toString("base64")}</script>`,
  ),
  "script",
  `<script>${inScript(script)}</script>`,
);
writeFileSync(join(folder, "page.js"), script);
writeFileSync(join(folder, "page.css"), style);
writeFileSync(join(folder, "index.html"), inFolder);
writeFileSync(join(folder, "funicular.html"), alone);

// Sizes as a browser downloads them, and the part of the editor.
const compressed = (content) => gzipSync(content, { level: 9 }).length;
const outputs = Object.values(whole.metafile.outputs)[0].inputs;
const bytes = (pattern) =>
  Object.entries(outputs).reduce((sum, [path, { bytesInOutput }]) => sum + (pattern.test(path) ? bytesInOutput : 0), 0);
const editor =
  (bytes(/@codemirror|@lezer|style-mod|crelt|w3c-keyname|@marijn|editor\.js/) / script.length) * compressed(script);
const all = packed.length + compressed(script) + compressed(style) + compressed(inFolder);
// As servers send it: all browsers accept Brotli. The single file is unpacked by the page itself, which knows gzip
// only.
const served = [wasm, script, style, inFolder].reduce((sum, content) => sum + content.length, 0);
const servedEditor = (editor / compressed(script)) * script.length;
const kb = (size) => `${Math.round(size / 1000)} kB`;
console.log(
  `with Brotli: ${kb(served)}, without the editor ${kb(served - servedEditor)}; with gzip: ${kb(all)} (core ` +
    `${kb(packed.length)}, script ${kb(compressed(script))}, of it the editor ${kb(editor)}); funicular.html ` +
    `${kb(Buffer.byteLength(alone))}`,
);
writeFileSync(
  join(folder, "sizes.json"),
  JSON.stringify({
    all,
    withoutEditor: Math.round(all - editor),
    served,
    servedWithoutEditor: Math.round(served - servedEditor),
    file: Buffer.byteLength(alone),
  }),
);
