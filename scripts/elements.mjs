// Bundles the custom elements into pkg/ (`bimodal-stereo/elements`), from the page's own modules.
import { readFileSync } from "node:fs";
import { inRoot } from "./shell.mjs";

/** The rest of the package stays in its own files, which are beside those made here. */
const packageBeside = {
  name: "package-beside",
  resolveId(source) {
    const name = /\/pkg\/(index|files)\.js$/.exec(source)?.[1];
    return name && { id: `./${name}.js`, external: true };
  },
};

export const styles = {
  name: "styles",
  load(id) {
    if (!/\.css\?inline$/.test(id)) return undefined;
    const text = readFileSync(id.replace(/\?.*$/, ""), "utf8").replaceAll(/\/\*[\s\S]*?\*\/|\n\s*/g, "");
    return { code: `export default ${JSON.stringify(text)};`, moduleType: "js" };
  },
};

/** The elements start the thread of the lessons in another way than the page. */
export const lessonsThread = {
  name: "lessons-thread",
  resolveId(source, importer) {
    if (source !== "./thread" || !/[\\/]learn[\\/]session\.ts$/.test(importer)) return undefined;
    return inRoot("www/elements/threads.ts");
  },
};

export async function bundleElements(notices) {
  const { rolldown } = await import("rolldown");
  const bundle = await rolldown({
    input: {
      elements: inRoot("www/elements/index.ts"),
      "elements-thread": inRoot("www/elements/thread.ts"),
      "figure-thread": inRoot("www/learn/worker.ts"),
    },
    platform: "browser",
    plugins: [packageBeside, styles, lessonsThread, notices],
    preserveEntrySignatures: "allow-extension",
  });
  // The files have a prefix, because the package has files with common names such as errors.js.
  await bundle.write({ dir: inRoot("pkg"), format: "esm", chunkFileNames: "elements-[name].js" });
  await bundle.close();
}
