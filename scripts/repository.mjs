// npm run repository: writes the project's address, taken from Cargo.toml, into files that cannot read it there. A fork changes it in
// Cargo.toml and runs this once; tests/contract/repository.test.mjs finds a forgotten place.
import { readFileSync, realpathSync, writeFileSync } from "node:fs";
import { inRoot, say, script } from "./shell.mjs";

/** Files that other programs read unchanged or that no program here writes; each names the address at least once. */
export const PLACES = [
  "CITATION.cff",
  "pyproject.toml",
  "www/index.html",
  "www/learn/references.ts",
  ".github/ISSUE_TEMPLATE/config.yml",
];

const read = (name) => readFileSync(inRoot(name), "utf8");

/** The address of the repository. */
export const address = () => /^repository = "(https:.+)"$/m.exec(read("Cargo.toml"))[1];

// `import.meta` has the real path, the command line the path that was given.
if (import.meta.filename === realpathSync(process.argv[1])) {
  await script(() => {
    // The citation has nothing else on this line, so it gives the previous address.
    const before = /^repository-code: "(.+)"$/m.exec(read("CITATION.cff"))[1];
    for (const name of PLACES) writeFileSync(inRoot(name), read(name).replaceAll(before, address()));
    say(before === address() ? `every place names ${before}` : `${before} is now ${address()} in ${PLACES.join(", ")}`);
  });
}
