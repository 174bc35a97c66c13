// The crates whose code an artefact contains, as cargo resolves them: no macros, no build scripts, no crates of tests.
import { ALL } from "../numerics.mjs";
import { WASM } from "../setup.mjs";
import { Failure, ask } from "../shell.mjs";
import { NOTICES } from "./text.mjs";

/** Wheels and command lines are built for more systems than these; none of them brings crates of its own. */
const NATIVE = ["x86_64-unknown-linux-gnu", "aarch64-apple-darwin"].map((target) => [`--target=${target}`]);

/** What is compiled, how often and with which arguments, and where the notices of its crates are written down. */
export const ARTEFACTS = [
  {
    file: NOTICES,
    title: "The sources of bimodal-stereo hold no code of others. Contained in its .wasm files:",
    manifest: "Cargo.toml",
    crate: "bimodal-stereo",
    // As one argument each, so that all builds together name each once.
    builds: ALL.map(({ features = [] }) => [`--target=${WASM}`, features.join("=")].filter(Boolean)),
  },
  {
    file: `cli/${NOTICES}`,
    title: "The sources of the command line hold no code of others. Contained in it once it is compiled:",
    manifest: "cli/Cargo.toml",
    crate: "bimodal-stereo-cli",
    builds: NATIVE,
  },
  {
    file: `python/${NOTICES}`,
    title: "Contained in the compiled module of the Python package bimodal-stereo:",
    manifest: "python/Cargo.toml",
    crate: "bimodal-stereo-python",
    builds: NATIVE,
  },
];

/** Crates of a registry; those of the project have a path behind their version. */
const FOREIGN = /^(\S+) v(\S+)(?: \(\*\))?$/;

/** The crates of all builds of an artefact, each as "name version", sorted. */
export function cratesOf({ manifest, crate, builds }) {
  const which = ["--locked", "--manifest-path", manifest, "--package", crate];
  const tree = ["tree", ...which, "--edges", "normal,no-proc-macro", "--prefix", "none"];
  const lines = builds.flatMap((build) => {
    const answer = ask("cargo", [...tree, ...build]);
    if (answer === undefined) throw new Failure(`"cargo tree" failed for ${manifest}: ${build.join(" ")}`);
    return answer.split("\n");
  });
  const found = lines.map((line) => FOREIGN.exec(line)).filter((match) => match !== null);
  return [...new Set(found.map(([, name, version]) => `${name} ${version}`))].sort();
}
