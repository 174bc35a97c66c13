// The .wasm files: compiled, bound and optimised. They are rebuilt only if their sources have changed.
import { existsSync, mkdirSync, readFileSync, rmSync, writeFileSync } from "node:fs";
import { homedir } from "node:os";
import { WASM, tool } from "./setup.mjs";
import { Failure, inRoot, must, stamp } from "./shell.mjs";
import { withoutFeature } from "./wasm-features.mjs";

/** Sources of the .wasm files; the other sources are bundled within a second. */
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
 * If the target has this feature, wasm-bindgen lets exports return references. Node 20 aborts when it discards optimised code that is
 * inside such a call (V8 11.3, "unreachable code" in its deoptimiser). The feature is therefore disabled for the crates, and removed from
 * the module before wasm-bindgen runs.
 */
const REFERENCES = "reference-types";
/**
 * The facade is bundled with the glue of the first file. Builds with equal flags share compiled crates (`crates`), which are two thirds of
 * a build. Cargo appends these flags to those of .cargo/config.toml; of two opposite features, the later one counts.
 */
const FLAVOURS = [
  { file: `${MODULE}_bg.wasm`, target: "target", flags: ["-C", `target-feature=-${REFERENCES}`] },
  {
    file: `${MODULE}_scalar_bg.wasm`,
    target: "target/scalar",
    flags: ["-C", `target-feature=-${REFERENCES},-simd128`],
  },
];
/** The calibration check: separate bindings, loaded on demand, for machines with SIMD and without. */
const CHECK = {
  file: `${MODULE}_check_bg.wasm`,
  target: "target/check",
  crates: "target/scalar",
  flags: ["-C", `target-feature=-${REFERENCES},-simd128`],
  features: ["--features", "bindings-check"],
  name: `${MODULE}_check`,
};
/** Rendered rigs and pairs, and the suggestion of masks: for tests, the page's examples and its mask tool; nobody else downloads them. */
const RIGS = {
  ...CHECK,
  file: `${MODULE}_rigs_bg.wasm`,
  target: "target/rigs",
  features: ["--features", "bindings-rigs"],
  name: `${MODULE}_rigs`,
};
/** All files of the package. */
export const ALL = [...FLAVOURS, CHECK, RIGS];

/** The sources of the facade's types. */
export const GLUE = ALL.map(({ target, name = MODULE }) => `${target}/wasm-bindgen/${name}.d.ts`);

export const node = (module, ...args) => must(process.execPath, [inRoot("node_modules", module), ...args]);

/** Compiles the crate and keeps the module in `target`, before a build of other features replaces it. */
async function compile({ target, crates = target, flags, features = ["--features", "bindings"], sources = "." }) {
  // Panic messages name files; this strips their location on the building machine.
  const registry = `${process.env.CARGO_HOME ?? `${homedir()}/.cargo`}/registry/src/`;
  const config = `target.${WASM}.rustflags=${JSON.stringify([...flags, `--remap-path-prefix=${registry}=`])}`;
  // Level 3 would unroll and inline: a tenth faster and a sixth larger; see .cargo/config.toml.
  const crate = ["--manifest-path", `${sources}/Cargo.toml`, "-p", "bimodal-stereo", "--lib", ...features];
  await must("cargo", ["build", "--release", ...crate, "--target", WASM, "--target-dir", crates, "--config", config], {
    env: { CARGO_PROFILE_RELEASE_OPT_LEVEL: "2" },
  });
  // The standard library was compiled with references, so the linker declares the feature for the whole module.
  const compiled = readFileSync(inRoot(`${crates}/${WASM}/release/${MODULE}.wasm`));
  mkdirSync(inRoot(target), { recursive: true });
  writeFileSync(inRoot(`${target}/${MODULE}.wasm`), withoutFeature(compiled, REFERENCES));
}

/** Binds and optimises the compiled module. */
async function finish({ file, target, name = MODULE }) {
  const linked = inRoot(`${target}/${MODULE}.wasm`);
  await must(tool("wasm-bindgen"), [
    ...["--target", "web", "--omit-default-module-path", "--out-dir", `${target}/wasm-bindgen`, "--out-name", name],
    linked,
  ]);
  // Level "z" saves the last kilobyte; speed comes from LLVM. By default, Binaryen inlines functions with one caller, whatever their size.
  // Engines switch to a function's optimised code only at its next call, so one long loop would run slowly to its end.
  const apart = ["--one-caller-inline-max-function-size", "30"];
  // Only the stack uses the first kilobyte, and only if it overflows, so offsets can fold into addresses. A second pass shortens what the
  // first one leaves.
  const smaller = ["-Oz", "-Oz", "--low-memory-unused"];
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
  // Builds that share crates run one after the other. Other builds, and all steps after a compilation, run beside them.
  const cratesOf = ({ target, crates = target }) => crates;
  const groups = [...new Set(ALL.map(cratesOf))].map((folder) => ALL.filter((each) => cratesOf(each) === folder));
  await Promise.all(
    groups.map(async (group) => {
      const finished = [];
      for (const flavour of group) {
        await compile(flavour);
        finished.push(finish(flavour));
      }
      await Promise.all(finished);
    }),
  );
  checkGlue();
  writeFileSync(inRoot(NUMERICS_MARK), wanted);
}

/** The .wasm with SIMD from other `sources`, as `target/{file}`; the package's own glue must be able to load it. */
export async function numericsOf({ sources, target, file }) {
  const flavour = { ...FLAVOURS[0], sources, target, file };
  await compile(flavour);
  await finish(flavour);
  checkGlue([FLAVOURS[0], { target }]);
}

/** One glue loads either file, so both builds must agree: in the glue's imports, and in the exports and their types. */
function checkGlue(flavours = FLAVOURS) {
  for (const name of [`${MODULE}.js`, `${MODULE}.d.ts`, `${MODULE}_bg.wasm.d.ts`]) {
    const paths = flavours.map(({ target }) => `${target}/wasm-bindgen/${name}`);
    const [first, ...others] = paths.map((path) => readFileSync(inRoot(path), "utf8"));
    if (others.some((text) => text !== first)) {
      throw new Failure(`${paths.join(" and ")} differ, so that one package cannot load both: compare them with diff.`);
    }
  }
}
