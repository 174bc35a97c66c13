// Fetches everything that building and testing need, once: toolchain, wasm-bindgen, node_modules.
import { mkdirSync, readFileSync, writeFileSync } from "node:fs";
import { Failure, ask, inRoot, must, readIfThere, say, seconds, stamp } from "./shell.mjs";

export const WASM = "wasm32-unknown-unknown";
export const tool = (name) => inRoot("target/tools/bin", name);

function checkNode() {
  const [major, minor] = process.versions.node.split(".").map(Number);
  const enough = major > 22 || (major === 22 && minor >= 12) || (major === 20 && minor >= 19);
  if (!enough) throw new Failure(`Node 20.19+ or 22.12+ is needed, this is ${process.versions.node}.`);
}

/** rust-toolchain.toml installs nothing if automatic installation is switched off. */
async function toolchain() {
  if (ask("rustup", ["--version"]) === undefined) {
    throw new Failure("Rust is needed: install it from https://rustup.rs, open a new shell and try again.");
  }
  const file = readFileSync(inRoot("rust-toolchain.toml"), "utf8");
  const channel = /^channel = "(.+)"$/m.exec(file)[1];
  const list = (name) =>
    [...new RegExp(`^${name} = \\[(.+)\\]$`, "m").exec(file)[1].matchAll(/"([^"]+)"/g)].map((m) => m[1]);
  const [components, targets] = [list("components"), list("targets")];

  const has = (kind) => ask("rustup", [kind, "list", "--installed", "--toolchain", channel])?.split("\n") ?? [];
  const [hasComponents, hasTargets] = [has("component"), has("target")];
  // Installed components carry the host in their name, as in clippy-x86_64-unknown-linux-gnu.
  const complete =
    components.every((name) =>
      hasComponents.some((installed) => installed === name || installed.startsWith(`${name}-`)),
    ) && targets.every((name) => hasTargets.includes(name));
  if (complete) return;
  say(`Rust ${channel} with ${[...components, ...targets].join(", ")}: installing`);
  await must("rustup", [
    ...["toolchain", "install", channel, "--profile", "minimal", "--no-self-update"],
    ...components.flatMap((name) => ["--component", name]),
    ...targets.flatMap((name) => ["--target", name]),
  ]);
}

/** The command-line tool must have exactly the crate's version. */
async function wasmBindgen() {
  const version = /name = "wasm-bindgen"\nversion = "(.+)"/.exec(readFileSync(inRoot("Cargo.lock"), "utf8"))[1];
  if (ask(tool("wasm-bindgen"), ["--version"]) === `wasm-bindgen ${version}`) return;
  say(`wasm-bindgen ${version}: compiling its command-line tools (1 to 2 minutes, once)`);
  // The tool is built without --locked, because the lock file of some releases names a yanked crate. It is not optimised, which halves
  // the compile time of a tool that runs for a second. It has no default features, which are TLS, because its tests talk to a driver on
  // this machine.
  const wanted = ["--no-default-features", "--bin", "wasm-bindgen", "--bin", "wasm-bindgen-test-runner"];
  await must(
    "cargo",
    ["install", "wasm-bindgen-cli", "--version", `=${version}`, ...wanted, "--root", "target/tools", "--force"],
    {
      env: {
        CARGO_PROFILE_RELEASE_OPT_LEVEL: "0",
        CARGO_PROFILE_RELEASE_CODEGEN_UNITS: "16",
        CARGO_PROFILE_RELEASE_LTO: "off",
      },
    },
  );
}

async function nodeModules() {
  const mark = inRoot("node_modules/.lock-stamp");
  const wanted = stamp(["package-lock.json"]);
  if (readIfThere(mark) === wanted) return;
  say("node_modules: npm ci");
  await must("npm", ["ci", "--include=dev", "--no-audit", "--no-fund"]);
  mkdirSync(inRoot("node_modules"), { recursive: true });
  writeFileSync(mark, wanted);
}

export async function setup() {
  const start = performance.now();
  checkNode();
  await toolchain();
  // Both run at once, because one waits for the compiler and the other for the network.
  await Promise.all([wasmBindgen(), nodeModules()]);
  say(`set up (${seconds(start)})`);
}
