// Bundles the widgets of notebooks into the Python package: one script without imports, its threads, and the .wasm.
import { mkdirSync, readFileSync, rmSync, writeFileSync } from "node:fs";
import { gzipSync } from "node:zlib";
import { lessonsThread, styles } from "./elements.mjs";
import { inRoot } from "./shell.mjs";

export const WIDGET = "python/bimodal_stereo/_widget";

/** A notebook's pairs are arrays, so the readers of files stay out. */
const withoutReaders = {
  name: "without-readers",
  load(id) {
    if (!/[\\/]pkg[\\/]files\.js$/.test(id)) return undefined;
    const names = ["decodeDepth", "decodeMask", "imageFrom"];
    return names
      .map((name) => `export const ${name} = () => { throw new Error("files are read in Python"); };`)
      .join("\n");
  },
};

/** Each of these is one file, because a script in a blob has no files beside it. */
const SCRIPTS = {
  widget: "www/elements/widget.ts",
  "stereo-thread": "www/elements/thread.ts",
  "figure-thread": "www/learn/worker.ts",
};

export async function bundleWidget(notices) {
  const { rolldown } = await import("rolldown");
  rmSync(inRoot(WIDGET), { recursive: true, force: true });
  mkdirSync(inRoot(WIDGET));
  for (const [name, source] of Object.entries(SCRIPTS)) {
    const bundle = await rolldown({
      input: inRoot(source),
      platform: "browser",
      plugins: [styles, lessonsThread, withoutReaders, notices],
    });
    const file = inRoot(WIDGET, `${name}.js`);
    await bundle.write({ file, format: "esm", codeSplitting: false, minify: true });
    await bundle.close();
  }
  const wasm = readFileSync(inRoot("pkg/bimodal_stereo_bg.wasm"));
  writeFileSync(inRoot(WIDGET, "bimodal_stereo_bg.wasm.gz"), gzipSync(wasm, { level: 9 }));
}
