// npm run build: writes the installable package to pkg/.
import {
  chmodSync,
  cpSync,
  existsSync,
  mkdirSync,
  readFileSync,
  realpathSync,
  rmSync,
  symlinkSync,
  writeFileSync,
} from "node:fs";
import { dirname, join } from "node:path";
import { deflateSync, gzipSync } from "node:zlib";
import { bundleElements } from "./elements.mjs";
import { collector } from "./notices/bundled.mjs";
import { NOTICES, section } from "./notices/text.mjs";
import { ALL, GLUE, NUMERICS, allNumerics, node } from "./numerics.mjs";
import { setup } from "./setup.mjs";
import { inRoot, say, script, seconds, stamp } from "./shell.mjs";
import { WIDGET, bundleWidget } from "./widget.mjs";

/** The package's README; the project's README addresses its developers. */
const README = "js/README.md";
const COPIED = ["CHANGELOG.md", "LICENSE-MIT", "LICENSE-APACHE"];
const SOURCES = [
  ...NUMERICS,
  NOTICES,
  "js",
  "package-lock.json",
  "scripts/build.mjs",
  "scripts/elements.mjs",
  "scripts/widget.mjs",
  ...["elements", "learn", "draw", "engine", "style", "dom.ts"].map((part) => `www/${part}`),
  "scripts/imports.mjs",
  "scripts/notices",
];
const THREADS = ["thread.js", "elements-thread.js", "figure-thread.js"];
const MARK = "pkg/.stamp";
/** Entries for programs, for files of images and depth maps, for a rig's files (reading, recordings, writing, the report of its check, its words), for writing a run's files, for the page's fields and its visitor's files, for the threads of workers, and for shells. */
const ENTRIES = {
  index: "index",
  files: "files",
  rig: "rig/index",
  "rig-recordings": "rig/recordings/index",
  "rig-write": "rig/write/index",
  "rig-report": "rig/write/report/index",
  "rig-words": "rig/write/report/words",
  write: "write/index",
  options: "options",
  pair: "pair/index",
  thread: "workers/thread",
  cli: "cli/main",
};
/** The package's manifest; name, version, licence, authors and addresses come from Cargo.toml alone. */
function manifest() {
  const cargo = readFileSync(inRoot("Cargo.toml"), "utf8");
  const field = (name) => new RegExp(`^${name} = "(.+)"$`, "m").exec(cargo)[1];
  const list = (name) => JSON.parse(`[${new RegExp(`^${name} = \\[(.+)\\]$`, "m").exec(cargo)[1]}]`);
  const repository = field("repository");
  return {
    name: field("name"),
    version: field("version"),
    description: field("description"),
    keywords: list("keywords"),
    license: `(${field("license")})`,
    author: list("authors").join(", "),
    homepage: `${repository}#readme`,
    repository: { type: "git", url: `git+${repository}.git` },
    bugs: { url: `${repository}/issues` },
    type: "module",
    engines: { node: "^20.19.0 || >=22.12.0" },
    // Importing the elements defines them.
    sideEffects: ["./elements.js"],
    exports: {
      ".": { types: "./index.d.ts", default: "./index.js" },
      "./files": { types: "./files.d.ts", default: "./files.js" },
      "./rig": { types: "./rig/index.d.ts", default: "./rig.js" },
      "./rig-recordings": { types: "./rig/recordings/index.d.ts", default: "./rig-recordings.js" },
      "./write": { types: "./write/index.d.ts", default: "./write.js" },
      "./rig-write": { types: "./rig/write/index.d.ts", default: "./rig-write.js" },
      "./elements": { types: "./elements.d.ts", default: "./elements.js" },
      // These files are exported by path, for bundlers that need to know them.
      ...Object.fromEntries([...THREADS, ...ALL.map(({ file }) => file)].map((file) => [`./${file}`, `./${file}`])),
      "./package.json": "./package.json",
    },
    types: "./index.d.ts",
    // npx bimodal-stereo
    bin: { "bimodal-stereo": "./cli.js" },
    files: ["*.js", "**/*.d.ts", "*.wasm", "README.md", NOTICES, ...COPIED],
  };
}

/** Notices of the code in the scripts, followed by those of the .wasm files, which are kept beside Cargo.toml (scripts/notices.mjs). */
const notices = (entries) =>
  [section("Contained in the scripts of bimodal-stereo:", entries), readFileSync(inRoot(NOTICES), "utf8")].join("\n");

/**
 * parse-exr 1.0.2 loops forever if a stream holds more values than its picture, because its function for a code then returns without
 * advancing. This patch makes it throw.
 */
const endingExr = {
  name: "ending-exr",
  transform(code, id) {
    if (!/[\\/]parse-exr[\\/]/.test(id)) return undefined;
    const [from, until] = ["function getCode(", "getCodeReturn.c = c"].map((words) => code.indexOf(words));
    const parts = code.slice(from, until).split("return false;");
    if (from < 0 || parts.length !== 3) throw new Error("parse-exr has changed: see what its getCode does at the end");
    return code.slice(0, from) + parts.join('throw new Error("it holds more values than pixels");') + code.slice(until);
  },
};

/**
 * @foxglove/rosbag compiles readers from a recording's own definitions (`eval`, `new Function`) for callers who let it decode messages.
 * This package does not decode with it, so no code is made from the contents of a file.
 */
const withoutEval = {
  name: "without-eval",
  transform(_, id) {
    if (!/[\\/]rosmsg-serialization[\\/]dist[\\/]esm[\\/]index\.js$/.test(id)) return undefined;
    return { code: "export class MessageReader {}", map: null };
  },
};

/**
 * Puts laz-perf's code inside the script that uses it; otherwise an application would have to serve one more file for a rare format. Its
 * glue checks for a browser, where it would fetch that file, and for Node's `require`; this version runs in Node as well.
 */
const lazInside = {
  name: "laz-inside",
  load(id) {
    if (!/[\\/]laz-perf\.wasm$/.test(id)) return undefined;
    const packed = deflateSync(readFileSync(id), { level: 9 }).toString("base64");
    return { code: `export default "${packed}";`, moduleType: "js" };
  },
  transform(code, id) {
    if (!/[\\/]laz-perf\.js$/.test(id)) return undefined;
    const asked = ['!(typeof window=="object"||typeof importScripts=="function")', 'typeof require==="function"'];
    if (!asked.every((words) => code.includes(words))) throw new Error("laz-perf has changed: see what it asks for");
    return { code: asked.reduce((text, words) => text.replaceAll(words, "false"), code), map: null };
  },
};

/** One file for each entry and one for their shared code, with the PNG decoder only in the files module. */
async function facade() {
  const { rolldown } = await import("rolldown");
  const npm = collector();
  const bundle = await rolldown({
    input: Object.fromEntries(Object.entries(ENTRIES).map(([name, source]) => [name, inRoot(`js/${source}.ts`)])),
    external: /^node:/,
    platform: "neutral",
    plugins: [npm.plugin, endingExr, withoutEval, lazInside],
    resolve: { mainFields: ["module", "main"] },
    // The code splitting below needs this setting; leaving it implicit gives a warning.
    preserveEntrySignatures: "allow-extension",
  });
  // This separate file is shared with the loop, so that users who only check a rig do not download the loop's bindings.
  const codeSplitting = {
    groups: [{ name: "border", test: /js\/(border|breathe|node)\.ts$/ }],
    includeDependenciesRecursively: false,
  };
  await bundle.write({ dir: inRoot("pkg"), format: "esm", chunkFileNames: "[name].js", codeSplitting });
  await bundle.close();
  await bundleElements(npm.plugin);
  await bundleWidget(npm.plugin);
  chmodSync(inRoot("pkg/cli.js"), 0o755);
  writeFileSync(inRoot("pkg", NOTICES), notices(npm.entries()));
  await declarations();
}

/** The types reachable from the entries; the others stay inside, including those of the generated bindings. */
async function declarations() {
  // Imported late, like the bundler, because before the set-up there are no node_modules.
  const { reachable } = await import("./imports.mjs");
  const all = inRoot("target/declarations");
  rmSync(all, { recursive: true, force: true });
  await node("typescript/bin/tsc", "-p", "js/tsconfig.json", "--outDir", all);
  const programs = Object.values(ENTRIES).filter((source) => source !== ENTRIES.thread && source !== ENTRIES.cli);
  // The elements' code is the page's, their types are the package's.
  const typed = [...programs, "elements"];
  for (const name of reachable(
    all,
    typed.map((source) => `${source}.d.ts`),
  ))
    cpSync(join(all, name), inRoot("pkg", name));
}

const kilobytes = (bytes) => `${(bytes / 1000).toFixed(0)} kB`;
const sizes = (file) => {
  const bytes = readFileSync(inRoot("pkg", file));
  return [bytes.length, gzipSync(bytes).length].map(kilobytes);
};

/** Fills in the sizes of this build. */
function readme() {
  const text = readFileSync(inRoot(README), "utf8");
  return text
    .replaceAll(/\{size of (.+?)\}/g, (_, file) => sizes(file)[0])
    .replaceAll(/\{gzipped size of (.+?)\}/g, (_, file) => sizes(file)[1]);
}

/**
 * Links the package and its command, because the examples import it by name and the README calls `npx bimodal-stereo`, as in any project
 * that installed it; npm does not know the links.
 */
function link() {
  const links = [
    ["../pkg", inRoot("node_modules/bimodal-stereo"), "dir"],
    ["../bimodal-stereo/cli.js", inRoot("node_modules/.bin/bimodal-stereo"), "file"],
  ];
  for (const [target, at, kind] of links) {
    rmSync(at, { recursive: true, force: true });
    mkdirSync(dirname(at), { recursive: true });
    symlinkSync(target, at, kind);
  }
}

export async function build() {
  link();
  const wanted = stamp([...SOURCES, ...COPIED]);
  const complete = [MARK, WIDGET, ...GLUE].every((path) => existsSync(inRoot(path)));
  if (complete && readFileSync(inRoot(MARK), "utf8") === wanted) return say("pkg/ is up to date");
  const start = performance.now();
  say("building pkg/");
  rmSync(inRoot("pkg"), { recursive: true, force: true });
  mkdirSync(inRoot("pkg"));
  await allNumerics();
  for (const { file } of ALL) cpSync(inRoot(`target/${file}`), inRoot("pkg", file));
  await facade();
  for (const file of COPIED) cpSync(inRoot(file), inRoot("pkg", file));
  writeFileSync(inRoot("pkg/README.md"), readme());
  writeFileSync(inRoot("pkg/package.json"), `${JSON.stringify(manifest(), null, 2)}\n`);
  writeFileSync(inRoot(MARK), wanted);

  say(`built pkg/ (${seconds(start)})`);
  for (const { file } of ALL) {
    const [whole, gzipped] = sizes(file);
    say(`${file}: ${whole}, ${gzipped} gzipped`);
  }
}

// `import.meta` has the real path, the command line the path that was given.
if (import.meta.filename === realpathSync(process.argv[1])) {
  await script(async () => {
    await setup();
    await build();
  });
}
