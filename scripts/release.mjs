// npm run release -- 0.2.0: makes a version from the committed tree. `--dry-run` prints the changes.
//
// The version is kept in the root's Cargo.toml; the lock files, python/Cargo.toml, CITATION.cff and the changelog are updated from it, and
// everything else reads it there. The command commits and tags. It neither pushes nor publishes: pushing the tag publishes
// (.github/workflows/release.yml). Run `npm test -- --long` before it.
import { readFileSync, writeFileSync } from "node:fs";
import { spawnSync } from "node:child_process";
import { parseArgs } from "node:util";
import { Failure, inRoot, root, say, script } from "./shell.mjs";

const VERSION = /^version = "(.+)"$/m;
const UNRELEASED = "## Unreleased";

function git(...args) {
  const { status, stdout, stderr } = spawnSync("git", args, { cwd: root, encoding: "utf8" });
  if (status !== 0) throw new Failure(`git ${args[0]} failed: ${stderr.trim()}`);
  return stdout.trim();
}

function parsed() {
  try {
    const options = { "dry-run": { type: "boolean", default: false }, date: { type: "string" } };
    const { values, positionals } = parseArgs({ options, allowPositionals: true });
    const [version, ...rest] = positionals;
    if (!/^\d+\.\d+\.\d+(-[0-9A-Za-z.-]+)?$/.test(version ?? "") || rest.length > 0)
      throw new Error("one version is needed, such as 0.2.0");
    const date = values.date ?? new Date().toISOString().slice(0, 10);
    if (!/^\d{4}-\d\d-\d\d$/.test(date)) throw new Error(`--date must be as 2026-01-31, not "${date}"`);
    return { version, date, isDry: values["dry-run"] };
  } catch (error) {
    throw new Failure(error.message);
  }
}

/** Whether one version comes after another; a pre-release comes before its release. */
function isAfter(version, other) {
  const parts = (text) => {
    const [numbers, pre] = text.split(/-(.*)/s);
    return [...numbers.split(".").map(Number), pre === undefined ? 1 : 0, pre ?? ""];
  };
  const [a, b] = [parts(version), parts(other)];
  const first = a.findIndex((part, index) => part !== b[index]);
  return first >= 0 && a[first] > b[first];
}

function replaced(name, text, pattern, by) {
  if (!pattern.test(text)) throw new Failure(`${name} has no place for the version: ${pattern}`);
  return text.replace(pattern, by);
}

/** The project's own packages in a lock file, which come from no registry; the fuzzer's package has no version. */
const locked =
  (name) =>
  (text, { version }) =>
    replaced(name, text, /^(name = "bimodal-stereo(?!-fuzz).*"\nversion = )".+"$(?!\nsource)/gm, `$1"${version}"`);

/** The change of each file. */
const FILES = {
  // The version stands in two places: for all members, and where the command line depends on the library.
  "Cargo.toml": (text, { version }) =>
    replaced(
      "Cargo.toml",
      replaced("Cargo.toml", text, VERSION, `version = "${version}"`),
      /^(bimodal-stereo(?:-files)? = .*version = )"=.+"/gm,
      `$1"=${version}"`,
    ),
  // The Python package is a separate workspace, so that builds for browsers never include it.
  "python/Cargo.toml": (text, { version }) => replaced("python/Cargo.toml", text, VERSION, `version = "${version}"`),
  ...Object.fromEntries(["Cargo.lock", "python/Cargo.lock", "fuzz/Cargo.lock"].map((name) => [name, locked(name)])),
  "CITATION.cff": (text, { version, date }) =>
    replaced(
      "CITATION.cff",
      text.replace(/^date-released: .*\n/m, ""),
      /^version: .*$/m,
      `version: "${version}"\ndate-released: "${date}"`,
    ),
  "CHANGELOG.md": (text, { version, date }) => {
    const [, after] = text.split(`${UNRELEASED}\n`);
    if (after === undefined || after.split(/^## /m)[0].trim() === "")
      throw new Failure(`CHANGELOG.md has nothing under "${UNRELEASED}" to release.`);
    return text.replace(UNRELEASED, `${UNRELEASED}\n\n## ${version}, ${date}`);
  },
};

/** The lines that differ between two texts, in the form of a patch. */
function difference(before, after) {
  const [old, fresh] = [before.split("\n"), after.split("\n")];
  const less = old.filter((line) => !fresh.includes(line)).map((line) => `- ${line}`);
  return [...less, ...fresh.filter((line) => !old.includes(line)).map((line) => `+ ${line}`)];
}

await script(async () => {
  const wanted = parsed();
  const { version, isDry } = wanted;
  const present = VERSION.exec(readFileSync(inRoot("Cargo.toml"), "utf8"))[1];
  // The first release may keep the present version.
  const tags = git("tag", "--list", "v*").split("\n");
  if (tags.includes(`v${version}`)) throw new Failure(`There is a tag v${version} already.`);
  if (version !== present && !isAfter(version, present))
    throw new Failure(`${version} does not come after ${present}.`);
  if (git("status", "--porcelain") !== "")
    throw new Failure("There are changes that are not committed: commit or stash them first.");

  const texts = Object.entries(FILES).map(([name, change]) => {
    const before = readFileSync(inRoot(name), "utf8");
    return { name, before, after: change(before, wanted) };
  });
  for (const { name, before, after } of texts) say([name, ...difference(before, after)].join("\n    "));
  if (isDry) return say(`would commit "Release ${version}" and tag v${version}`);
  for (const { name, after } of texts) writeFileSync(inRoot(name), after);
  git("add", ...texts.map(({ name }) => name));
  git("commit", "--quiet", "-m", `Release ${version}`);
  git("tag", "-a", `v${version}`, "-m", `bimodal-stereo ${version}`);
  say(
    `committed and tagged v${version}; what is left: git push --follow-tags, after which .github/workflows/release.yml publishes it`,
  );
});
