// Every artefact contains its licences and the notices of other people's code, and no data that is not free. Each artefact is unpacked.
import assert from "node:assert/strict";
import { existsSync, mkdirSync, readFileSync, readdirSync, writeFileSync } from "node:fs";
import { basename, dirname, join, relative } from "node:path";
import { describe, test } from "node:test";
import { unzipSync } from "fflate";
import { ARTEFACTS, cratesOf } from "../../scripts/notices/crates.mjs";
import { compiler } from "../../scripts/notices/standard-library.mjs";
import { NOTICES, namedIn } from "../../scripts/notices/text.mjs";
import { WHEELS } from "../../scripts/python.mjs";
import { filesBelow, inRoot, matching } from "../../scripts/shell.mjs";
import { SITE, buildSite } from "../../scripts/site/build.mjs";
import { folder, run } from "./fresh.mjs";
import { LONG } from "./long.mjs";

const read = (path) => readFileSync(inRoot(path), "utf8");

/** Licences of npm packages that allow use in a program of any licence if their text is included. */
const FREE = ["0BSD", "Apache-2.0", "BSD-2-Clause", "BSD-3-Clause", "CC0-1.0", "ISC", "MIT", "Zlib"];

/**
 * Numbers of a prior that was published for non-commercial use only (two adjacent ones of its mean and two of its covariance), and words of
 * its notice.
 */
const UNFREE = [
  [-1.147481, -0.1998278],
  [0.1858586, 0.1259432],
];
const UNFREE_WORDS = /1\.147481|0?\.1349868|0?\.4037586|not-for-profit|Regents of the University/;

/** The numbers as compilers store them. */
const patterns = UNFREE.flatMap((pair) => [Float32Array.from(pair), Float64Array.from(pair)]).map((array) =>
  Buffer.from(array.buffer),
);

/** The paths of the files in a folder that contain anything that is not free. */
function unfreeIn(path) {
  const files = filesBelow(path);
  assert.ok(files.length > 0, `${path} is empty`);
  const isUnfree = (bytes) =>
    UNFREE_WORDS.test(bytes.toString("latin1")) || patterns.some((pattern) => bytes.includes(pattern));
  return files.filter((file) => isUnfree(readFileSync(file))).map((file) => relative(path, file));
}

/** Checks that the project's licences are there, and notices that name these packages, each with a text. */
function carries(path, packages) {
  for (const file of ["LICENSE-MIT", "LICENSE-APACHE"])
    assert.equal(readFileSync(join(path, file), "utf8"), read(file), file);
  const text = readFileSync(join(path, NOTICES), "utf8");
  const [named, headed] = [namedIn(text), headsOf(text)];
  for (const each of packages) assert.ok(named.includes(each) && headed.includes(each), each);
  assert.deepEqual(
    named.filter((each) => !headed.includes(each)),
    [],
  );
  return text;
}

/** The packages in the headings of texts. */
const headsOf = (text) =>
  [...text.matchAll(/^={80}\n(.+(?:\n.+)*?)\n={80}\n\n(?=.*\S)/gm)].flatMap((match) => match[1].split(/,\s/));

/** An npm package as the notices name it, and its own copy of its licence; one without a copy has Apache's. */
function npmPackage(name) {
  const at = `node_modules/${name}`;
  const file = readdirSync(inRoot(at)).find((each) => /^licen[cs]e/i.test(each));
  return {
    named: `${name} ${JSON.parse(read(`${at}/package.json`)).version}`,
    text: read(file ? `${at}/${file}` : "LICENSE-APACHE"),
  };
}

/** The npm packages that the sources of some folders import, except type declarations. */
function imported(folders) {
  const found = matching(folders, /(?<!\.d)\.ts$/)
    .filter((path) => !path.endsWith("vite.config.ts"))
    .flatMap((path) => [...read(path).matchAll(/(?:^import [^;]*?|^\} from |import\()"([a-z@][^"]*)"/gm)])
    .map((match) =>
      match[1]
        .split("/")
        .slice(0, match[1].startsWith("@") ? 2 : 1)
        .join("/"),
    );
  return [...new Set(found)].filter((name) => !name.startsWith("node:"));
}

const isWhole = (text, licence) => text.replaceAll(/\s+/g, " ").includes(licence.trim().replaceAll(/\s+/g, " "));

describe("the written notices", () => {
  for (const artefact of ARTEFACTS) {
    test(`${artefact.file} names the crates that are compiled, in their versions: npm run notices`, () => {
      const text = read(artefact.file);
      const [crates, library] = text.split(/^Contained by way of /m);
      assert.deepEqual(namedIn(crates).sort(), cratesOf(artefact));
      assert.ok(namedIn(library).includes(`rust-std ${compiler()}`));
      assert.deepEqual(
        headsOf(text)
          .sort()
          .filter((name, index, all) => name !== all[index - 1]),
        [...new Set(namedIn(text))].sort(),
      );
      assert.ok(!/<year>|<copyright holders>/.test(text), "a licence without names");
    });
  }

  test("the colour maps' own notice is among them, which their licence asks for", () => {
    assert.match(read(NOTICES), /Copyright 2010-2018 Mike Bostock/);
  });
});

describe("the package for npm", () => {
  const path = join(folder(), "package");
  const [{ filename }] = JSON.parse(
    run("npm", ["pack", inRoot("pkg"), "--json", "--pack-destination", dirname(path)], inRoot()),
  );
  run("tar", ["-xzf", filename], dirname(path));

  test("carries licences and notices of what its scripts and .wasm files contain", () => {
    const regions = filesBelow(path)
      .filter((file) => file.endsWith(".js"))
      .flatMap((file) => [...readFileSync(file, "utf8").matchAll(/^\/\/ node_modules\/((?:@[^/]+\/)?[^/]+)/gm)]);
    const bundled = [...new Set(regions.map((match) => match[1])), "rolldown"].map(npmPackage);
    assert.ok(bundled.length >= 3);
    const text = carries(path, [...bundled.map(({ named }) => named), ...namedIn(read(NOTICES))]);
    // Claims in sources that the package's licence file lacks, because bundlers remove comments.
    for (const claim of ["Syoyo Fujita", "Industrial Light & Magic", "notmasteryet"])
      assert.ok(text.includes(claim), claim);
    for (const { named, text: licence } of bundled) assert.ok(isWhole(text, licence), named);
  });

  test("holds nothing that is not free", () => assert.deepEqual(unfreeIn(path), []));
});

describe("the site", LONG, () => {
  const path = inRoot(SITE);

  test("carries licences and notices of the page's packages and of ours", async () => {
    await buildSite();
    const bundled = imported(["www"]).map(npmPackage);
    assert.ok(bundled.length >= 2);
    const text = carries(path, [...bundled.map(({ named }) => named), ...namedIn(read(`pkg/${NOTICES}`))]);
    for (const { named, text: licence } of bundled) assert.ok(isWhole(text, licence), named);
  });

  test("is of packages whose licences are free", () => {
    const scripts = readFileSync(join(path, NOTICES), "utf8").split(".wasm files:")[0];
    const licences = [...scripts.matchAll(/^ {2}\S+ \d\S*, (.+)$/gm)].map((match) => match[1]);
    assert.ok(licences.length >= 5);
    for (const licence of licences.flatMap((each) => each.split(/ AND | OR |[()]/)))
      assert.ok(licence === "" || FREE.includes(licence), licence);
  });

  test("shows the notices from its footer, as text", () => {
    assert.match(readFileSync(join(path, "index.html"), "utf8"), new RegExp(`<a href="\\./${NOTICES}"[ >]`));
  });

  test("holds nothing that is not free", () => assert.deepEqual(unfreeIn(path), []));
});

describe("the wheel", () => {
  const wheels = existsSync(inRoot(WHEELS)) ? readdirSync(inRoot(WHEELS)) : [];
  const options = { skip: wheels.length > 0 ? false : "needs the wheel that `npm test -- python` builds" };
  const path = folder();
  for (const name of wheels)
    for (const [file, bytes] of Object.entries(unzipSync(readFileSync(inRoot(WHEELS, name))))) {
      if (file.endsWith("/")) continue;
      mkdirSync(join(path, dirname(file)), { recursive: true });
      writeFileSync(join(path, file), bytes);
    }

  test("carries licences and notices", options, () => {
    const licences = filesBelow(path).find((file) => basename(file) === "LICENSE-MIT");
    assert.ok(licences, "it is in the wheel");
    // Notices of the bindings, and of the .wasm for the widgets.
    for (const file of ["LICENSE-MIT", "LICENSE-APACHE", `python/${NOTICES}`, NOTICES])
      assert.equal(readFileSync(join(dirname(licences), file), "utf8"), read(file));
  });

  test("holds nothing that is not free", options, () => assert.deepEqual(unfreeIn(path), []));
});

describe("the crates", LONG, () => {
  const target = folder();
  const crates = ["bimodal-stereo", "bimodal-stereo-cli", "bimodal-stereo-files"];
  const version = /^version = "(.+)"$/m.exec(read("Cargo.toml"))[1];
  const at = (name) => join(target, "package", `${name}-${version}`);

  test("carry licences and notices of what is compiled from them, and no code of others", () => {
    const packages = crates.flatMap((name) => ["--package", name]);
    run("cargo", ["package", ...packages, "--no-verify", "--allow-dirty", "--target-dir", target], inRoot());
    for (const name of crates) {
      run("tar", ["-xzf", `${at(name)}.crate`], join(target, "package"));
      carries(at(name), []);
    }
    assert.equal(readFileSync(join(at(crates[0]), NOTICES), "utf8"), read(NOTICES));
    assert.equal(readFileSync(join(at(crates[1]), NOTICES), "utf8"), read(`cli/${NOTICES}`));
  });

  test("hold nothing that is not free", () => {
    for (const name of crates) assert.deepEqual(unfreeIn(at(name)), []);
  });
});
