// The npm package as its user meets it: packed, installed in an empty folder without a network, imported in Node,
// bundled, and checked by TypeScript. Run by scripts/web. FUNICULAR_WEB: folder with the package `npm`.

import assert from "node:assert/strict";
import { spawnSync } from "node:child_process";
import { mkdtempSync, readFileSync, readdirSync, rmSync, writeFileSync } from "node:fs";
import { tmpdir } from "node:os";
import { join, resolve } from "node:path";
import { after, before, test } from "node:test";

const web = resolve(process.env.FUNICULAR_WEB);
const tools = resolve(import.meta.dirname, "../page/node_modules/.bin");
const robot = readFileSync(resolve(import.meta.dirname, "../../../robots/cogiro.toml"), "utf8");
const folder = mkdtempSync(join(tmpdir(), "funicular-npm-"));
after(() => rmSync(folder, { recursive: true }));

function run(name, ...words) {
  const { status, stdout, stderr } = spawnSync(name, words, { cwd: folder, encoding: "utf8" });
  return { status, stdout, stderr };
}

function succeed(name, ...words) {
  const { status, stdout, stderr } = run(name, ...words);
  assert.equal(status, 0, `${name} ${words.join(" ")}: ${(stdout + stderr).slice(-2000)}`);
  return stdout;
}

before(() => {
  succeed("npm", "pack", join(web, "npm"), "--pack-destination", folder, "--loglevel", "error");
  const packed = readdirSync(folder).filter((name) => name.endsWith(".tgz"));
  assert.equal(packed.length, 1);
  writeFileSync(join(folder, "package.json"), JSON.stringify({ private: true, type: "module" }));
  writeFileSync(join(folder, "cogiro.toml"), robot);
  succeed("npm", "install", "--offline", "--no-audit", "--no-fund", "--loglevel", "error", `./${packed[0]}`);
});

const SCRIPT = `
const text = readFileSync("cogiro.toml", "utf8");
const found = funicular.answer({ command: "statics", pose: [1, 2, 1.5] }, text);
let refused = "";
try {
  funicular.answer({ command: "statics", poze: [1, 2, 1.5] }, text);
} catch (error) {
  refused = error instanceof RequestError ? error.status + " " + error.message : String(error);
}
console.log(JSON.stringify({ tension: found.cables.map((cable) => cable.tension_platform_n), refused }));
`;

/** What the script prints is what the program computes. */
function check(printed) {
  const { tension, refused } = JSON.parse(printed);
  const program = resolve(process.env.FUNICULAR_PROGRAM);
  const native = JSON.parse(succeed(program, "statics", "cogiro.toml", "--pose", "1,2,1.5", "--format", "json"));
  native.cables.forEach((cable, i) => assert.ok(Math.abs(tension[i] / cable.tension_platform_n - 1) < 1e-9));
  assert.equal(tension.length, 8);
  assert.match(refused, /^2 .*did you mean `pose`\?/);
}

test("the package has licences, a description, and nothing else", () => {
  const installed = join(folder, "node_modules/funicular-cdpr");
  const about = JSON.parse(readFileSync(join(installed, "package.json"), "utf8"));
  const cargo = readFileSync(resolve(import.meta.dirname, "../../../Cargo.toml"), "utf8");
  assert.ok(cargo.includes(`version = "${about.version}"`));
  assert.equal(about.dependencies, undefined);
  const wanted = ["LICENSE-APACHE", "LICENSE-MIT", "LICENSE-THIRD-PARTY.txt", "README.md", "funicular.js"];
  wanted.push("funicular.wasm", "index.d.ts", "index.js", "package.json", "schema.d.ts");
  assert.deepEqual(readdirSync(installed).sort(), wanted);
});

test("it runs in Node", () => {
  const head = 'import { readFileSync } from "node:fs";\nimport { RequestError, start } from "funicular-cdpr";\n';
  writeFileSync(join(folder, "node.js"), `${head}const funicular = await start();\n${SCRIPT}`);
  check(succeed(process.execPath, "node.js"));
});

test("the example of its README runs", () => {
  const readme = readFileSync(join(web, "npm/README.md"), "utf8");
  writeFileSync(join(folder, "readme.js"), /```js\n([\s\S]*?)```/.exec(readme)[1]);
  assert.equal(succeed(process.execPath, "readme.js").match(/\d+\.\d+/g).length, 8);
});

test("it runs bundled", () => {
  const head = 'import { readFileSync } from "node:fs";\nimport { RequestError, load } from "funicular-cdpr";\n';
  const start = 'import bytes from "funicular-cdpr/funicular.wasm";\nconst funicular = await load(bytes);\n';
  writeFileSync(join(folder, "bundled.js"), head + start + SCRIPT);
  const how = [
    "--bundle",
    "--format=esm",
    "--platform=node",
    "--target=node20",
    "--loader:.wasm=binary",
    "--outfile=bundle.mjs",
  ];
  succeed(join(tools, "esbuild"), "bundled.js", ...how, "--log-level=warning");
  rmSync(join(folder, "node_modules/funicular-cdpr/funicular.wasm"));
  check(succeed(process.execPath, "bundle.mjs"));
});

test("TypeScript knows the requests and the results", () => {
  const options = ["--noEmit", "--strict", "--target", "es2022", "--module", "nodenext", "--lib", "es2022,dom"];
  const typed = (code) => {
    writeFileSync(
      join(folder, "typed.ts"),
      `import { start } from "funicular-cdpr";\nconst it = await start();\n${code}`,
    );
    return run(join(tools, "tsc"), ...options, "typed.ts");
  };
  const right = typed(`const found = it.answer({ command: "statics", pose: [1, 2, 1.5] }, "");
const tension: number = found.cables[0]!.tension_platform_n;
console.log(tension);\n`);
  assert.equal(right.status, 0, right.stdout + right.stderr);
  for (const [code, says] of [
    ['it.answer({ command: "statics", poze: [1, 2, 1.5] }, "");\n', "poze"],
    ['it.answer({ command: "static" }, "");\n', "static"],
    ['console.log(it.answer({ command: "statics" }, "").cabels);\n', "cabels"],
  ]) {
    const wrong = typed(code);
    assert.ok(wrong.status !== 0 && wrong.stdout.includes(says), wrong.stdout);
  }
});
