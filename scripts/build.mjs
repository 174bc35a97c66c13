// npm run build: leaves the installable package in pkg/.
import { cpSync, existsSync, mkdirSync, readFileSync, realpathSync, rmSync, statSync, writeFileSync } from "node:fs";
import { gzipSync } from "node:zlib";
import { WASM, setup, tool } from "./setup.mjs";
import { inRoot, must, say, script, seconds, stamp } from "./shell.mjs";

const CARRIED = ["README.md", "CHANGELOG.md", "LICENSE-MIT", "LICENSE-APACHE"];
const SOURCES = ["src", "js", "Cargo.toml", "Cargo.lock", "rust-toolchain.toml", ".cargo", "package-lock.json"];
const MARK = "pkg/.stamp";
const MODULE = "bimodal_stereo";
/** Declarations that no entry mentions; one of them names the generated bindings, which stay inside. */
const INTERNAL = ["check", "engine", "node", "npy"];

const node = (module, ...args) => must(process.execPath, [inRoot("node_modules", module), ...args]);

/** What the package says about itself; name, version and licence come from Cargo.toml alone. */
function manifest() {
  const cargo = readFileSync(inRoot("Cargo.toml"), "utf8");
  const field = (name) => new RegExp(`^${name} = "(.+)"$`, "m").exec(cargo)[1];
  const keywords = /^keywords = \[(.+)\]$/m.exec(cargo)[1];
  return {
    name: field("name"),
    version: field("version"),
    description: field("description"),
    keywords: JSON.parse(`[${keywords}]`),
    license: `(${field("license")})`,
    type: "module",
    engines: { node: "^20.19.0 || >=22.12.0" },
    sideEffects: false,
    exports: {
      ".": { types: "./index.d.ts", node: "./node.js", default: "./index.js" },
      "./files": { types: "./files.d.ts", default: "./files.js" },
      [`./${MODULE}_bg.wasm`]: `./${MODULE}_bg.wasm`,
      "./package.json": "./package.json",
    },
    types: "./index.d.ts",
    files: ["*.js", "*.d.ts", "*.wasm", ...CARRIED],
  };
}

async function numerics() {
  // Level 3 unrolls and inlines for a tenth of speed and a sixth of size; see .cargo/config.toml.
  await must("cargo", ["build", "--release", "--lib", "--target", WASM, "--target-dir", "target"], {
    env: { CARGO_PROFILE_RELEASE_OPT_LEVEL: "2" },
  });
  await must(tool("wasm-bindgen"), [
    ...["--target", "web", "--omit-default-module-path", "--out-dir", "target/wasm-bindgen"],
    `target/${WASM}/release/${MODULE}.wasm`,
  ]);
  await node("binaryen/bin/wasm-opt", "-O3", `target/wasm-bindgen/${MODULE}_bg.wasm`, "-o", `pkg/${MODULE}_bg.wasm`);
}

/** One file for each entry and one for what they share, with the PNG decoder in the files module alone. */
async function facade() {
  const { rolldown } = await import("rolldown");
  const bundle = await rolldown({
    input: { index: inRoot("js/index.ts"), node: inRoot("js/node.ts"), files: inRoot("js/files.ts") },
    external: /^node:/,
    platform: "neutral",
    resolve: { mainFields: ["module", "main"] },
  });
  await bundle.write({ dir: inRoot("pkg"), format: "esm", chunkFileNames: "[name].js" });
  await bundle.close();
  await node("typescript/bin/tsc", "-p", "js/tsconfig.json");
  for (const name of INTERNAL) rmSync(inRoot(`pkg/${name}.d.ts`));
}

export async function build() {
  const wanted = stamp([...SOURCES, ...CARRIED, "scripts/build.mjs"]);
  const complete = [MARK, `target/wasm-bindgen/${MODULE}.d.ts`].every((path) => existsSync(inRoot(path)));
  if (complete && readFileSync(inRoot(MARK), "utf8") === wanted) return say("pkg/ is up to date");
  const start = performance.now();
  say("building pkg/");
  rmSync(inRoot("pkg"), { recursive: true, force: true });
  mkdirSync(inRoot("pkg"));
  await numerics();
  await facade();
  for (const file of CARRIED) cpSync(inRoot(file), inRoot("pkg", file));
  writeFileSync(inRoot("pkg/package.json"), `${JSON.stringify(manifest(), null, 2)}\n`);
  writeFileSync(inRoot(MARK), wanted);

  const wasm = inRoot(`pkg/${MODULE}_bg.wasm`);
  const kilobytes = (bytes) => `${(bytes / 1000).toFixed(0)} kB`;
  const zipped = gzipSync(readFileSync(wasm)).length;
  say(`built pkg/ (${seconds(start)}); wasm ${kilobytes(statSync(wasm).size)}, ${kilobytes(zipped)} gzipped`);
}

// Node names this module by its real path, and the command by the path it was given.
if (import.meta.filename === realpathSync(process.argv[1])) {
  await script(async () => {
    await setup();
    await build();
  });
}
