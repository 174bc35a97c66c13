// The .wasm files: compiled, bound, made small. Built anew where what they are made of has changed, and nowhere else.
import { existsSync, readFileSync, rmSync, writeFileSync } from "node:fs";
import { homedir } from "node:os";
import { WASM, tool } from "./setup.mjs";
import { Failure, inRoot, must, stamp } from "./shell.mjs";
import { withoutFeature } from "./wasm-features.mjs";

/** What the .wasm files are made of; the rest of the sources is bundled in a second. */
export const NUMERICS = [
  "src",
  "Cargo.toml",
  "Cargo.lock",
  "rust-toolchain.toml",
  ".cargo",
  "scripts/numerics.mjs",
  "scripts/wasm-features.mjs",
];
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
  {
    file: `${MODULE}_scalar_bg.wasm`,
    target: "target/scalar",
    flags: ["-C", `target-feature=-${REFERENCES},-simd128`],
  },
];
/** The calibration check: bindings of its own, loaded on demand, for machines with SIMD and without. */
const CHECK = {
  file: `${MODULE}_check_bg.wasm`,
  target: "target/check",
  flags: ["-C", `target-feature=-${REFERENCES},-simd128`],
  features: ["--features", "bindings-check"],
  name: `${MODULE}_check`,
};
/** The rendered rigs of its tests and of the page's example, which nobody else downloads. */
const RIGS = {
  ...CHECK,
  file: `${MODULE}_rigs_bg.wasm`,
  target: "target/rigs",
  features: ["--features", "bindings-rigs"],
  name: `${MODULE}_rigs`,
};
/** All files of the package. */
export const ALL = [...FLAVOURS, CHECK, RIGS];

/** What the facade's types come from. */
export const GLUE = ALL.map(({ target, name = MODULE }) => `${target}/wasm-bindgen/${name}.d.ts`);

export const node = (module, ...args) => must(process.execPath, [inRoot("node_modules", module), ...args]);

async function numerics({ file, target, flags, features = ["--features", "bindings"], name = MODULE, sources = "." }) {
  // Messages of panics name files: without where they lie on this machine, which is nobody's business.
  const registry = `${process.env.CARGO_HOME ?? `${homedir()}/.cargo`}/registry/src/`;
  const config = `target.${WASM}.rustflags=${JSON.stringify([...flags, `--remap-path-prefix=${registry}=`])}`;
  // Level 3 unrolls and inlines for a tenth of speed and a sixth of size; see .cargo/config.toml.
  const crate = ["--manifest-path", `${sources}/Cargo.toml`, "-p", "bimodal-stereo", "--lib", ...features];
  await must("cargo", ["build", "--release", ...crate, "--target", WASM, "--target-dir", target, "--config", config], {
    env: { CARGO_PROFILE_RELEASE_OPT_LEVEL: "2" },
  });
  // The standard library was compiled with references, and the linker says so of the whole.
  const linked = inRoot(`${target}/${MODULE}.wasm`);
  const compiled = readFileSync(inRoot(`${target}/${WASM}/release/${MODULE}.wasm`));
  writeFileSync(linked, withoutFeature(compiled, REFERENCES));
  await must(tool("wasm-bindgen"), [
    ...["--target", "web", "--omit-default-module-path", "--out-dir", `${target}/wasm-bindgen`, "--out-name", name],
    linked,
  ]);
  // Level "z" gives the last kilobyte; speed is LLVM's work. Binaryen would put functions of one caller into it, whatever their size:
  // engines replace a function by its optimised code at its next call only, and what is one long loop would run slowly to its end.
  const apart = ["--one-caller-inline-max-function-size", "50"];
  // Nothing reads or writes the first kilobyte but the stack, if it overflows: so offsets fold into addresses.
  const smaller = ["-Oz", "--low-memory-unused"];
  // Repeated expressions compress better than a local variable that holds them.
  const repeated = ["--skip-pass=local-cse"];
  const bare = ["--strip-producers", "--strip-target-features"];
  await node(
    "binaryen/bin/wasm-opt",
    ...smaller,
    ...apart,
    ...repeated,
    ...bare,
    `${target}/wasm-bindgen/${name}_bg.wasm`,
    "-o",
    `target/${file}`,
  );
}

/** Builds the .wasm files where their sources have changed. */
export async function allNumerics() {
  const wanted = stamp(NUMERICS);
  const made = ALL.flatMap(({ file, target, name = MODULE }) => [
    `target/${file}`,
    `${target}/wasm-bindgen/${name}.js`,
  ]);
  const isMade = [NUMERICS_MARK, ...made].every((path) => existsSync(inRoot(path)));
  if (isMade && readFileSync(inRoot(NUMERICS_MARK), "utf8") === wanted) return;
  rmSync(inRoot(NUMERICS_MARK), { force: true });
  // Side by side: the last and longest crate of each keeps one processor busy.
  await Promise.all(ALL.map(numerics));
  checkGlue();
  writeFileSync(inRoot(NUMERICS_MARK), wanted);
}

/** The .wasm with SIMD of other `sources`, as `target/{file}`; the package's own glue must be able to load it. */
export async function numericsOf({ sources, target, file }) {
  await numerics({ ...FLAVOURS[0], sources, target, file });
  checkGlue([FLAVOURS[0], { target }]);
}

/** One glue loads either file, so both must have been given the same: its imports, and what is exported with which types. */
function checkGlue(flavours = FLAVOURS) {
  for (const name of [`${MODULE}.js`, `${MODULE}.d.ts`, `${MODULE}_bg.wasm.d.ts`]) {
    const paths = flavours.map(({ target }) => `${target}/wasm-bindgen/${name}`);
    const [first, ...others] = paths.map((path) => readFileSync(inRoot(path), "utf8"));
    if (others.some((text) => text !== first)) {
      throw new Failure(`${paths.join(" and ")} differ, so that one package cannot load both: compare them with diff.`);
    }
  }
}
