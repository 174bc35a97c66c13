// npm run repository: writes the project's address, which is that of Cargo.toml, wherever it can't be read from there. A fork changes it in
// Cargo.toml and runs this once; tests/contract/repository.test.mjs finds a place that was forgotten.
import { readFileSync, realpathSync, writeFileSync } from "node:fs";
import { inRoot, say, script } from "./shell.mjs";

/** Files that no program of ours writes or that other programs read as they are; each names the address at least once. */
export const PLACES = [
  "CITATION.cff",
  "pyproject.toml",
  "www/learn/references.ts",
  ".github/ISSUE_TEMPLATE/config.yml",
];

const read = (name) => readFileSync(inRoot(name), "utf8");

/** The address of the repository. */
export const address = () => /^repository = "(https:.+)"$/m.exec(read("Cargo.toml"))[1];

// Node names this module by its real path, and the command by the path it was given.
if (import.meta.filename === realpathSync(process.argv[1])) {
  await script(() => {
    // The citation has nothing else on this line, and so tells the address of before.
    const before = /^repository-code: "(.+)"$/m.exec(read("CITATION.cff"))[1];
    for (const name of PLACES) writeFileSync(inRoot(name), read(name).replaceAll(before, address()));
    say(before === address() ? `every place names ${before}` : `${before} is now ${address()} in ${PLACES.join(", ")}`);
  });
}
