// Files of a run: the same files that independent readers have read (scripts/reference/run-written.py), and the readers' results.
import assert from "node:assert/strict";
import { readFileSync } from "node:fs";
import { before, describe, test } from "node:test";
import { decode } from "fast-png";
import { decodeColour, decodeDepth } from "../../pkg/files.js";
import {
  BimodalError as WriteError,
  depthPng,
  lightCsv,
  matrixText,
  normalsPng,
  poseJson,
  runReportHtml,
  writeClouds,
  writeNpy,
  writePng,
} from "../../pkg/write.js";
import {
  CLOUDS,
  DEPTH,
  FAR,
  FOLDER,
  LIGHT,
  NORMALS,
  PIXELS,
  POSE,
  files,
} from "../../scripts/reference/run-written.mjs";
import { inRoot } from "../../scripts/shell.mjs";
import { harmless } from "./harmless.mjs";
import { BimodalError, estimator, init, pair, refused } from "./support.mjs";

const read = JSON.parse(readFileSync(inRoot(FOLDER, "read.json"), "utf8"));
/** Numbers in the form of the reference, which has names for those that are not finite. */
const named = (value) => (Number.isFinite(value) ? value : { NaN: "nan", Infinity: "inf" }[String(value)]);

/** Checks that a promise is rejected with this code and field, and a message that matches. */
async function rejected(promise, code, field, words = /./) {
  const error = await promise.then(
    () => undefined,
    (reason) => reason,
  );
  refused(
    () => {
      throw error;
    },
    code,
    field,
  );
  assert.match(error.message, words);
}

before(() => init());

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
    assert.deepEqual(read.pose.matrix, [
      [a, b, c, x],
      [d, e, f, y],
      [g, h, i, z],
      [0, 0, 0, 1],
    ]);
    assert.equal(read.pose.unit, "m");
    // A point that Open3D has transformed.
    const [px, py, pz] = [0.1, -0.2, 0.7];
    const moved = [a * px + b * py + c * pz + x, d * px + e * py + f * pz + y, g * px + h * py + i * pz + z];
    read.pose.moved.forEach((value, axis) => assert.ok(Math.abs(value - moved[axis]) < 1e-12));
  });

  test("the pose with how far it is to be trusted, where a report says so", () => {
    const plain = JSON.parse(poseJson(POSE, "px"));
    const uncertainty = {
      rotationDegrees: [0.1, 0.2, 0.3],
      translation: [0.4, 0.5, null],
      scale: null,
      weakest: "translation along y",
    };
    const { about, ...told } = JSON.parse(
      poseJson(POSE, "px", {
        status: "ambiguous",
        reason: { code: "rivals", count: 1, nearestDegrees: 40.5 },
        message: "another pose fits the image equally well",
        uncertainty,
        iteration: 7,
      }),
    );
    const { about: before, ...kept } = plain;
    assert.deepEqual(told, {
      ...kept,
      status: "ambiguous",
      reason: { code: "rivals", count: 1, nearestDegrees: 40.5 },
      message: "another pose fits the image equally well",
      uncertainty,
    });
    assert.ok(about.startsWith(before));
    assert.match(about, /null where the views do not determine/);
    // For a run that has not ended, only the status is written.
    assert.deepEqual(JSON.parse(poseJson(POSE, "px", { status: "running" })), { ...plain, status: "running" });
  });

  test("the pose alone, whatever else an object holds", () => {
    const mine = {
      ...POSE,
      rotation: Float64Array.from(POSE.rotation),
      unit: "furlong",
      about: "mine",
      matrix: 3,
      toJSON: () => "gone",
    };
    mine.self = mine;
    assert.equal(poseJson(mine, "m"), poseJson(POSE, "m"));
  });

  test("light, by numpy", () => assert.deepEqual(read["light.csv"].values, [...LIGHT]));

  test("clouds, by Open3D", () => {
    for (const unit of ["metres", "pixels"]) {
      const { points, colours, labels, comments } = read[`clouds-${unit}.ply`];
      const there = CLOUDS.map(({ points }) => [...points].map((_, i) => Number.isFinite(points[i - (i % 3)])));
      assert.deepEqual(
        points,
        CLOUDS.flatMap(({ points }, k) => [...points].filter((_, i) => there[k][i])),
      );
      assert.deepEqual(
        colours,
        CLOUDS.flatMap(({ colours }, k) => [...colours].filter((_, i) => there[k][i])),
      );
      assert.deepEqual(labels, [0, 0, 1]);
      assert.equal(comments[0], `comment ${unit}; x right, y down, z forward`);
    }
  });

  test(".npy, by numpy", () => {
    assert.deepEqual(read["depth.npy"], { shape: [5, 7], type: "float32", values: [...DEPTH].map(named) });
    assert.deepEqual(read["normals.npy"], { shape: [5, 7, 3], type: "float32", values: [...NORMALS].map(named) });
    assert.deepEqual(read["levels.npy"], { shape: [5, 7], type: "uint16", values: [...DEPTH].map((_, i) => 1871 * i) });
  });

  for (const [name, depth, step, unit] of [
    ["depth", DEPTH, 0.0001, "0.1 mm"],
    ["depth-far", FAR, 0.001, "1 mm"],
    ["depth-pixels", PIXELS, 0.01, "0.01 px"],
  ]) {
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

  test("8 bits of grey", () =>
    assert.deepEqual(
      read["grey.png"].values,
      [...DEPTH].map((_, i) => 7 * i),
    ));
});

test("depths come back by our own readers", async () => {
  const back = decodeDepth(writeNpy({ width: 7, height: 5, channels: 1, data: DEPTH }));
  assert.deepEqual(back, { width: 7, height: 5, data: DEPTH });
  const { bytes, step, says } = await depthPng({ width: 7, height: 5, data: DEPTH }, "m");
  assert.deepEqual([step, says], [0.0001, "0.1 mm"]);
  assert.ok(Math.abs(decodeDepth(bytes).data[0] * step - DEPTH[0]) <= step / 2);
});

describe("depths in 16 bits", () => {
  const row = (...values) => ({ width: values.length, height: 1, data: new Float32Array(values) });
  const stored = async (depth, unit) => {
    const { bytes, step } = await depthPng(depth, unit);
    return [step, ...decodeDepth(bytes).data];
  };

  test("the farthest that has room is written, and a depth of less than half a step is still one", async () => {
    assert.deepEqual(await stored(row(65535.25, 1e-9, 5, NaN, 0), "px"), [1, 65535, 1, 5, 0, 0]);
    assert.deepEqual(await stored(row(65535, 2), "m"), [1, 65535, 2]);
    assert.deepEqual(await stored(row(6.5535, 2), "m"), [0.0001, 65535, 20000]);
  });

  test("what is farther is refused by its name, but for 1e12 and more, which are holes", async () => {
    await rejected(depthPng(row(1, 1e9), "m"), "range", "depth.data[1]", /1000000000 m is beyond 65535 m.*writeNpy/);
    await rejected(depthPng(row(65536), "px"), "range", "depth.data[0]", /65536 px is beyond 65535 px/);
    assert.deepEqual(await stored(row(1, 1e12, Infinity), "m"), [0.0001, 10000, 0, 0]);
  });

  test("below zero a view without a camera has depths, which are refused by name; behind a camera there is none", async () => {
    await rejected(
      depthPng(row(NaN, 5, -2.5, -3), "px"),
      "range",
      "depth.data[2]",
      /-2.5 px would be a hole; shift the depths.*writeNpy/,
    );
    assert.deepEqual(await stored(row(5, -2.5, -Infinity), "m"), [0.0001, 50000, 0, 0]);
    const { image, depth, light } = pair();
    const run = estimator({}, { image, depth, light });
    run.step();
    const { width, height } = image;
    const data = run.imageDepth();
    await rejected(
      depthPng({ width, height, data }, "px"),
      "range",
      `depth.data[${data.findIndex((value) => value < 0)}]`,
    );
    // Refined depths of the page are compared where the depth map has depths.
    const refined = run.refinedDepth();
    const back = decodeDepth(
      (await depthPng({ width: depth.width, height: depth.height, data: refined }, "px")).bytes,
    ).data;
    assert.deepEqual(
      [...back].map((value) => value > 0),
      [...refined].map((value) => Number.isFinite(value)),
    );
    run.free();
  });
});

test("what does not fit is refused by its name", async () => {
  refused(() => writeNpy({ width: 2, height: 2, channels: 1, data: new Float32Array(3) }), "size", "raster");
  refused(() => matrixText({ ...POSE, translation: [1, NaN, 2] }), "range", "pose.translation");
  refused(() => matrixText({ ...POSE, rotation: [1, 0, 0] }), "size", "pose.rotation");
  refused(() => poseJson({ ...POSE, scale: Infinity }, "m"), "range", "pose.scale");
  refused(() => poseJson({ ...POSE, angles: { ...POSE.angles, beta: NaN } }, "m"), "range", "pose.angles.beta");
  refused(() => poseJson({ ...POSE, angles: undefined }, "m"), "type", "pose.angles");
  refused(() => poseJson(POSE, "m", "converged"), "type", "report.status");
  refused(() => poseJson(POSE, "m", { status: "lost", uncertainty: "large" }), "type", "report.uncertainty");
  refused(() => lightCsv([1, 2, 3]), "size", "light");
  refused(() => writeClouds([], "pixels"), "size", "clouds");
  for (const clouds of [undefined, {}]) refused(() => writeClouds(clouds), "type", "clouds");
  for (const cloud of [null, {}]) refused(() => writeClouds([cloud]), "type", "clouds[0].points");
  refused(() => writeClouds(new Array(2)), "type", "clouds[0].points");
  for (const colours of [null, [9, 9, 9], new Float32Array([NaN, 300, -5])])
    refused(() => writeClouds([{ points: new Float32Array(3), colours }]), "size", "clouds[0].colours");
  assert.ok(
    !new TextDecoder("latin1")
      .decode(writeClouds([{ points: new Float32Array(3) }], "m\nend_header"))
      .includes("\nend_header;"),
  );
  refused(() => matrixText(), "type", "pose");
  refused(() => matrixText({ ...POSE, rotation: [...POSE.rotation, 1, 2, 3] }), "size", "pose.rotation");
  refused(() => matrixText({ ...POSE, translation: [1, 2, 3, 4, 5] }), "size", "pose.translation");
  refused(() => matrixText({ ...POSE, rotation: "123456789" }), "type", "pose.rotation");
  refused(() => matrixText({ ...POSE, scale: 1n }), "type", "pose.scale");
  refused(() => poseJson(POSE, "furlong"), "option", "unit");
  refused(() => lightCsv(), "type", "light");
  refused(() => lightCsv(LIGHT.map(() => NaN)), "range", "light");
  refused(() => lightCsv(Array.from(LIGHT, () => "=1+1")), "type", "light");
  refused(() => writeNpy(), "type", "raster");
  refused(() => writeNpy({ width: 0.5, height: 2, channels: 1, data: new Float32Array(1) }), "range", "raster.width");
  refused(() => writeNpy({ width: -1, height: -1, channels: 1, data: new Float32Array(1) }), "range", "raster.width");
  refused(() => writeNpy({ width: 1, height: 1, channels: 1, data: new Int8Array(1) }), "type", "raster.data");
  await rejected(
    writePng({ width: 1, height: 1, channels: 5, data: new Uint8Array(5) }),
    "unsupported",
    "raster.channels",
  );
  await rejected(writePng({ width: 1, height: 1, channels: 1, data: new Float32Array(1) }), "type", "raster.data");
  const dot = { width: 1, height: 1, channels: 1, data: new Uint8Array(1) };
  await rejected(writePng(dot, null), "type", "texts");
  await rejected(writePng(dot, { Unit: 5 }), "type", "texts.Unit");
  for (const name of ["", "k".repeat(80)]) await rejected(writePng(dot, { [name]: "v" }), "range", "texts");
  await rejected(depthPng({ width: 2, height: 2, data: new Float32Array(3) }, "m"), "size", "depth");
  await rejected(depthPng({ width: 1, height: 1, data: new Float32Array(1) }), "type", "unit");
  await rejected(normalsPng({ width: 2, height: 2, data: new Float32Array(4) }), "size", "normals");
});

test("doubles, such as a light's, are doubles in .npy", () => {
  const bytes = writeNpy({ width: 27, height: 1, channels: 1, data: Float64Array.from(LIGHT) });
  assert.match(new TextDecoder("latin1").decode(bytes.subarray(0, 80)), /'<f8'/);
  assert.deepEqual([...new Float64Array(bytes.slice(-27 * 8).buffer)], [...LIGHT]);
});

test("what the readers give is written, with alpha or without", async () => {
  for (const channels of [1, 2, 3, 4]) {
    for (const type of [Uint8Array, Uint8ClampedArray, Uint16Array]) {
      const data = type.from({ length: 6 * channels }, (_, i) => 37 * i + (type === Uint16Array ? 1000 * i : 0));
      const bytes = await writePng({ width: 3, height: 2, data });
      const back = decode(bytes);
      assert.deepEqual([back.width, back.height, back.channels], [3, 2, channels]);
      assert.deepEqual([...back.data], [...data]);
    }
  }
  const image = decodeColour(
    await writePng({ width: 1, height: 2, channels: 3, data: Uint8Array.of(1, 2, 3, 4, 5, 6) }),
  );
  assert.deepEqual(decodeColour(await writePng(image)), image);
  assert.deepEqual([...image.data], [1, 2, 3, 255, 4, 5, 6, 255]);
});

test("remarks of a PNG stay remarks, whatever they hold", async () => {
  const bytes = await writePng(
    { width: 1, height: 1, channels: 1, data: new Uint8Array([9]) },
    { "Na\0me": "\u202e\n\0é" },
  );
  assert.deepEqual([...decode(bytes).data], [9]);
  assert.deepEqual(Object.entries(decode(bytes).text), [["Na?me", "????"]]);
});

describe("the report of a run", () => {
  const PIXEL =
    "data:image/png;base64,iVBORw0KGgoAAAANSUhEUgAAAAEAAAABCAYAAAAfFcSJAAAADUlEQVR42mNkYPhfDwAChwGA60e6kgAAAABJRU5ErkJggg==";
  const EVIL = `</style></title><script>alert(1)</script><img src=x onerror=alert(2)>"'&amp;`;
  const run = (changes = {}) => ({
    ...{
      tone: "good",
      status: "converged, 0.12° off",
      words: ["The true pose was found."],
      pose: POSE,
      truth: POSE,
      unit: "m",
      light: LIGHT,
    },
    ...{
      numbers: [["Overlap", "81 %"]],
      options: [["Light", "estimate"]],
      pictures: [{ title: "Normals", dataUrl: PIXEL }],
    },
    ...{
      inputs: [{ name: "a.png", says: "128x96", sha256: "ab".repeat(32) }],
      made: new Date(Date.UTC(2026, 1, 28, 9, 5)),
      link: "https://example.org/#size=64",
    },
    ...changes,
  });

  test("holds verdict, pose beside the truth, light, options, files and pictures, and asks for nothing", () => {
    const page = runReportHtml(run());
    const { elements, text } = harmless(page);
    for (const words of [
      "converged, 0.12° off",
      "The true pose was found.",
      "81 %",
      "1.2500",
      "17.19°",
      "-0.02503",
      "Found",
      "True",
      "estimate",
      "a.png",
      "128x96",
      "ab".repeat(32),
      "2026-02-28 09:05 UTC",
      "https://example.org/#size=64",
      matrixText(POSE),
      lightCsv(LIGHT),
    ]) {
      assert.ok(text.includes(words), words);
    }
    assert.deepEqual(
      elements.filter(({ name }) => name === "img").map(({ attributes }) => attributes),
      [{ src: PIXEL, alt: "Normals" }],
    );
    assert.match(page, /default-src &#39;none&#39;; img-src data:/);
    assert.equal(runReportHtml(run()), page);
  });

  test("says nothing of a truth that is not known, and that z is free in a view without a camera", () => {
    assert.ok(!harmless(runReportHtml(run({ truth: null }))).text.includes("True"));
    assert.ok(harmless(runReportHtml(run({ unit: "px" }))).text.includes("free"));
  });

  test("names what is missing, and what is no date, word, pose or light", () => {
    const wrong = (changes, code, field) => refused(() => runReportHtml(run(changes)), code, field);
    for (const name of ["words", "numbers", "options", "pose", "light", "status", "tone", "unit"])
      wrong({ [name]: undefined }, "type", `report.${name}`);
    for (const made of [5, new Date(NaN)]) wrong({ made }, "type", "report.made");
    wrong({ tone: "__proto__" }, "option", "report.tone");
    wrong({ unit: "furlong" }, "option", "report.unit");
    wrong({ words: [{ toString: () => "<b>" }] }, "type", "report.words[0]");
    wrong({ numbers: [["Overlap"]] }, "type", "report.numbers[0][1]");
    wrong({ options: "ab" }, "type", "report.options");
    wrong({ light: LIGHT.map(() => NaN) }, "range", "report.light");
    wrong({ truth: { ...POSE, translation: [1, 2] } }, "size", "report.truth.translation");
    wrong({ pictures: [null] }, "type", "report.pictures[0]");
    wrong({ inputs: {} }, "type", "report.inputs");
    refused(() => runReportHtml(), "type", "report");
  });

  test("escapes whatever comes from elsewhere", () => {
    const evil = run({
      status: EVIL,
      words: [EVIL],
      numbers: [[EVIL, EVIL]],
      options: [[EVIL, EVIL]],
      pictures: [{ title: EVIL, dataUrl: PIXEL }],
      inputs: [{ name: EVIL, says: EVIL, sha256: EVIL }],
      title: EVIL,
      link: EVIL,
    });
    const page = runReportHtml(evil);
    harmless(page);
    assert.ok(!page.includes("<script"));
    refused(
      () => runReportHtml(run({ pictures: [{ title: "", dataUrl: "https://example.org/x.png" }] })),
      "type",
      "pictures[0].dataUrl",
    );
  });
});
