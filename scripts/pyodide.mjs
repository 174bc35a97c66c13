// Builds the Python package's wheel for Pyodide: its own modules, and an adapter to the WebAssembly of the npm package in place of the bindings.
import { createHash } from "node:crypto";
import { mkdirSync, readFileSync, realpathSync, rmSync, writeFileSync } from "node:fs";
import { relative } from "node:path";
import { build } from "./build.mjs";
import { NOTICES } from "./notices/text.mjs";
import { setup } from "./setup.mjs";
import { filesBelow, inRoot, say, script } from "./shell.mjs";

export const PYODIDE_WHEELS = "target/python/pyodide";
const PACKAGE = "python/bimodal_stereo";
const MODULES = ["bimodal_stereo_bg.wasm", "bimodal_stereo_check_bg.wasm", "bimodal_stereo_rigs_bg.wasm"];
/** Pyodide's platforms of two years. The tag is not "any", because pip would install this wheel where a native one is missing. */
const PLATFORMS = "pyodide_2025_0_wasm32.pyemscripten_2026_0_wasm32";

/** One script without imports, which Pyodide evaluates. */
async function adapter() {
  const { rolldown } = await import("rolldown");
  // No file is beside the script, and the script needs none.
  const transform = { define: { "import.meta.url": "undefined" } };
  const bundle = await rolldown({ input: inRoot("js/pyodide.ts"), platform: "browser", external: /^node:/, transform });
  const options = { format: "iife", name: "bimodalStereo", codeSplitting: false, minify: true };
  const { output } = await bundle.generate(options);
  await bundle.close();
  return output[0].code;
}

/** The metadata that pip needs, from the files that state it. */
function metadata() {
  const project = readFileSync(inRoot("pyproject.toml"), "utf8");
  const [, version] = /^version = "(.+)"$/m.exec(readFileSync(inRoot("python/Cargo.toml"), "utf8"));
  const field = (name) => new RegExp(`^${name} = "(.+)"$`, "m").exec(project)[1];
  const lines = [
    "Metadata-Version: 2.4",
    `Name: ${field("name")}`,
    `Version: ${version}`,
    `Summary: ${field("description")}`,
    `License-Expression: ${field("license")}`,
    `Requires-Python: ${field("requires-python")}`,
    `Requires-Dist: ${/^dependencies = \["(.+)"\]$/m.exec(project)[1]}`,
    "Provides-Extra: widget",
    `Requires-Dist: ${/^widget = \["(.+)"\]$/m.exec(project)[1]} ; extra == "widget"`,
    "Description-Content-Type: text/markdown",
  ];
  return { version, text: `${lines.join("\n")}\n\n${readFileSync(inRoot("python/README.md"), "utf8")}` };
}

/** The path of the wheel. */
export async function pyodideWheel() {
  const { zipSync } = await import("fflate");
  const { version, text } = metadata();
  const kept = filesBelow(inRoot(PACKAGE)).filter((path) => /\.(py|typed|js|gz)$/.test(path));
  const files = Object.fromEntries(kept.map((path) => [relative(inRoot("python"), path), readFileSync(path)]));
  const put = (name, content) => (files[name] = Buffer.from(content));
  put("bimodal_stereo/_native.py", readFileSync(inRoot("python/pyodide/_native.py")));
  put("bimodal_stereo/_pyodide/method.js", await adapter());
  put("bimodal_stereo/_pyodide/codes.json", readFileSync(inRoot("src/codes.json")));
  put("bimodal_stereo/_pyodide/version.txt", version);
  for (const name of MODULES) put(`bimodal_stereo/_pyodide/${name}`, readFileSync(inRoot("pkg", name)));
  const info = `bimodal_stereo-${version}.dist-info`;
  put(`${info}/METADATA`, text);
  const tags = PLATFORMS.split(".").map((platform) => `Tag: py3-none-${platform}`);
  put(
    `${info}/WHEEL`,
    ["Wheel-Version: 1.0", "Generator: bimodal-stereo", "Root-Is-Purelib: false", ...tags, ""].join("\n"),
  );
  for (const name of ["LICENSE-MIT", "LICENSE-APACHE", NOTICES])
    put(`${info}/licenses/${name}`, readFileSync(inRoot(name)));
  const sum = (bytes) => createHash("sha256").update(bytes).digest("base64url");
  const rows = Object.entries(files).map(([name, bytes]) => `${name},sha256=${sum(bytes)},${bytes.length}`);
  put(`${info}/RECORD`, `${[...rows, `${info}/RECORD,,`].join("\n")}\n`);
  rmSync(inRoot(PYODIDE_WHEELS), { recursive: true, force: true });
  mkdirSync(inRoot(PYODIDE_WHEELS), { recursive: true });
  const path = inRoot(PYODIDE_WHEELS, `bimodal_stereo-${version}-py3-none-${PLATFORMS}.whl`);
  writeFileSync(path, zipSync(files));
  return path;
}

if (import.meta.filename === realpathSync(process.argv[1])) {
  await script(async () => {
    await setup();
    await build();
    say(await pyodideWheel());
  });
}
