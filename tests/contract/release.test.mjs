// The citation is valid, and a release changes the right files, tested in a separate repository.
import assert from "node:assert/strict";
import { spawnSync } from "node:child_process";
import { cpSync, mkdtempSync, readFileSync, rmSync, writeFileSync } from "node:fs";
import { tmpdir } from "node:os";
import { join } from "node:path";
import { after, beforeEach, describe, test } from "node:test";
import { load } from "js-yaml";
import { inRoot } from "../../scripts/shell.mjs";

const cargo = readFileSync(inRoot("Cargo.toml"), "utf8");
const field = (name) => new RegExp(`^${name} = "(.+)"$`, "m").exec(cargo)[1];

describe("CITATION.cff", () => {
  const citation = load(readFileSync(inRoot("CITATION.cff"), "utf8"));

  test("has what version 1.2.0 of the format asks for, and no key that it does not know", () => {
    const known = [
      "cff-version",
      "message",
      "type",
      "title",
      "abstract",
      "authors",
      "version",
      "date-released",
      "license",
      "repository-code",
      "keywords",
      "preferred-citation",
    ];
    for (const key of Object.keys(citation)) assert.ok(known.includes(key), key);
    assert.deepEqual([citation["cff-version"], citation.type], ["1.2.0", "software"]);
    for (const key of ["message", "title", "version"]) assert.equal(typeof citation[key], "string", key);
    assert.ok(citation.authors.every(({ name }) => name.length > 0));
  });

  test("says what Cargo.toml says", () => {
    assert.equal(citation.version, field("version"));
    assert.equal(citation["repository-code"], field("repository"));
    assert.equal(citation.license.join(" OR "), field("license"));
  });

  test("names the paper", () => {
    const { type, title, journal, authors } = citation["preferred-citation"];
    assert.deepEqual([type, journal], ["article", "Machine Vision and Applications"]);
    assert.match(title, /^Bimodal Stereo: /);
    const names = authors.map((author) => `${author["given-names"]} ${author["family-names"]}`);
    assert.deepEqual(names, ["Chi Zhang", "Yuehu Liu", "Ying Wu", "Qilin Zhang", "Le Wang"]);
  });
});

describe("release", () => {
  const FILES = [
    "Cargo.toml",
    "Cargo.lock",
    "python/Cargo.toml",
    "python/Cargo.lock",
    "fuzz/Cargo.lock",
    "CITATION.cff",
    "CHANGELOG.md",
    "package.json",
    "scripts/release.mjs",
    "scripts/shell.mjs",
  ];
  const folders = [];
  let folder;
  const git = (...args) => {
    // Only the repository's configuration counts, not this machine's.
    const env = { ...process.env, GIT_CONFIG_GLOBAL: "/dev/null", GIT_CONFIG_SYSTEM: "/dev/null" };
    const { status, stdout, stderr } = spawnSync("git", args, { cwd: folder, encoding: "utf8", env });
    assert.equal(status, 0, stderr);
    return stdout.trim();
  };
  const release = (...args) =>
    spawnSync(process.execPath, ["scripts/release.mjs", ...args], { cwd: folder, encoding: "utf8" });
  const read = (name) => readFileSync(join(folder, name), "utf8");
  const write = (name, text) => writeFileSync(join(folder, name), text);
  const commit = () => git("commit", "--quiet", "-a", "-m", "a change");

  beforeEach(() => {
    folder = mkdtempSync(join(tmpdir(), "bimodal-release-"));
    folders.push(folder);
    for (const name of FILES) cpSync(inRoot(name), join(folder, name));
    write(
      "CHANGELOG.md",
      "# Changelog\n\n## Unreleased\n\n- something new\n\n## 0.0.9, 2020-01-01\n\n- something old\n",
    );
    git("init", "--quiet");
    for (const [key, value] of [
      ["user.name", "a"],
      ["user.email", "a@b.c"],
      ["commit.gpgsign", "false"],
      ["tag.gpgsign", "false"],
    ])
      git("config", key, value);
    git("add", ".");
    commit();
  });
  after(() => folders.forEach((each) => rmSync(each, { recursive: true, force: true })));

  test("moves the version everywhere, the changelog under its date, and commits and tags", () => {
    const { status, stderr } = release("9.8.7", "--date", "2031-02-03");
    assert.equal(status, 0, stderr);
    assert.match(read("Cargo.toml"), /^version = "9\.8\.7"$/m);
    for (const name of ["bimodal-stereo", "bimodal-stereo-files"])
      assert.match(read("Cargo.toml"), new RegExp(`^${name} = .*version = "=9\\.8\\.7"`, "m"));
    const locked = [...read("Cargo.lock").matchAll(/^name = "(bimodal-stereo.*)"\nversion = "(.+)"$/gm)];
    assert.ok(locked.length >= 2 && locked.every(([, , version]) => version === "9.8.7"), String(locked));
    assert.match(read("python/Cargo.toml"), /^version = "9\.8\.7"$/m);
    const others = [
      ...(read("python/Cargo.lock") + read("fuzz/Cargo.lock")).matchAll(
        /^name = "(bimodal-stereo.*)"\nversion = "(.+)"$/gm,
      ),
    ];
    assert.deepEqual(
      others.filter(([, , version]) => version !== "9.8.7").map(([, name]) => name),
      ["bimodal-stereo-fuzz"],
    );
    const { version, "date-released": date } = load(read("CITATION.cff"));
    assert.deepEqual([version, String(date)], ["9.8.7", "2031-02-03"]);
    assert.match(
      read("CHANGELOG.md"),
      /^# Changelog\n\n## Unreleased\n\n## 9\.8\.7, 2031-02-03\n\n- something new\n\n## 0\.0\.9/,
    );
    assert.equal(git("status", "--porcelain"), "");
    assert.deepEqual([git("log", "-1", "--format=%s"), git("describe")], ["Release 9.8.7", "v9.8.7"]);
    // The rest of the lock file does not change.
    assert.equal(
      git("diff", "--numstat", "HEAD~1", "--", "Cargo.lock"),
      `${locked.length}\t${locked.length}\tCargo.lock`,
    );

    write("CHANGELOG.md", read("CHANGELOG.md").replace("## Unreleased\n", "## Unreleased\n\n- more\n"));
    commit();
    assert.equal(release("9.9.0", "--date", "2031-02-04").status, 0);
    assert.equal(read("CITATION.cff").match(/date-released/g).length, 1);
  });

  test("a dry run prints and changes nothing", () => {
    const { status, stdout } = release("9.8.7", "--dry-run");
    assert.equal(status, 0);
    for (const part of ['+ version = "9.8.7"', "+ ## 9.8.7, ", "would commit"])
      assert.ok(stdout.includes(part), stdout);
    assert.deepEqual([git("status", "--porcelain"), git("tag")], ["", ""]);
  });

  test("refuses what is no release", () => {
    const refused = (words, ...args) => {
      const { status, stderr } = release(...args);
      assert.equal(status, 1);
      assert.match(stderr, words);
    };
    refused(/one version/);
    refused(/one version/, "v1");
    refused(/does not come after/, "0.0.9");
    refused(/does not come after/, `${field("version")}-rc.1`);
    git("tag", "v5.0.0");
    refused(/tag v5\.0\.0 already/, "5.0.0");
    write("package.json", `${read("package.json")}\n`);
    refused(/not committed/, "9.8.7");
    git("checkout", "--quiet", ".");
    write("CHANGELOG.md", "# Changelog\n\n## Unreleased\n\n## 0.0.9, 2020-01-01\n\n- old\n");
    commit();
    refused(/nothing under/, "9.8.7");
    assert.equal(git("log", "-1", "--format=%s"), "a change");
  });
});
