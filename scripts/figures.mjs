// npm run figures: draws the figures of the documents from rendered scenes; each run gives the same files.
//   [FOLDER]       docs/figures by default
//   --only a,b     only these figures
//   terms.svg      an occluding contour, a depth discontinuity, a tile of the covariance, and local contrast
//   stages.svg     the inputs of a run, and the result of each stage
//   verdicts.svg   the three verdicts of the check of a calibration
import { mkdirSync, realpathSync, writeFileSync } from "node:fs";
import { join, relative, resolve } from "node:path";
import { parseArgs } from "node:util";
import { build } from "./build.mjs";
import { setup } from "./setup.mjs";
import { Failure, root, say, script } from "./shell.mjs";

export const FOLDER = "docs/figures";
/** Each figure has a file in scripts/figures/ that exports a function of the same name. */
export const FIGURES = ["terms", "stages", "verdicts"];

function parsed() {
  try {
    const {
      positionals: [folder = FOLDER],
      values: { only },
    } = parseArgs({ options: { only: { type: "string" } }, allowPositionals: true });
    const names = only?.split(",") ?? FIGURES;
    const unknown = names.find((name) => !FIGURES.includes(name));
    if (unknown) throw new Error(`There is no figure "${unknown}"; there are ${FIGURES.join(", ")}.`);
    return { folder: resolve(root, folder), names };
  } catch (error) {
    throw new Failure(error.message);
  }
}

/** Writes figures with the package's functions. */
export async function drawn(api, names, folder) {
  mkdirSync(folder, { recursive: true });
  for (const name of names) {
    // Imported late, because before the set-up there are no node_modules.
    const { [name]: draw } = await import(`./figures/${name}.mjs`);
    const text = await draw(api);
    const path = join(folder, `${name}.svg`);
    writeFileSync(path, text);
    say(`${relative(root, path)}: ${Math.ceil(text.length / 1000)} kB`);
  }
}

if (import.meta.filename === realpathSync(process.argv[1])) {
  await script(async () => {
    const { folder, names } = parsed();
    await setup();
    await build();
    const api = await import("../pkg/index.js");
    await api.default();
    await drawn(api, names, folder);
  });
}
