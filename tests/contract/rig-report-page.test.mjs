// What the first page of a report states beside the check's own numbers: its verdict in words, intervals of the unknowns, depth edges, lists.
import assert from "node:assert/strict";
import { spawnSync } from "node:child_process";
import { mkdirSync, mkdtempSync, readFileSync, rmSync, writeFileSync } from "node:fs";
import { tmpdir } from "node:os";
import { join } from "node:path";
import { after, describe, test } from "node:test";
import init, { sampleRig } from "../../pkg/index.js";
import { shellCheck } from "../../pkg/rig-report.js";
import { resultsOf, verdictReason, verdictWords } from "../../pkg/rig-words.js";
import { reportHtml, writePose } from "../../pkg/rig-write.js";
import { writePng } from "../../pkg/write.js";
import { inRoot } from "../../scripts/shell.mjs";
import { harmless } from "./harmless.mjs";
import { report } from "./rig-sample.mjs";
import { refused } from "./support.mjs";

const PIXEL =
  "data:image/png;base64,iVBORw0KGgoAAAANSUhEUgAAAAEAAAABCAYAAAAfFcSJAAAADUlEQVR42mNkYPhfDwAChwGA60e6kgAAAABJRU5ErkJggg==";
const folder = mkdtempSync(join(tmpdir(), "rig-report-"));
after(() => rmSync(folder, { recursive: true, force: true }));

/** The cells of the table of unknowns, by rows: candidate, found, difference, low, high. */
function unknowns(page) {
  const body = /<table class="unknowns stacks">.*?<tbody>(.*?)<\/tbody>/s.exec(page)[1];
  return [...body.matchAll(/<tr>(.*?)<\/tr>/gs)].map(([, row]) => {
    const cells = [...row.matchAll(/<td[^>]*>(.*?)<\/td>/gs)].map(([, cell]) =>
      cell.replace(/<[^>]+>/g, "").replaceAll("\u2212", "-"),
    );
    const [low, high] = cells[3].split(" to ").map(Number);
    return { values: cells.slice(0, 3).map(Number), low, high, unit: cells[4], isBold: row.includes("<strong>") };
  });
}

const product = (a, b) =>
  Array.from({ length: 9 }, (_, i) => [0, 1, 2].reduce((sum, k) => sum + a[i - (i % 3) + k] * b[3 * k + (i % 3)], 0));
const turned = (r, v) => [0, 1, 2].map((i) => r[3 * i] * v[0] + r[3 * i + 1] * v[1] + r[3 * i + 2] * v[2]);
const anglesOf = (r) => {
  const [alpha, beta, gamma] = [Math.atan2(-r[5], r[8]), Math.asin(r[2]), Math.atan2(-r[1], r[0])].map(
    (angle) => (180 / Math.PI) * angle,
  );
  return { alpha, beta, gamma };
};
const about = (axis, angle) => {
  const [c, s] = [Math.cos(angle), Math.sin(angle)];
  return [
    [1, 0, 0, 0, c, -s, 0, s, c],
    [c, 0, s, 0, 1, 0, -s, 0, c],
    [c, -s, 0, s, c, 0, 0, 0, 1],
  ][axis];
};
const posed = (rotation, translation) => ({ scale: 1, rotation, translation, angles: anglesOf(rotation) });

/** A pose after a small rotation about one axis through the scene's centre, or a shift along one. */
function moved({ rotation, translation }, centre, axis, step) {
  const turn = axis < 3 ? about(axis, step) : about(0, 0);
  const arm = translation.map((value, k) => value - centre[k]);
  const shift = turned(turn, arm).map((value, k) => value + centre[k] + (axis === k + 3 ? step : 0));
  return posed(product(turn, rotation), shift);
}

const valuesOf = ({ angles, translation }) => [...Object.values(angles), ...translation.map((t) => 1000 * t)];

describe("the unknowns", () => {
  // Extrinsics of a LiDAR are far from the identity, so the axes of the angles are not those of the covariance.
  const lidar = posed(product(product(about(0, 1.4), about(1, -0.5)), about(2, 2)), [0.1, -0.4, 0.25]);
  const middle = [0.3, -0.2, 4];
  const root = Array.from({ length: 36 }, (_, k) => ((k % 7 === 0 ? 3 : Math.sin(7 * k)) * (k < 18 ? 0.01 : 0.02)) / 3);
  const covariance = Array.from({ length: 36 }, (_, k) =>
    [0, 1, 2, 3, 4, 5].reduce((sum, j) => sum + root[6 * Math.floor(k / 6) + j] * root[6 * (k % 6) + j], 0),
  );

  test("have the intervals of the check's covariance, carried to angles and to the translation", () => {
    const rows = unknowns(reportHtml({ ...report(), estimate: lidar, middle, covariance }));
    const step = 1e-6;
    const columns = [0, 1, 2, 3, 4, 5].map((axis) => {
      const [plus, minus] = [step, -step].map((by) => valuesOf(moved(lidar, middle, axis, by)));
      return plus.map((value, k) => (value - minus[k]) / (2 * step));
    });
    rows.forEach(({ values, low, high }, k) => {
      const variance = columns.reduce(
        (sum, one, i) => sum + columns.reduce((part, other, j) => part + one[k] * other[k] * covariance[6 * i + j], 0),
        0,
      );
      const half = 1.959964 * Math.sqrt(variance);
      assert.ok(Math.abs((high - low) / 2 - half) < 0.006 + 1e-4 * half, `${k}: ${(high - low) / 2}, not ${half}`);
      assert.ok(Math.abs((high + low) / 2 - values[1]) < 0.011, `${k}: about ${values[1]}`);
      assert.ok(Math.abs(values[1] - valuesOf(lidar)[k]) < 0.006, `${k}: found`);
    });
  });

  test("have the candidate, its difference, and a mark where it lies outside", () => {
    const given = { ...report(), estimate: lidar, middle, covariance: covariance.map((value) => 1e-6 * value) };
    const [name] = Object.keys(given.candidates);
    const candidate = moved(lidar, middle, 5, 0.05);
    const rows = unknowns(reportHtml(given, [], { calibrations: { [name]: candidate } }));
    rows.forEach(({ values: [candidate, found, difference], unit, isBold }, k) => {
      assert.ok(Math.abs(candidate - found - difference) < 0.011, `${k}: ${candidate} - ${found} = ${difference}`);
      assert.equal(isBold, k === 5, "the shift along z alone was changed");
      assert.equal(unit, k < 3 ? "°" : "mm");
    });
    assert.ok(
      reportHtml(given, [], { calibrations: { [name]: candidate } }).includes(candidate.translation[2].toFixed(9)),
    );
  });

  test("go the short way around, and say what is not known", () => {
    const [near, beyond] = [179.9, -179.9].map((angle) => posed(about(0, (Math.PI / 180) * angle), [0, 0, 0]));
    const given = { ...report(), estimate: near, middle: undefined };
    const [name] = Object.keys(given.candidates);
    const page = reportHtml(given, [], { calibrations: { [name]: beyond } });
    assert.equal(unknowns(page)[0].values[2], 0.2);
    assert.match(page, /Translation x.*not known/);
  });
});

describe("a calibration that is off within each interval", () => {
  const [name] = Object.keys(report().candidates);
  const candidate = report().estimate;
  const page = (given) => reportHtml(given, [], { calibrations: { [name]: candidate } });
  const WORDS = "The six unknowns are correlated";

  test("is explained", () => {
    assert.ok(page(report()).includes(WORDS));
  });

  test("is not where a value lies outside, nor for another verdict or without the candidate's numbers", () => {
    const far = { ...candidate, translation: [0.1, 0, 0] };
    assert.ok(!reportHtml(report(), [], { calibrations: { [name]: far } }).includes(WORDS));
    const undecided = { ...report().candidates[name], verdict: "undecided" };
    assert.ok(!page({ ...report(), candidates: { [name]: undecided } }).includes(WORDS));
    assert.ok(!reportHtml(report()).includes(WORDS));
  });
});

describe("the verdict in words", () => {
  const of = (verdict, own, warnings = 0) => ({
    ...report(),
    verdict,
    warnings: report().warnings.slice(0, warnings),
    candidates: { a: { ...report().candidates["last week"], verdict: own } },
  });

  test("has the word of the page", () => {
    assert.equal(verdictWords(of("consistent", "consistent")), "Consistent");
    assert.equal(verdictWords(of("undecided", "consistent", 1)), "Undecided, see warnings");
    assert.equal(verdictWords(of("undecided", "undecided", 1)), "Undecided");
    assert.equal(verdictWords(of("off", "off")), "Off");
    assert.equal(verdictWords(of("off", "off", 2)), "Off, see warnings");
    assert.equal(verdictWords(of("off", "off"), true), "Estimated");
  });

  test("is the same in the row of the candidate, with what keeps it from consistent", () => {
    const capped = of("undecided", "consistent", 1);
    const [[name, { verdict, reason }]] = resultsOf(capped);
    assert.deepEqual([name, verdict], ["a", "undecided"]);
    assert.equal(reason, `It would be consistent without the warnings. ${capped.candidates.a.reason}`);
    assert.equal(verdictReason(capped), reason);
    const { text } = harmless(reportHtml(capped));
    assert.ok(text.includes("Undecided, see warnings") && !text.includes("Consistent"), text);
    // Other candidates and verdicts keep their own words.
    assert.deepEqual(resultsOf(report()), Object.entries(report().candidates));
  });

  test("has its number at once, and that of the best fit without a calibration", () => {
    const first = (page) =>
      harmless(page)
        .text.replaceAll("\u202f", " ")
        .match(/[^\n]*expected [^\n]*/)[0];
    assert.match(
      first(reportHtml(report())),
      /^Off, see warnings: expected reprojection error 17\.4 px \(95 %: 15\.8 to/,
    );
    const estimate = first(reportHtml(report(), [], { isEstimate: true }));
    assert.match(estimate, /^Estimated: expected error of the best fit 0\.840 px \(95 %: 0\.520 to 1\.31 px\)/);
    assert.ok(!estimate.includes("factory.yaml"));
  });
});

describe("the depth edges", () => {
  const overlay = {
    frame: "a",
    width: 8,
    height: 6,
    picture: PIXEL,
    before: [1, 2, 2, 2.4, 1, 2],
    after: [9, 1, NaN, 2, 3, 4],
  };

  test("stand on the picture before and after, which the file holds once", () => {
    const page = reportHtml(report(), [], { overlays: [overlay] });
    const { elements } = harmless(page);
    const drawn = elements
      .filter(({ attributes }) => attributes.class === "edge")
      .map(({ attributes }) => attributes.d);
    assert.deepEqual(drawn.slice(0, 2), ["M1 2h1", "M3 4h0"], "runs; points outside the picture are left out");
    assert.equal(page.split(PIXEL).length, 2);
    for (const words of ["Before, with the calibration in question", "After, with the best fit"])
      assert.ok(page.includes(words), words);
  });

  test("of an estimate are one picture", () => {
    const page = reportHtml(report(), [], { overlays: [{ ...overlay, before: undefined }], isEstimate: true });
    assert.ok(!page.includes("Before, ") && page.includes("After, with the best fit"));
  });

  test("need a picture, a size and lists", () => {
    for (const [name, value, code] of [
      ["picture", "https://example.org/x.png", "type"],
      ["width", NaN, "size"],
      ["height", 0, "size"],
      ["after", undefined, "type"],
      ["before", 5, "type"],
    ]) {
      const field = code === "size" ? "options.overlays[0]" : `options.overlays[0].${name}`;
      refused(() => reportHtml(report(), [], { overlays: [{ ...overlay, [name]: value }] }), code, field);
    }
  });
});

test("long lists show their first entries and how many follow", () => {
  const [candidate] = Object.values(report().candidates);
  const many = (count, each) => Array.from({ length: count }, (_, k) => each(k));
  const page = reportHtml(
    {
      ...report(),
      warnings: many(40, (k) => ({ message: `warning ${k}.` })),
      candidates: Object.fromEntries(many(9, (k) => [`calibration ${k}`, candidate])),
    },
    [],
    { inputs: many(200, (k) => ({ name: `file ${k}.` })) },
  );
  const { text } = harmless(page);
  for (const words of ["warning 2.", "and 37 more", "and 6 more", "Files, 200", "file 59.", "and 140 more"])
    assert.ok(text.includes(words), words);
  for (const words of ["warning 3.", "file 60."]) assert.ok(!text.includes(words), words);
});

describe("the command", () => {
  test("quotes names for a shell, and writes files that do not exist", () => {
    const names = ["plain/a-1.txt", "two words", "it's", "$(id)", "-x", "a;b", "", "*"];
    const args = shellCheck({ folder: ".", calibrations: names, written: [{ name: "it's", text: "1 '2' $3\n" }] });
    const shell = args.replace("npx bimodal-stereo", `printf '%s\\n'`);
    const { stdout, status } = spawnSync("sh", ["-c", shell], { cwd: folder, encoding: "utf8" });
    assert.equal(status, 0);
    const passed = names.map((name) => (name === "-x" ? "./-x" : name));
    assert.deepEqual(stdout.trimEnd().split("\n"), [
      "check",
      ".",
      ...passed.flatMap((name) => ["--calibration", name]),
    ]);
    assert.equal(readFileSync(join(folder, "it's"), "utf8"), "1 '2' $3\n");
  });

  test("repeats the check, to the last digit", async () => {
    await init();
    const frames = join(folder, "it's a rig");
    mkdirSync(frames);
    const { image, depth, pose } = await sampleRig({ kind: "objects", seed: 3 });
    writeFileSync(join(frames, "color.png"), await writePng({ ...image, channels: 4 }));
    writeFileSync(join(frames, "depth.png"), await writePng({ ...depth, channels: 1 }));
    const camera = ({ camera: { fx, fy, cx, cy, distortion }, width, height }) => ({
      fx,
      fy,
      cx,
      cy,
      distortion,
      width,
      height,
    });
    writeFileSync(join(folder, "cameras.json"), JSON.stringify({ color: camera(image), depth: camera(depth) }));
    writeFileSync(join(folder, "as rendered.txt"), writePose(pose, "matrix").text);
    const cli = inRoot("pkg/cli.js");
    const given = [
      "--calibration",
      "as rendered.txt",
      "--cameras",
      "cameras.json",
      "--unit",
      "0.001",
      "--cues",
      "edges",
    ];
    const first = spawnSync(
      process.execPath,
      [cli, "check", "it's a rig", ...given, "--json", "first.json", "--report", "first.html"],
      { cwd: folder, encoding: "utf8" },
    );
    assert.equal(first.status, 0, first.stderr);
    const page = readFileSync(join(folder, "first.html"), "utf8");
    const { text } = harmless(page);
    const command = /<pre class="shell"[^>]*>([^<]*)<\/pre>/.exec(page)[1].replaceAll("&#39;", "'");
    // The command runs the tested package, not one that npm would fetch.
    const npx = `npx() { shift; "${process.execPath}" "${cli}" "$@"; }`;
    const again = spawnSync("sh", ["-c", `${npx}\n${command} --json again.json`], { cwd: folder, encoding: "utf8" });
    assert.equal(again.status, 0, again.stderr);
    assert.equal(again.stdout, first.stdout);
    const [one, other] = ["first", "again"].map((name) => readFileSync(join(folder, `${name}.json`), "utf8"));
    assert.equal(other, one);
    const kept = JSON.parse(one);
    for (const { name, sha256 } of kept.inputs)
      assert.ok(text.includes(name.replaceAll("'", "&#39;")) && text.includes(sha256), name);
    for (const words of ["cues edges", "unit 0.001 m", `Node ${process.version}`, "wasm SHA-256", "Before, with"])
      assert.ok(text.includes(words), words);
    assert.equal(kept.tolerance, 3.5 * Math.max(1, image.width / 640));
    const found = unknowns(page).map(({ values }) => values[1]);
    valuesOf(kept.estimate).forEach((value, k) => assert.ok(Math.abs(value - found[k]) < 0.006, `${k}`));
  });
});
