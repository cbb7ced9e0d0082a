// Makes the npm package of the module: the module with its loader, types from the schemas that the module writes, licences.
//
// node npm.mjs FOLDER     FOLDER has funicular.wasm, funicular.js and LICENSE-THIRD-PARTY.txt; the package is FOLDER/npm

import { compile } from "json-schema-to-typescript";
import { copyFileSync, mkdirSync, readFileSync, rmSync, writeFileSync } from "node:fs";
import { dirname, join, resolve } from "node:path";
import { fileURLToPath, pathToFileURL } from "node:url";

const here = dirname(fileURLToPath(import.meta.url));
const root = join(here, "../../..");
const folder = resolve(process.argv[2]);
const out = join(folder, "npm");
const cargo = readFileSync(join(root, "Cargo.toml"), "utf8");
const version = /^version = "(.*)"/m.exec(cargo)[1];
const repository = /^repository = "(.*)"/m.exec(cargo)[1];

const { load } = await import(pathToFileURL(join(folder, "funicular.js")));
const funicular = await load(readFileSync(join(folder, "funicular.wasm")));
const requests = funicular.answer({ command: "schema", of: "request" });
const results = funicular.answer({ command: "schema", of: "results" });

/** Schema of an object with one key per command. */
const byCommand = (title, of, more) => ({
  title,
  type: "object",
  additionalProperties: false,
  properties: of,
  required: Object.keys(of),
  ...more,
});
const options = { bannerComment: "", additionalProperties: false, unreachableDefinitions: false, maxItems: 8 };

const asked = Object.fromEntries(
  requests.oneOf.map((one) => [one.properties.command.const, { ...one, title: undefined }]),
);
const found = Object.fromEntries(Object.keys(results.$defs).map((name) => [name, { $ref: `#/$defs/${name}` }]));
const types = [
  await compile(byCommand("Requests", asked), "Requests", options),
  // The titles of results are names of their types in Rust, which several commands share.
  await compile(byCommand("Results", found, { $defs: results.$defs }), "Results", options),
];

rmSync(out, { recursive: true, force: true });
mkdirSync(out, { recursive: true });
for (const name of ["funicular.js", "funicular.wasm", "LICENSE-THIRD-PARTY.txt"]) {
  copyFileSync(join(folder, name), join(out, name));
}
for (const name of ["LICENSE-MIT", "LICENSE-APACHE"]) {
  copyFileSync(join(root, name), join(out, name));
}
for (const name of ["index.js", "README.md"]) {
  copyFileSync(join(here, "../npm", name), join(out, name));
}
const declared = readFileSync(join(here, "../npm/index.d.ts"), "utf8");
writeFileSync(join(out, "schema.d.ts"), `// Made from the schemas of requests and results.\n\n${types.join("\n")}`);
writeFileSync(join(out, "index.d.ts"), declared);
const about = {
  name: "funicular-cdpr",
  version,
  description: "Statics and vibration of cable-driven parallel robots whose cables sag: the WebAssembly module",
  keywords: ["robotics", "cable-driven parallel robot", "catenary", "vibration", "statics", "wasm"],
  license: "MIT OR Apache-2.0",
  homepage: repository,
  repository: { type: "git", url: `git+${repository}.git`, directory: "crates/funicular-wasm" },
  bugs: `${repository}/issues`,
  type: "module",
  exports: {
    ".": { types: "./index.d.ts", default: "./index.js" },
    "./funicular.wasm": "./funicular.wasm",
    "./package.json": "./package.json",
  },
  types: "./index.d.ts",
  files: ["*.js", "*.d.ts", "*.wasm", "LICENSE-*", "README.md"],
  sideEffects: false,
  engines: { node: ">=20" },
};
writeFileSync(join(out, "package.json"), `${JSON.stringify(about, null, 2)}\n`);
console.log(`${out}: package of version ${version}`);
