// Files of a run: the very ones that readers of others have read (scripts/reference/run-written.py), and what these found in them.
import assert from "node:assert/strict";
import { readFileSync } from "node:fs";
import { describe, test } from "node:test";
import { decode } from "fast-png";
import { decodeDepth } from "../../pkg/files.js";
import { BimodalError as WriteError, depthPng, lightCsv, matrixText, normalsPng, poseJson, runReportHtml, writeClouds, writeNpy, writePng } from "../../pkg/write.js";
import { CLOUDS, DEPTH, FAR, FOLDER, LIGHT, NORMALS, PIXELS, POSE, files } from "../../scripts/reference/run-written.mjs";
import { inRoot } from "../../scripts/shell.mjs";
import { harmless } from "./harmless.mjs";
import { BimodalError, refused } from "./support.mjs";

const read = JSON.parse(readFileSync(inRoot(FOLDER, "read.json"), "utf8"));
/** As the reference has them: what is not finite by its name. */
const named = (value) => (Number.isFinite(value) ? value : { NaN: "nan", Infinity: "inf" }[String(value)]);

test("both modules throw the same class", () => assert.equal(WriteError, BimodalError));

test("every file is written again, byte for byte; of a PNG the pixels, since deflate is the platform's", async () => {
  for (const [name, bytes] of Object.entries(await files())) {
    const kept = readFileSync(inRoot(FOLDER, name));
    if (!name.endsWith(".png")) assert.deepEqual(Buffer.from(bytes), kept, name);
    else assert.deepEqual([...decode(bytes).data], [...decode(kept).data], name);
  }
});

describe("what others read is what was written", () => {
  test("the pose, by numpy and as JSON", () => {
    const [a, b, c, d, e, f, g, h, i] = POSE.rotation.map((value) => POSE.scale * value);
    const [x, y, z] = POSE.translation;
    assert.deepEqual(read.pose.matrix, [[a, b, c, x], [d, e, f, y], [g, h, i, z], [0, 0, 0, 1]]);
    assert.equal(read.pose.unit, "m");
    // A point that Open3D has moved by it.
    const [px, py, pz] = [0.1, -0.2, 0.7];
    const moved = [a * px + b * py + c * pz + x, d * px + e * py + f * pz + y, g * px + h * py + i * pz + z];
    read.pose.moved.forEach((value, axis) => assert.ok(Math.abs(value - moved[axis]) < 1e-12));
  });

  test("the pose with how far it is to be trusted, where a report says so", () => {
    const plain = JSON.parse(poseJson(POSE, "px"));
    const uncertainty = { rotationDegrees: [0.1, 0.2, 0.3], translation: [0.4, 0.5, null], scale: null, weakest: "translation along y" };
    const { about, ...told } = JSON.parse(poseJson(POSE, "px", { status: "ambiguous", message: "another pose explains the colours as well", uncertainty, iteration: 7 }));
    const { about: before, ...kept } = plain;
    assert.deepEqual(told, { ...kept, status: "ambiguous", message: "another pose explains the colours as well", uncertainty });
    assert.ok(about.startsWith(before));
    assert.match(about, /null where the views cannot see/);
    // A run that is not over has a status alone.
    assert.deepEqual(JSON.parse(poseJson(POSE, "px", { status: "running" })), { ...plain, status: "running" });
  });

  test("light, by numpy", () => assert.deepEqual(read["light.csv"].values, [...LIGHT]));

  test("clouds, by Open3D", () => {
    for (const unit of ["metres", "pixels"]) {
      const { points, colours, labels, comments } = read[`clouds-${unit}.ply`];
      const there = CLOUDS.map(({ points }) => [...points].map((_, i) => Number.isFinite(points[i - (i % 3)])));
      assert.deepEqual(points, CLOUDS.flatMap(({ points }, k) => [...points].filter((_, i) => there[k][i])));
      assert.deepEqual(colours, CLOUDS.flatMap(({ colours }, k) => [...colours].filter((_, i) => there[k][i])));
      assert.deepEqual(labels, [0, 0, 1]);
      assert.equal(comments[0], `comment ${unit}; x right, y down, z forward`);
    }
  });

  test(".npy, by numpy", () => {
    assert.deepEqual(read["depth.npy"], { shape: [5, 7], type: "float32", values: [...DEPTH].map(named) });
    assert.deepEqual(read["normals.npy"], { shape: [5, 7, 3], type: "float32", values: [...NORMALS].map(named) });
    assert.deepEqual(read["levels.npy"], { shape: [5, 7], type: "uint16", values: [...DEPTH].map((_, i) => 1871 * i) });
  });

  for (const [name, depth, step, unit] of [["depth", DEPTH, 0.0001, "0.1 mm"], ["depth-far", FAR, 0.001, "1 mm"], ["depth-pixels", PIXELS, 0.01, "0.01 px"]]) {
    test(`${name}, 16 bits in steps of ${unit}, by OpenCV and Pillow`, () => {
      const { shape, type, values, texts } = read[`${name}.png`];
      assert.deepEqual([shape, type], [[5, 7], "uint16"]);
      assert.equal(texts.Unit, `${unit} per stored number; 0 is no depth`);
      values.forEach((stored, i) => {
        if (!(depth[i] > 0) || !Number.isFinite(depth[i])) assert.equal(stored, 0);
        else assert.ok(Math.abs(stored * step - depth[i]) <= (step / 2) * (1 + 1e-6), `${stored} ${depth[i]}`);
      });
    });
  }

  test("normals, 16 bits of red, green and blue", () => {
    const { shape, type, values, texts } = read["normals.png"];
    assert.deepEqual([shape, type], [[5, 7, 3], "uint16"]);
    assert.match(texts.Description, /x right, y up, z towards the viewer/);
    values.forEach((stored, i) => {
      if (Number.isNaN(NORMALS[i])) return assert.equal(stored, 0);
      const found = ((2 * stored) / 65535 - 1) * (i % 3 === 0 ? 1 : -1);
      assert.ok(Math.abs(found - NORMALS[i]) < 2e-5);
    });
  });

  test("8 bits of grey", () => assert.deepEqual(read["grey.png"].values, [...DEPTH].map((_, i) => 7 * i)));
});

test("depths come back by our own readers", async () => {
  const back = decodeDepth(writeNpy({ width: 7, height: 5, channels: 1, data: DEPTH }));
  assert.deepEqual(back, { width: 7, height: 5, data: DEPTH });
  const { bytes, step, says } = await depthPng({ width: 7, height: 5, data: DEPTH }, "m");
  assert.deepEqual([step, says], [0.0001, "0.1 mm"]);
  assert.ok(Math.abs(decodeDepth(bytes).data[0] * step - DEPTH[0]) <= step / 2);
});

test("depths beyond every step are held at the largest number, and a depth of less than half a step is still one", async () => {
  const { bytes, step, lost } = await depthPng({ width: 5, height: 1, data: new Float32Array([1e9, 1e-9, 5, -2, NaN]) }, "px");
  // The first and the one below zero are not in it.
  assert.deepEqual([step, lost], [1, 2]);
  assert.deepEqual([...decodeDepth(bytes).data], [65535, 1, 5, 0, 0]);
  assert.equal((await depthPng({ width: 7, height: 5, data: DEPTH }, "m")).lost, DEPTH.filter((value) => value < 0).length);
});

test("what does not fit is refused by its name", async () => {
  refused(() => writeNpy({ width: 2, height: 2, channels: 1, data: new Float32Array(3) }), "size", "raster");
  refused(() => matrixText({ ...POSE, translation: [1, NaN, 2] }), "range", "pose");
  refused(() => matrixText({ ...POSE, rotation: [1, 0, 0] }), "range", "pose");
  refused(() => poseJson({ ...POSE, scale: Infinity }, "m"), "range", "pose");
  refused(() => lightCsv([1, 2, 3]), "size", "light");
  refused(() => writeClouds([], "pixels"), "size", "clouds");
  for (const clouds of [undefined, {}]) refused(() => writeClouds(clouds), "type", "clouds");
  for (const cloud of [null, {}]) refused(() => writeClouds([cloud]), "type", "clouds[0].points");
  assert.ok(!new TextDecoder("latin1").decode(writeClouds([{ points: new Float32Array(3) }], "m\nend_header")).includes("\nend_header;"));
  refused(() => matrixText(), "type", "pose");
  refused(() => matrixText({ ...POSE, rotation: [...POSE.rotation, 1, 2, 3] }), "range", "pose");
  refused(() => matrixText({ ...POSE, translation: [1, 2, 3, 4, 5] }), "range", "pose");
  refused(() => poseJson(POSE, "furlong"), "option", "unit");
  refused(() => lightCsv(), "type", "light");
  refused(() => lightCsv(LIGHT.map(() => NaN)), "range", "light");
  refused(() => lightCsv(Array.from(LIGHT, () => "=1+1")), "type", "light");
  refused(() => writeNpy(), "type", "raster");
  refused(() => writeNpy({ width: 0.5, height: 2, channels: 1, data: new Float32Array(1) }), "range", "raster.width");
  refused(() => writeNpy({ width: -1, height: -1, channels: 1, data: new Float32Array(1) }), "range", "raster.width");
  refused(() => writeNpy({ width: 1, height: 1, channels: 1, data: new Int8Array(1) }), "type", "raster.data");
  const rejected = (promise, code, field) => assert.rejects(promise, (error) => error instanceof BimodalError && error.code === code && error.field === field);
  await rejected(writePng({ width: 1, height: 1, channels: 2, data: new Uint8Array(2) }), "unsupported", "raster.channels");
  await rejected(writePng({ width: 1, height: 1, channels: 1, data: new Float32Array(1) }), "type", "raster.data");
  await rejected(depthPng({ width: 2, height: 2, data: new Float32Array(3) }, "m"), "size", "depth");
  await rejected(depthPng({ width: 1, height: 1, data: new Float32Array(1) }), "type", "unit");
  await rejected(normalsPng({ width: 2, height: 2, data: new Float32Array(4) }), "size", "normals");
});

test("doubles, such as a light's, are doubles in .npy", () => {
  const bytes = writeNpy({ width: 27, height: 1, channels: 1, data: Float64Array.from(LIGHT) });
  assert.match(new TextDecoder("latin1").decode(bytes.subarray(0, 80)), /'<f8'/);
  assert.deepEqual([...new Float64Array(bytes.slice(-27 * 8).buffer)], [...LIGHT]);
});

test("remarks of a PNG stay remarks, whatever they hold", async () => {
  const bytes = await writePng({ width: 1, height: 1, channels: 1, data: new Uint8Array([9]) }, { "Na\0me": "\u202e\n\0é" });
  assert.deepEqual([...decode(bytes).data], [9]);
  assert.deepEqual(Object.entries(decode(bytes).text), [["Na?me", "????"]]);
});

describe("the report of a run", () => {
  const PIXEL = "data:image/png;base64,iVBORw0KGgoAAAANSUhEUgAAAAEAAAABCAYAAAAfFcSJAAAADUlEQVR42mNkYPhfDwAChwGA60e6kgAAAABJRU5ErkJggg==";
  const EVIL = `</style></title><script>alert(1)</script><img src=x onerror=alert(2)>"'&amp;`;
  const run = (changes = {}) => ({
    ...{ tone: "good", status: "converged, 0.12° off", words: ["The true pose was found."], pose: POSE, truth: POSE, unit: "m", light: LIGHT },
    ...{ numbers: [["Overlap", "81 %"]], options: [["Light", "estimate"]], pictures: [{ title: "Normals", dataUrl: PIXEL }] },
    ...{ inputs: [{ name: "a.png", says: "128x96", sha256: "ab".repeat(32) }], made: new Date(Date.UTC(2026, 1, 28, 9, 5)), link: "https://example.org/#size=64" },
    ...changes,
  });

  test("holds verdict, pose beside the truth, light, options, files and pictures, and asks for nothing", () => {
    const page = runReportHtml(run());
    const { elements, text } = harmless(page);
    for (const words of ["converged, 0.12° off", "The true pose was found.", "81 %", "1.2500", "17.19°", "-0.02503", "Found", "True", "estimate", "a.png", "128x96", "ab".repeat(32), "2026-02-28 09:05 UTC", "https://example.org/#size=64", matrixText(POSE), lightCsv(LIGHT)]) {
      assert.ok(text.includes(words), words);
    }
    assert.deepEqual(elements.filter(({ name }) => name === "img").map(({ attributes }) => attributes), [{ src: PIXEL, alt: "Normals" }]);
    assert.match(page, /default-src &#39;none&#39;; img-src data:/);
    assert.equal(runReportHtml(run()), page);
  });

  test("says nothing of a truth that is not known, and that z is free in a view without a camera", () => {
    assert.ok(!harmless(runReportHtml(run({ truth: null }))).text.includes("True"));
    assert.ok(harmless(runReportHtml(run({ unit: "px" }))).text.includes("free"));
  });

  test("escapes whatever comes from elsewhere", () => {
    const evil = run({ status: EVIL, words: [EVIL], numbers: [[EVIL, EVIL]], options: [[EVIL, EVIL]], pictures: [{ title: EVIL, dataUrl: PIXEL }], inputs: [{ name: EVIL, says: EVIL, sha256: EVIL }], title: EVIL, link: EVIL });
    const page = runReportHtml(evil);
    harmless(page);
    assert.ok(!page.includes("<script"));
    refused(() => runReportHtml(run({ pictures: [{ title: "", dataUrl: "https://example.org/x.png" }] })), "type", "pictures[0].dataUrl");
  });
});
