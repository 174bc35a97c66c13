// The npm packages whose code a bundler puts into its output, from the bundler's own module graph.
import { existsSync, readFileSync, readdirSync } from "node:fs";
import { dirname, join } from "node:path";
import { Failure, inRoot } from "../shell.mjs";

/** Names of files with a package's licence or attributions. */
const TEXTS = /^(licen[cs]e|copying|notice|third-party-licen[cs]e)/i;
/** Licences whose text is the same for everybody, for packages that do not include it. */
const GENERAL = { "Apache-2.0": "LICENSE-APACHE" };
/** Modules that a bundler adds itself are that bundler's code. */
const RUNTIME = /^\0(rolldown|vite)\//;
/** The end of Vite's licence file lists Vite's dependencies, none of which reaches the output. */
const REST = /\n# Licenses of bundled dependencies[\s\S]*$/;

/** Remarks on packages whose texts contradict each other. */
const REMARKS = {
  "@openpgp/seek-bzip":
    "The manifest and the licence of this package state MIT. The headers of two of its sources, below, name the LGPL 2.1.",
};

/** Comments: blocks, or consecutive lines with the empty lines between them. */
const COMMENT = /\/\*[\s\S]*?\*\/|(?:^[ \t]*\/\/.*(?:\n\s*)?)+/gm;
const CLAIM = /\bcopyright\b|\(c\) \d{4}|\bred?istributions? /i;

/** Licence comments of a source: bundlers remove comments, but some licences require these. */
export function claimsIn(source) {
  const words = (comment) => comment.replaceAll(/^[ \t]*(?:\/\*+|\/\/+|\*(?!\/))?[ \t]?(?:\/\/ ?)*|\*+\/[ \t]*$/gm, "");
  return [...source.matchAll(COMMENT)].map(([comment]) => words(comment)).filter((text) => CLAIM.test(text));
}

/** The folder of the package that a module belongs to; undefined for the project's own modules. */
function folderOf(id) {
  if (id.startsWith("\0")) {
    const runtime = RUNTIME.exec(id);
    if (!runtime) throw new Failure(`Whose is the module "${id.slice(1)}"? scripts/notices/bundled.mjs does not know.`);
    return inRoot("node_modules", runtime[1]);
  }
  if (!id.includes("/node_modules/")) return undefined;
  let folder = dirname(id.replace(/\?.*$/, ""));
  // A package.json without a name only sets the type of the modules beside it.
  while (!existsSync(join(folder, "package.json")) || read(folder, "package.json").name === undefined)
    folder = dirname(folder);
  return folder;
}

const read = (folder, file) => JSON.parse(readFileSync(join(folder, file), "utf8"));

function entryOf([folder, modules]) {
  const { name, version, license: licence } = read(folder, "package.json");
  const texts = readdirSync(folder)
    .filter((file) => TEXTS.test(file))
    .map((file) => readFileSync(join(folder, file), "utf8").replace(REST, ""));
  if (texts.length === 0 && GENERAL[licence]) texts.push(readFileSync(inRoot(GENERAL[licence]), "utf8"));
  for (const path of modules) texts.push(...claimsIn(readFileSync(path, "utf8")));
  if (texts.length === 0) throw new Failure(`The package ${name} ${version} carries no licence text.`);
  if (REMARKS[name]) texts.unshift(REMARKS[name]);
  return { name, version, licence, texts };
}

/** A plugin of rolldown and vite that inspects every bundle, and its findings: entries for `section` of text.mjs. */
export function collector() {
  /** The modules of each package. */
  const folders = new Map();
  return {
    plugin: {
      name: "notices",
      generateBundle(_, bundle) {
        const ids = Object.values(bundle).flatMap((file) => (file.type === "chunk" ? file.moduleIds : []));
        for (const id of ids) {
          const folder = folderOf(id);
          if (folder === undefined) continue;
          const paths = folders.get(folder) ?? folders.set(folder, new Set()).get(folder);
          const path = id.replace(/\?.*$/, "");
          if (existsSync(path)) paths.add(path);
        }
      },
    },
    entries: () => [...folders].map(entryOf),
  };
}
