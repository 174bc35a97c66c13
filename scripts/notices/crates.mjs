// The crates whose code an artefact contains, as cargo resolves them: no macros, no build scripts, no test dependencies.
import { ALL } from "../numerics.mjs";
import { WASM } from "../setup.mjs";
import { Failure, ask } from "../shell.mjs";
import { NOTICES } from "./text.mjs";

/** Wheels and command lines are also built for other systems; none of them adds crates. */
const NATIVE = ["x86_64-unknown-linux-gnu", "aarch64-apple-darwin"].map((target) => [`--target=${target}`]);

/** The artefacts, each with its builds, their arguments, and the file with the notices of its crates. */
export const ARTEFACTS = [
  {
    file: NOTICES,
    title: "The sources of bimodal-stereo hold no code of others. Contained in its .wasm files:",
    manifest: "Cargo.toml",
    crate: "bimodal-stereo",
    // Each option is one argument, so that the arguments of all builds can be merged without repetition.
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

/** Crates of a registry; the project's own have a path after their version. */
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
