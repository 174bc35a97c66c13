// npm run build: leaves the installable package in pkg/.
import { cpSync, existsSync, mkdirSync, readFileSync, realpathSync, rmSync, writeFileSync } from "node:fs";
import { homedir } from "node:os";
import { gzipSync } from "node:zlib";
import { WASM, setup, tool } from "./setup.mjs";
import { withoutFeature } from "./wasm-features.mjs";
import { Failure, inRoot, must, say, script, seconds, stamp } from "./shell.mjs";

const COPIED = ["README.md", "CHANGELOG.md", "LICENSE-MIT", "LICENSE-APACHE"];
/** What the .wasm files are made of; the rest of the sources is bundled in a second. */
const NUMERICS = ["src", "Cargo.toml", "Cargo.lock", "rust-toolchain.toml", ".cargo", "scripts/build.mjs", "scripts/wasm-features.mjs"];
const SOURCES = [...NUMERICS, "js", "package-lock.json"];
const MARK = "pkg/.stamp";
const NUMERICS_MARK = "target/.numerics-stamp";
const MODULE = "bimodal_stereo";
/**
 * Where it may, wasm-bindgen lets exports return references. Node 20 aborts as a whole when it throws away optimised code that is
 * inside such a call (V8 11.3, "unreachable code" in its deoptimiser), so neither the crates nor, further down, the tool are told
 * that they may.
 */
const REFERENCES = "reference-types";
/**
 * The facade is bundled with the first one's glue. A target folder each, so that neither build throws away the other's crates.
 * Cargo appends these to the flags of .cargo/config.toml, and of two opposite features the later one counts.
 */
const FLAVOURS = [
  { file: `${MODULE}_bg.wasm`, target: "target", flags: ["-C", `target-feature=-${REFERENCES}`] },
  { file: `${MODULE}_scalar_bg.wasm`, target: "target/scalar", flags: ["-C", `target-feature=-${REFERENCES},-simd128`] },
];
/** One for programs, two for what reads files, one for the page's fields, and one for the threads of workers. */
const ENTRIES = { index: "index", files: "files", rig: "rig/index", options: "options", thread: "workers/thread" };
/** Declarations that no entry mentions; one of them names the generated bindings, which stay inside. */
const INTERNAL = [
  ...["rig/colour.d.ts", "rig/assign.d.ts", "rig/depth.d.ts", "rig/formats", "rig/words.d.ts"],
  ...["check.d.ts", "engine.d.ts", "inflate.d.ts", "node.d.ts", "npy.d.ts", "plain.d.ts", "png.d.ts", "raster.d.ts", "workers"],
];

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
      ".": { types: "./index.d.ts", default: "./index.js" },
      "./files": { types: "./files.d.ts", default: "./files.js" },
      "./rig": { types: "./rig/index.d.ts", default: "./rig.js" },
      ...Object.fromEntries(FLAVOURS.map(({ file }) => [`./${file}`, `./${file}`])),
      "./package.json": "./package.json",
    },
    types: "./index.d.ts",
    files: ["*.js", "*.d.ts", "*.wasm", "rig", ...COPIED],
  };
}

async function numerics({ file, target, flags }) {
  // Messages of panics name files: without where they lie on this machine, which is nobody's business.
  const registry = `${process.env.CARGO_HOME ?? `${homedir()}/.cargo`}/registry/src/`;
  const config = `target.${WASM}.rustflags=${JSON.stringify([...flags, `--remap-path-prefix=${registry}=`])}`;
  // Level 3 unrolls and inlines for a tenth of speed and a sixth of size; see .cargo/config.toml.
  await must("cargo", ["build", "--release", "--lib", "--target", WASM, "--target-dir", target, "--config", config], {
    env: { CARGO_PROFILE_RELEASE_OPT_LEVEL: "2" },
  });
  // The standard library was compiled with references, and the linker says so of the whole.
  const linked = inRoot(`${target}/${MODULE}.wasm`);
  const compiled = readFileSync(inRoot(`${target}/${WASM}/release/${MODULE}.wasm`));
  writeFileSync(linked, withoutFeature(compiled, REFERENCES));
  await must(tool("wasm-bindgen"), [
    ...["--target", "web", "--omit-default-module-path", "--out-dir", `${target}/wasm-bindgen`],
    linked,
  ]);
  // Level "z" gives the last kilobyte; speed is LLVM's work. Binaryen would put functions of one caller into it, whatever their size:
  // engines replace a function by its optimised code at its next call only, and what is one long loop would run slowly to its end.
  const apart = ["--one-caller-inline-max-function-size", "50"];
  // Nothing reads or writes the first kilobyte but the stack, if it overflows: so offsets fold into addresses.
  const smaller = ["-Oz", "--gufa", "--converge", "--coalesce-locals-learning", "--low-memory-unused"];
  const bare = ["--strip-producers", "--strip-target-features"];
  await node("binaryen/bin/wasm-opt", ...smaller, ...apart, ...bare, `${target}/wasm-bindgen/${MODULE}_bg.wasm`, "-o", `target/${file}`);
}

/** Builds the .wasm files where their sources have changed. */
async function allNumerics() {
  const wanted = stamp(NUMERICS);
  const made = FLAVOURS.flatMap(({ file, target }) => [`target/${file}`, `${target}/wasm-bindgen/${MODULE}.js`]);
  const isMade = [NUMERICS_MARK, ...made].every((path) => existsSync(inRoot(path)));
  if (isMade && readFileSync(inRoot(NUMERICS_MARK), "utf8") === wanted) return;
  rmSync(inRoot(NUMERICS_MARK), { force: true });
  // Side by side: the last and longest crate of each keeps one processor busy.
  await Promise.all(FLAVOURS.map(numerics));
  checkGlue();
  writeFileSync(inRoot(NUMERICS_MARK), wanted);
}

/** One glue loads either file, so both must have been given the same: its imports, and what is exported with which types. */
function checkGlue() {
  for (const name of [`${MODULE}.js`, `${MODULE}.d.ts`, `${MODULE}_bg.wasm.d.ts`]) {
    const paths = FLAVOURS.map(({ target }) => `${target}/wasm-bindgen/${name}`);
    const [first, ...others] = paths.map((path) => readFileSync(inRoot(path), "utf8"));
    if (others.some((text) => text !== first)) {
      throw new Failure(`${paths.join(" and ")} differ, so that one package cannot load both: compare them with diff.`);
    }
  }
}

/** One file for each entry and one for what they share, with the PNG decoder in the files module alone. */
async function facade() {
  const { rolldown } = await import("rolldown");
  const bundle = await rolldown({
    input: Object.fromEntries(Object.entries(ENTRIES).map(([name, source]) => [name, inRoot(`js/${source}.ts`)])),
    external: /^node:/,
    platform: "neutral",
    resolve: { mainFields: ["module", "main"] },
  });
  await bundle.write({ dir: inRoot("pkg"), format: "esm", chunkFileNames: "[name].js" });
  await bundle.close();
  await node("typescript/bin/tsc", "-p", "js/tsconfig.json");
  for (const name of INTERNAL) rmSync(inRoot("pkg", name), { recursive: true });
}

export async function build() {
  const wanted = stamp([...SOURCES, ...COPIED]);
  const complete = [MARK, `target/wasm-bindgen/${MODULE}.d.ts`].every((path) => existsSync(inRoot(path)));
  if (complete && readFileSync(inRoot(MARK), "utf8") === wanted) return say("pkg/ is up to date");
  const start = performance.now();
  say("building pkg/");
  rmSync(inRoot("pkg"), { recursive: true, force: true });
  mkdirSync(inRoot("pkg"));
  await allNumerics();
  for (const { file } of FLAVOURS) cpSync(inRoot(`target/${file}`), inRoot("pkg", file));
  await facade();
  for (const file of COPIED) cpSync(inRoot(file), inRoot("pkg", file));
  writeFileSync(inRoot("pkg/package.json"), `${JSON.stringify(manifest(), null, 2)}\n`);
  writeFileSync(inRoot(MARK), wanted);

  const kilobytes = (bytes) => `${(bytes / 1000).toFixed(0)} kB`;
  say(`built pkg/ (${seconds(start)})`);
  for (const { file } of FLAVOURS) {
    const bytes = readFileSync(inRoot("pkg", file));
    say(`${file}: ${kilobytes(bytes.length)}, ${kilobytes(gzipSync(bytes).length)} gzipped`);
  }
}

// Node names this module by its real path, and the command by the path it was given.
if (import.meta.filename === realpathSync(process.argv[1])) {
  await script(async () => {
    await setup();
    await build();
  });
}
