// npm run notices: writes the licences of the crates that the .wasm files, the command line and the Python package contain.
//
// Run it after a change of Cargo.lock, python/Cargo.lock or rust-toolchain.toml; otherwise tests/contract/notices.test.mjs fails. Files that
// name the right crates stay unchanged; `-- --all` rewrites them. The build adds the notices of npm packages (notices/bundled.mjs).
import { mkdirSync, readFileSync, readdirSync, writeFileSync } from "node:fs";
import { dirname, join } from "node:path";
import { isDeepStrictEqual } from "node:util";
import { ARTEFACTS, cratesOf } from "./notices/crates.mjs";
import { compiler, standardLibrary } from "./notices/standard-library.mjs";
import { namedIn, section } from "./notices/text.mjs";
import { tool } from "./setup.mjs";
import { Failure, ask, inRoot, must, readIfThere, say, script } from "./shell.mjs";

const ABOUT = "0.9.3";
const FOLDER = "target/notices";
const LIBRARY = "Contained by way of Rust's standard library:";
/** Files that cargo-about leaves out of a licence: the attributions that Apache-2.0 requires. */
const NOTICE = /^notice/i;

async function install() {
  if (ask(tool("cargo-about"), ["--version"]) === `cargo-about ${ABOUT}`) return;
  say(`cargo-about ${ABOUT}: compiling it (minutes, once)`);
  const args = ["cargo-about", "--version", `=${ABOUT}`, "--locked", "--features", "cli"];
  await must("cargo", ["install", ...args, "--root", "target/tools", "--force"]);
}

/** Licences are chosen from those that deny.toml allows, in its order. */
function settings() {
  const accepted = /^allow = (\[.+\])$/m.exec(readFileSync(inRoot("deny.toml"), "utf8"))[1];
  const lines = [`accepted = ${accepted}`, "ignore-build-dependencies = true", "ignore-dev-dependencies = true"];
  const path = inRoot(FOLDER, "about.toml");
  writeFileSync(path, lines.join("\n"));
  return path;
}

/** Every crate of an artefact, with the licences chosen for it, including macros and their dependencies. */
async function about({ manifest, builds }, config) {
  const out = join(FOLDER, `${manifest.replaceAll(/\W/g, "-")}.json`);
  // It works offline: it reads what is compiled and does not ask a server for corrections of licences.
  const args = ["generate", "--format", "json", "--locked", "--offline", "--fail", "--config", config];
  await must(tool("cargo-about"), [
    ...args,
    ...new Set(builds.flat()),
    "--manifest-path",
    manifest,
    "--output-file",
    out,
  ]);
  const entries = new Map();
  for (const { id, text, used_by } of JSON.parse(readFileSync(inRoot(out), "utf8")).licenses) {
    for (const { crate } of used_by) {
      const key = `${crate.name} ${crate.version}`;
      const { licences, texts } = entries.get(key) ?? { licences: [], texts: attributions(crate) };
      entries.set(key, { licences: [...licences, id], texts: [...texts, signed(text, crate)] });
    }
  }
  return entries;
}

/** A crate without a licence file gets the licence's general form, which has a placeholder for names. */
const signed = (text, { authors }) =>
  text.replace("<year> <copyright holders>", authors.map((author) => author.replace(/ *<.*>/, "")).join(", "));

function attributions({ manifest_path }) {
  const folder = dirname(manifest_path);
  const files = readdirSync(folder).filter((file) => NOTICE.test(file));
  return files.map((file) => readFileSync(join(folder, file), "utf8"));
}

function entryOf(crate, entries) {
  const entry = entries.get(crate);
  if (entry === undefined) throw new Failure(`cargo-about says nothing of ${crate}.`);
  const [name, version] = crate.split(" ");
  return { name, version, licence: [...new Set(entry.licences)].sort().join(" AND "), texts: entry.texts };
}

/** Whether the file names the compiled crates in their versions. */
function isCurrent(artefact) {
  const [crates, library = ""] = (readIfThere(inRoot(artefact.file)) ?? "").split(LIBRARY);
  const named = namedIn(crates).sort();
  return isDeepStrictEqual(named, cratesOf(artefact)) && namedIn(library).includes(`rust-std ${compiler()}`);
}

await script(async () => {
  const stale = process.argv.includes("--all") ? ARTEFACTS : ARTEFACTS.filter((artefact) => !isCurrent(artefact));
  if (stale.length === 0) return say("the notices are up to date");
  await install();
  mkdirSync(inRoot(FOLDER), { recursive: true });
  const config = settings();
  for (const artefact of stale) {
    const entries = await about(artefact, config);
    const crates = cratesOf(artefact).map((crate) => entryOf(crate, entries));
    const parts = [section(artefact.title, crates), section(LIBRARY, standardLibrary())];
    writeFileSync(inRoot(artefact.file), parts.join("\n"));
    say(`${artefact.file}: ${crates.length} crates`);
  }
});
