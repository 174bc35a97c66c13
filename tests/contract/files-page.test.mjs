// The page of supported files matches the table beside the readers, the readers do what the table says, and no reader is missing.
import assert from "node:assert/strict";
import { readFileSync, readdirSync } from "node:fs";
import { describe, test } from "node:test";
import { WebSocket } from "ws";
import { readRigFile, readRigFolder } from "../../pkg/rig.js";
import { connectRobot, openRecording } from "../../pkg/rig-recordings.js";
import { DOCUMENT, LIST, catalogue, documentOf, listOf, loaded } from "../../scripts/files.mjs";
import { inRoot } from "../../scripts/shell.mjs";
import { bridge } from "./bridge.mjs";
import { CALIBRATION_SAMPLES } from "./product-calibrations.mjs";
import { FOLDER_SAMPLES } from "./product-folders.mjs";
import { PICTURE_SAMPLES } from "./product-pictures.mjs";
import { PRINT_SAMPLES } from "./product-prints.mjs";
import { refusedFile } from "./rig-support.mjs";

const SAMPLES = { ...CALIBRATION_SAMPLES, ...PICTURE_SAMPLES, ...PRINT_SAMPLES, ...FOLDER_SAMPLES };
const GROUPS = await catalogue();
const ROWS = GROUPS.flatMap(({ rows }) => rows);
const { rasterKind, containerOf } = await loaded(
  'export { rasterKind } from "./rig/formats/headerless.js"; export { containerOf } from "./rig/recordings/kinds.js";',
);
const source = (path) => readFileSync(inRoot("js/rig", path), "utf8");

// Node.js has a WebSocket only from version 22.
globalThis.WebSocket = WebSocket;

test("the page is made of the table", () => {
  assert.equal(readFileSync(inRoot(DOCUMENT), "utf8"), documentOf(GROUPS), "node scripts/files.mjs writes it anew");
  assert.equal(readFileSync(inRoot(LIST), "utf8"), listOf(GROUPS), "node scripts/files.mjs writes it anew");
});

test("the page's list names what people look for", () => {
  for (const name of [
    "KITTI",
    "nuScenes",
    "LiDAR",
    "EXR",
    "LAS",
    "PCD",
    "Azure Kinect",
    "ZED",
    "Polycam",
    "Record3D",
    "Kalibr",
  ])
    assert.ok(listOf(GROUPS).includes(name), name);
});

/** The distinct codes of warnings. */
const codesOf = ({ warnings }) => [...new Set(warnings.map(({ code }) => code))].sort();

/** Reads a sample with the options of its row, and returns the codes. */
const READ = {
  async folder({ files, options }) {
    const found = await readRigFolder(files, options);
    assert.ok(found.frames.length + found.cameras.length > 0);
    return codesOf(found);
  },
  async recording({ name, recording }, row) {
    const content = await recording();
    assert.equal(containerOf(content), row.reader);
    const found = await (await openRecording({ name, content })).read();
    assert.ok(found.frames.length > 0 && found.cameras.length === 2 && found.poses.length > 0);
    return codesOf(found);
  },
  async robot({ robot }) {
    const server = await bridge([robot()]);
    try {
      const { next, chosen } = await connectRobot(server.address).then((found) => ({
        next: (choice) => found.next(choice).finally(() => found.close()),
        chosen: found.chosen,
      }));
      return codesOf(await next(chosen));
    } finally {
      await server.close();
    }
  },
  async refused({ name, bytes }, row) {
    const isKnown = rasterKind(bytes) === row.reader;
    await refusedFile(readRigFile({ name, bytes }), name, isKnown ? /browsers only/ : new RegExp(row.reader));
    return [];
  },
};
const TEXTS = ["cameras", "poses"];

async function file({ name, bytes, options }, row) {
  const found = await readRigFile({ name, bytes: await bytes }, options);
  assert.equal(found.kind, row.reads, found.says);
  if (TEXTS.includes(row.reads)) assert.ok(found.says.startsWith(`${row.reader}: `), found.says);
  else if (row.reader === "raw" || row.reader === "a list of points") assert.match(found.says, new RegExp(row.reader));
  else assert.equal(rasterKind(await bytes), row.reader);
  return codesOf(found);
}

describe("each row's file is read as the table says", () => {
  for (const { title, rows } of GROUPS)
    for (const row of rows)
      test(`${title}: ${row.product}, ${row.file}`, async () => {
        const sample = SAMPLES[row.sample];
        assert.ok(sample, `no sample ${row.sample}`);
        assert.deepEqual(await (READ[row.reads] ?? file)(sample, row), [...row.warnings].sort());
      });
});

test("each row has a sample of its own, and each cell its words", () => {
  assert.ok(ROWS.length > 90, String(ROWS.length));
  assert.deepEqual(ROWS.map(({ sample }) => sample).sort(), Object.keys(SAMPLES).sort());
  const cells = ROWS.flatMap(({ product, file, taken, guessed, exported }) => [
    product,
    file,
    taken,
    guessed,
    exported,
  ]);
  assert.deepEqual(
    cells.filter((words) => words.trim() === "" || /\n/.test(words)),
    [],
  );
});

const READERS = new Set(ROWS.map(({ reader }) => reader));
const missing = (names) => names.filter((name) => !READERS.has(name));
/** The members of a union type. */
const union = (path, name) =>
  [...new RegExp(`type ${name} =([^;]+);`).exec(source(path))[1].matchAll(/"([\w-]+)"/g)].map(([, word]) => word);

test("every product has a row", () => {
  const text = source("formats/products.ts");
  const products = [...text.matchAll(/^ {2}\["(.+)", is\w+, read\w+\],$|, "(a .+?)"\)/gm)].map(
    ([, listed, named]) => listed ?? named,
  );
  assert.ok(products.length > 28, String(products));
  assert.deepEqual(missing(products), []);
});

test("every kind of pixels and points, and every container of a recording, has a row", () => {
  const kinds = [...union("formats/kinds.ts", "Kind"), ...union("formats/headerless.ts", "RasterKind")];
  const containers = union("recordings/kinds.ts", "Container");
  assert.ok(kinds.length > 14 && containers.length > 2);
  assert.deepEqual(missing([...kinds, ...containers]), []);
});

test("every module that reads files has a row, and every row's modules are there", () => {
  const modules = readdirSync(inRoot("js/rig/formats"))
    .filter((name) => /(?<!\.d)\.ts$/.test(name))
    .map((name) => name.replace(/\.ts$/, ""));
  const named = new Set(ROWS.flatMap((row) => row.modules));
  const ofProducts = [...source("formats/products.ts").matchAll(/from "\.\/([\w-]+)\.js"/g)].map(([, name]) => name);
  const reads = /export (?:async )?(?:function|const) (?:read[A-Z]|\w+Picture\b)/;
  const helpers = ["findings", "numbers"];
  const readers = modules.filter(
    (name) => !helpers.includes(name) && (ofProducts.includes(name) || reads.test(source(`formats/${name}.ts`))),
  );
  assert.ok(readers.length > 40, String(readers.length));
  assert.deepEqual(
    readers.filter((name) => !named.has(name)),
    [],
  );
  for (const name of named) assert.ok(modules.includes(name) || source(`${name}.ts`), name);
});

test("a reader without a row is found", () => {
  assert.deepEqual(missing(["png", "a calibration of nothing"]), ["a calibration of nothing"]);
});
