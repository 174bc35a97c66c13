// The package's command `check`: arguments, exit codes, printed and written output. Readers and check are replaced by stubs, so that every
// verdict can be produced; the report is the package's.
import assert from "node:assert/strict";
import { spawn, spawnSync } from "node:child_process";
import { createHash } from "node:crypto";
import { cpSync, mkdirSync, mkdtempSync, readFileSync, readdirSync, rmSync, writeFileSync } from "node:fs";
import { tmpdir } from "node:os";
import { join } from "node:path";
import { after, describe, test } from "node:test";
import { inRoot } from "../../scripts/shell.mjs";
import { report } from "./rig-sample.mjs";

const root = mkdtempSync(join(tmpdir(), "check-folder-"));
after(() => rmSync(root, { recursive: true, force: true }));

/** A stub of the readers: each file holds in JSON the result of reading it. */
const RIG = `
import { BimodalError } from "./rig-write.js";
export async function readRigFile({ name, bytes }) {
  try { return { name, says: "as told", warnings: [], ...JSON.parse(new TextDecoder().decode(bytes)) }; }
  catch { throw new BimodalError("file", \`\${name}: damaged\`, "file"); }
}
export async function readRigFolder(files, options) {
  const readings = [];
  for (const file of files) readings.push(await readRigFile(file));
  const frames = readings.filter(({ kind }) => kind === "frame").map((frame) => ({ depth: {}, image: { width: 1, height: 1, data: new Uint8Array(4) }, ...frame }));
  if (frames[0]?.leaves) return { frames, cameras: [], poses: [], readings, warnings: [{ code: "file-left-out", isDoubt: false, message: "left out" }] };
  return { frames, cameras: [], poses: [], readings, warnings: frames[0]?.sure ? [] : [{ code: "unit-guessed", isDoubt: true, message: "read " + files.map(({ name }) => name.split("/").pop()) + " " + JSON.stringify(options) }] };
}`;
/** A stub of the check: the first frame states the verdict; "wait" continues until it is aborted. */
const INDEX = `
import { report } from ${JSON.stringify(new URL("rig-sample.mjs", import.meta.url).href)};
export default async () => {};
export const projectFrame = async () => ({ edges: new Float32Array(2) });
export async function checkCalibration(frames, candidates, { signal, onProgress, ...options }) {
  if (frames[0].verdict === "named") return called(frames);
  const { verdict, sure } = frames[0];
  for (let k = 0; k <= 100; k++) onProgress(k / 100, "edges of " + frames.length);
  while (verdict === "wait") { await new Promise((go) => setTimeout(go, 10)); signal.throwIfAborted(); }
  if (verdict === "broken") throw new TypeError("a bug");
  return { ...report(), verdict, reason: JSON.stringify({ candidates, options }), warnings: sure ? [] : [{ code: "many-holes", message: "one of the check's" }] };
}`;

/** A report on named frames in which warnings alone keep the first candidate from "consistent". */
const CALLED = `
function called(frames) {
  const made = report();
  const [name, first] = Object.entries(made.candidates)[0];
  const reason = "Its error is 1.0 px; the limit is 3.5 px.";
  return { ...made, verdict: "undecided", code: "doubtful", reason: "Capped.", candidates: { ...made.candidates, [name]: { ...first, verdict: "consistent", reason } },
    frames: frames.map(({ name }) => ({ name, share: 0.5 })), warnings: frames.map(({ name }) => ({ code: "many-holes", message: name + ": 48 % of the depth map is missing." })) };
}`;

mkdirSync(join(root, "pkg"));
mkdirSync(join(root, "examples"));
writeFileSync(join(root, "package.json"), '{ "type": "module" }');
cpSync(inRoot("examples/check-folder.mjs"), join(root, "examples/check-folder.mjs"));
// The command and its dependencies. Some are replaced below.
for (const file of readdirSync(inRoot("pkg")).filter((name) => /\.(js|json|wasm)$/.test(name)))
  cpSync(inRoot("pkg", file), join(root, "pkg", file));
writeFileSync(join(root, "pkg/rig.js"), RIG);
writeFileSync(join(root, "pkg/index.js"), INDEX + CALLED);
writeFileSync(
  join(root, "pkg/rig-write.js"),
  `export * from ${JSON.stringify(new URL("../../pkg/rig-write.js", import.meta.url).href)};`,
);

const write = (path, content) => {
  mkdirSync(join(root, path, ".."), { recursive: true });
  writeFileSync(join(root, path), JSON.stringify(content));
};
const pose = (x) => ({
  scale: 1,
  rotation: [0, -1, 0, 1, 0, 0, 0, 0, 1],
  translation: [x, 0, 0],
  angles: { alpha: 0, beta: 0, gamma: 90 },
});
write("left-out/deep/0001.json", { kind: "frame", verdict: "consistent", sure: true, leaves: true });
write("consistent/deep/0001.json", { kind: "frame", verdict: "consistent", sure: true });
write("guessed/deep/0001.json", { kind: "frame", verdict: "consistent" });
for (const verdict of ["off", "undecided", "wait", "broken", "odd"])
  write(`${verdict}/deep/0001.json`, { kind: "frame", verdict });
for (const name of ["0", "left"]) write(`named/${name}.json`, { kind: "frame", verdict: "named", name });
write("none/0001.json", { kind: "other" });
write("off/.hidden/0002.json", { kind: "frame", verdict: "consistent" });
write("one.json", { kind: "poses", poses: [{ pose: pose(1) }] });
write("two.json", {
  kind: "cameras",
  warnings: [{ code: "lens-approximated", isDoubt: true, message: "a guess" }],
  poses: [
    { pose: pose(2), from: "color", to: "depth" },
    { name: "spare", pose: pose(3), from: "depth", to: "color" },
  ],
});
write("7", { kind: "poses", poses: [{ pose: pose(7) }] });
write("world.json", { kind: "poses", poses: [{ pose: pose(4), from: "camera", to: "world" }] });
write("empty.json", { kind: "poses", poses: [] });
write("lens.json", { kind: "cameras", cameras: [{}], poses: [] });
writeFileSync(join(root, "damaged.json"), "{");

const command = [join(root, "examples/check-folder.mjs")];
function check(...args) {
  const { status, stdout, stderr } = spawnSync(process.execPath, [...command, ...args], {
    cwd: root,
    encoding: "utf8",
  });
  return { status, stdout, stderr };
}
/** The arguments that the check received. */
const asked = (stdout) => JSON.parse(/^\w+: (\{.*\})$/m.exec(stdout)[1]);

describe("exit codes", () => {
  for (const [folder, code] of Object.entries({ consistent: 0, off: 1, undecided: 2, odd: 3 })) {
    test(`${folder}: ${code}`, () => {
      const { status, stdout, stderr } = check(folder, "--calibration", "one.json");
      assert.equal(status, code, stderr);
      assert.match(stdout, new RegExp(`^${folder.toUpperCase()}: `));
    });
  }

  test("2 where it is consistent but for what the readers guessed, and its word is said once", () => {
    assert.match(check("consistent", "--calibration", "one.json").stdout, /^CONSISTENT: \{/);
    for (const args of [
      ["guessed", "--calibration", "one.json"],
      ["consistent", "--calibration", "two.json"],
    ]) {
      const { status, stdout } = check(...args, "--json", "guessed.json");
      assert.equal(status, 2);
      assert.match(
        stdout,
        /^UNDECIDED: It would be consistent without this warning: (one of the check's|two.json: a guess) /,
      );
      assert.equal(JSON.parse(readFileSync(join(root, "guessed.json"), "utf8")).verdict, "undecided");
    }
    assert.doesNotMatch(check("off", "--calibration", "one.json").stdout, /Settled/);
  });

  test("a capped verdict has one word in the first line and in its row, and a frame whose name is a number is called one", () => {
    const { status, stdout } = check("named", "--calibration", "one.json");
    assert.equal(status, 2);
    assert.match(stdout, /^UNDECIDED: It would be consistent without the warnings\. Its error is 1\.0 px; /);
    assert.match(stdout, /^factory\.yaml +undecided /m);
    assert.match(stdout, /^frames: frame 1 \(0\) 50 %, left 50 %$/m);
    assert.match(stdout, /^warning: frame 1 \(0\): 48 % of the depth map is missing\.$/m);
  });

  test("3 for what is wrong with the input, said in one line", () => {
    const wrong = {
      "one folder is needed": [],
      "not 2": ["off", "consistent", "--calibration", "one.json"],
      "--calibration FILE is needed": ["off"],
      "damaged.json: damaged": ["off", "--calibration", "damaged.json"],
      "empty.json: it contains no extrinsics": ["off", "--calibration", "empty.json"],
      "world.json: it gives the pose of a camera in the world": ["off", "--calibration", "world.json"],
      "none: it contains no readable pair": ["none", "--calibration", "one.json"],
      "ENOENT.*missing.json": ["off", "--calibration", "missing.json"],
      "missing.json: it cannot be read": ["off", "--calibration", "one.json", "--cameras", "missing.json"],
      "damaged.json: damaged[^]*$": ["off", "--calibration", "one.json", "--cameras", "damaged.json"],
      "one.json: it contains no intrinsics": ["off", "--calibration", "one.json", "--cameras", "one.json"],
      "ENOENT.*nowhere": ["nowhere", "--calibration", "one.json"],
      '--workers needs a number, not "many"': ["off", "--calibration", "one.json", "--workers", "many"],
      "Unknown option '--jsn'": ["off", "--calibration", "one.json", "--jsn", "x"],
    };
    for (const [message, args] of Object.entries(wrong)) {
      const { status, stderr, stdout } = check(...args);
      assert.equal(status, 3, message);
      assert.match(stderr.trim().split("\n").at(-1), new RegExp(message));
      assert.equal(stdout, "");
    }
  });

  test("with --json - an error is JSON with its code", () => {
    for (const [code, field, ...args] of [
      ["file", "file", "off", "--calibration", "damaged.json"],
      ["file", "file", "off", "--calibration", "one.json", "--cameras", "missing.json"],
      ["file", "file", "none", "--calibration", "one.json"],
      ["file", "file", "nowhere", "--calibration", "one.json"],
      ["file", "file", "off", "--calibration", "world.json"],
    ]) {
      const { status, stdout, stderr } = check(...args, "--json", "-");
      const { error } = JSON.parse(stdout);
      assert.deepEqual([status, error.code, error.field], [3, code, field]);
      assert.ok(stderr.trim().endsWith(error.message), stderr);
    }
  });

  test("3 where a file cannot be written, below the verdict", () => {
    for (const option of ["--json", "--report"]) {
      const { status, stderr, stdout } = check("off", "--calibration", "one.json", option, "no/such/file");
      assert.equal(status, 3);
      assert.match(stderr.trim().split("\n").at(-1), /ENOENT.*no\/such/);
      assert.match(stdout, /^OFF: /);
    }
  });

  test("3 with the place for a bug, which is no verdict", () => {
    const { status, stderr } = check("broken", "--calibration", "one.json");
    assert.equal(status, 3);
    assert.match(stderr, /TypeError: a bug\n +at /);
  });

  test("130 when it is interrupted", async () => {
    const child = spawn(process.execPath, [...command, "wait", "--calibration", "one.json"], { cwd: root });
    let said = "";
    child.stderr.on("data", (chunk) => {
      if (!said.includes("100 %") && `${said}${chunk}`.includes("100 %")) child.kill("SIGINT");
      said += chunk;
    });
    assert.equal(await new Promise((done) => child.on("close", done)), 130, said);
    assert.match(said, /interrupted/);
  });

  test("0 for --help, which names every code", () => {
    const { status, stdout } = check("--help");
    assert.equal(status, 0);
    assert.match(stdout, /0 consistent, 1 off, 2 undecided or consistent with a warning, 3 /);
  });

  test("2 is for what makes a doubt, and not for what was left out", () => {
    assert.equal(check("left-out", "--calibration", "one.json").status, 0);
  });
});

describe("what is checked", () => {
  test("the first pose of the first file is in question; a number as a name stays in its place", () => {
    const { candidates } = asked(
      check(
        "off",
        "--calibration",
        "one.json",
        "--calibration",
        "two.json",
        "--calibration",
        "7",
        "--calibration",
        "one.json",
      ).stdout,
    );
    assert.deepEqual(Object.keys(candidates), [
      "one.json",
      "two.json, color to depth",
      "two.json, spare",
      '"7"',
      "one.json'",
    ]);
    assert.deepEqual(candidates["one.json"], pose(1));
    assert.deepEqual(candidates["two.json, spare"], pose(3));
  });

  test("names that say colour to depth are inverted, and that is said", () => {
    const { stdout } = check("off", "--calibration", "two.json");
    const { rotation, translation, angles } = asked(stdout).candidates["two.json, color to depth"];
    assert.deepEqual(
      [rotation, translation.map((value) => value + 0)],
      [
        [0, 1, 0, -1, 0, 0, 0, 0, 1],
        [0, 2, 0],
      ],
    );
    assert.ok(Math.abs(angles.gamma + 90) < 1e-12 && angles.alpha + angles.beta === 0, JSON.stringify(angles));
    assert.match(stdout, /warning: two.json: it maps color to depth; its inverse was checked/);
    assert.match(stdout, /warning: two.json: a guess/);
  });

  test("--inverted says so of files without names", () => {
    const { candidates } = asked(check("off", "--calibration", "one.json", "--inverted").stdout);
    assert.deepEqual(
      candidates["one.json"].translation.map((value) => value + 0),
      [0, 1, 0],
    );
  });

  test("options reach readers and check; intrinsics that were named come first, hidden files not at all", () => {
    const args = ["--cues", "edges, shading", "--workers", "2", "--unit", "0.001", "--frames", "5"];
    const { stdout } = check("off", "--calibration", "two.json", "--cameras", "lens.json", ...args);
    assert.deepEqual(asked(stdout).options, { workers: 2, cues: ["edges", "shading"] });
    assert.ok(stdout.includes('warning: read lens.json,two.json,0001.json {"frames":5,"unit":0.001}'), stdout);
  });

  test("a calibration that lies in the folder is read once", () => {
    write("guessed/deep/rig.json", { kind: "cameras", poses: [{ pose: pose(1) }] });
    const { stdout } = check("guessed", "--calibration", "guessed/deep/rig.json");
    assert.ok(stdout.includes("warning: read rig.json,0001.json {}"), stdout);
  });
});

describe("what comes out", () => {
  test("the numbers, and progress that a log can hold", () => {
    const { stdout, stderr } = check("off", "--calibration", "one.json");
    for (const words of [
      "factory.yaml",
      "1.92 deg",
      "21.3 mm",
      "17.4 (15.8 to 19.1)",
      "best fit",
      "0.84 (0.52 to 1.31)",
      "edges 55 %",
      "a bare wall",
      "one of the check's",
    ]) {
      assert.ok(stdout.includes(words), words);
    }
    assert.ok(stdout.includes(report().estimate.rotation.slice(0, 3).join(" ")), "with all digits");
    assert.deepEqual(
      stderr.match(/\d+ %/g),
      Array.from({ length: 11 }, (_, k) => `${10 * k} %`),
    );
    assert.ok(!/[\r\x1b]/.test(stderr));
  });

  test("JSON and a page, with what was read and its hashes", () => {
    assert.equal(check("off", "--calibration", "one.json", "--json", "out.json", "--report", "out.html").status, 1);
    const json = JSON.parse(readFileSync(join(root, "out.json"), "utf8"));
    const { reason, warnings, verdict, ...rest } = report();
    const { inputs, reason: _, warnings: all, ...found } = json;
    assert.deepEqual(found, JSON.parse(JSON.stringify({ verdict, ...rest })));
    assert.equal(all.length, 2);
    const hash = (path) =>
      createHash("sha256")
        .update(readFileSync(join(root, path)))
        .digest("hex");
    assert.deepEqual(inputs, [
      { name: "one.json", says: "as told", sha256: hash("one.json") },
      { name: "deep/0001.json", says: "as told", sha256: hash("off/deep/0001.json") },
    ]);
    const page = readFileSync(join(root, "out.html"), "utf8");
    for (const words of ["Check of one.json", hash("one.json"), "Content-Security-Policy"])
      assert.ok(page.includes(words), words);
  });

  test("--json - leaves the standard output to the JSON", () => {
    const { stdout, stderr } = check("undecided", "--calibration", "one.json", "--json", "-");
    assert.equal(JSON.parse(stdout).verdict, "undecided");
    assert.match(stderr, /UNDECIDED: /);
  });
});
