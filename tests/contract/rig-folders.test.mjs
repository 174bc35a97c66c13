// Whole folders of a rig: which files form a frame, which camera took it, and messages about the other files.
import assert from "node:assert/strict";
import { existsSync, readFileSync, readdirSync } from "node:fs";
import { describe, test } from "node:test";
import { fileURLToPath } from "node:url";
import { readRigFile, readRigFolder } from "../../pkg/rig.js";
import { png } from "./support.mjs";
import { close, text } from "./rig-support.mjs";

const words = (...values) => values.flatMap((value) => [value >> 8, value & 255]);
const depth = (value) => png({ width: 2, height: 1, depth: 16, colourType: 0, rows: [words(value, value + 1)] });
const colour = (value, width = 2) =>
  png({ width, height: 1, depth: 8, colourType: 2, rows: [Array(width).fill([value, 2, 3]).flat()] });
const mask = () => png({ width: 2, height: 1, depth: 8, colourType: 0, rows: [[0, 255]] });
const K = (focal) => text(`${focal} 0 1\n0 ${focal} 0.5\n0 0 1\n`);
const folder = (files, options) =>
  readRigFolder(
    Object.entries(files).map(([name, bytes]) => ({ name, bytes })),
    options,
  );
/** The first value of each frame's colour image and depth map, which identifies their files. */
const marks = ({ frames }) => frames.map(({ image, depth }) => [image.data[0], depth.data[0]]);
const has = (warnings, code, pattern = /./) =>
  assert.ok(
    warnings.some((warning) => warning.code === code && pattern.test(warning.message)),
    JSON.stringify(warnings),
  );

describe("TUM RGB-D", () => {
  const files = {
    "fr1/rgb.txt": text(
      "# color images\n1.000 rgb/1.000.png\n1.035 rgb/1.035.png\n1.070 rgb/1.070.png\n2.000 rgb/2.000.png\n",
    ),
    "fr1/depth.txt": text(
      "# depth maps\n1.010 depth/1.010.png\n1.033 depth/1.033.png\n1.100 depth/1.100.png\n2.001 depth/2.001.png\n",
    ),
    "fr1/groundtruth.txt": text("1.0 0 0 0 0 0 0 1\n"),
    "fr1/accelerometer.txt": text("1.0 2 3 4\n"),
    ...Object.fromEntries(
      [
        ["1.000", 1],
        ["1.035", 2],
        ["1.070", 3],
        ["2.000", 4],
      ].map(([time, value]) => [`fr1/rgb/${time}.png`, colour(value)]),
    ),
    ...Object.fromEntries(
      [
        ["1.010", 5000],
        ["1.033", 6000],
        ["1.100", 7000],
      ].map(([time, value]) => [`fr1/depth/${time}.png`, depth(value)]),
    ),
  };

  test("pairs within 20 ms, in 5000 units to the metre; what is missing is said", async () => {
    const found = await folder(files);
    assert.deepEqual(marks(found), [
      [1, 5000],
      [2, 6000],
    ]);
    assert.deepEqual(
      found.frames.map(({ name, depth }) => [name, depth.unit]),
      [
        ["1", 0.0002],
        ["1.035", 0.0002],
      ],
    );
    assert.equal(found.poses.length, 0, "where the camera stood relates no two cameras");
    has(found.warnings, "pairs-missing", /1 of the 3 pairs that rgb.txt and depth.txt list are not in the folder/);
    assert.ok(!found.warnings.some(({ code }) => code === "unit-guessed"));
  });

  test("lists that fit nothing", async () => {
    await assert.rejects(folder({ ...files, "fr1/depth.txt": text("9.0 depth/9.png\n") }), {
      code: "file",
      message: /fr1\/rgb.txt: none of its time stamps/,
    });
    await assert.rejects(folder({ ...files, "fr1/depth.txt": text("nine depth/9.png\n") }), {
      code: "file",
      message: /fr1\/depth.txt: it lists time stamps/,
    });
  });
});

describe("pairs by similar names", () => {
  test("in the order of their numbers, however the folder was handed over", async () => {
    const files = Object.fromEntries(
      [10, 9, 100].flatMap((number) => [
        [`depth/${number}.png`, depth(1000 + number)],
        [`color/${number}.png`, colour(number)],
      ]),
    );
    assert.deepEqual(marks(await folder(files)), [
      [9, 1009],
      [10, 1010],
      [100, 1100],
    ]);
  });

  const schemes = {
    Redwood: ["color/00001.png", "depth/1.png"],
    Open3D: ["dataset/color/000012.png", "dataset/depth/000012.png"],
    "7-Scenes": ["frame-000150.color.png", "frame-000150.depth.png"],
    "RGB-D Object": ["cap_1_1_1_crop.png", "cap_1_1_1_depthcrop.png"],
    "one of each": ["IMG_2041.png", "depth map.png"],
    "nothing in a name": ["a.png", "b.png"],
    "Windows' slashes": ["color\\1.png", "depth\\1.png"],
  };
  for (const [name, [first, second]] of Object.entries(schemes)) {
    test(name, async () => {
      assert.deepEqual(
        marks(
          await folder({
            [second]: depth(1000),
            [first]: colour(7),
            "README.md": text("# nothing"),
            ".DS_Store": text("\0\0"),
          }),
        ),
        [[7, 1000]],
      );
    });
  }

  test("several frames, one without a partner, a mask for one and one for all", async () => {
    const files = {
      "color_1.png": colour(1),
      "color_2.png": colour(2),
      "color_9.png": colour(9),
      "depth_1.png": depth(1000),
      "depth_2.png": depth(2000),
      "mask_2.png": mask(),
    };
    const found = await folder(files);
    assert.deepEqual(marks(found), [
      [1, 1000],
      [2, 2000],
    ]);
    assert.deepEqual(
      found.frames.map(({ image }) => image.mask && [...image.mask]),
      [undefined, [0, 255]],
    );
    const shared = await folder({ ...files, "mask.png": mask(), "mask_2.png": text("") });
    assert.deepEqual(
      shared.frames.map(({ image }) => image.mask && [...image.mask]),
      [
        [0, 255],
        [0, 255],
      ],
    );
  });

  test("names that are alike nowhere are paired in order, which is said", async () => {
    const found = await folder({
      "rgb/a10.png": colour(2),
      "rgb/a9.png": colour(1),
      "depth/x1.png": depth(1000),
      "depth/x2.png": depth(2000),
    });
    assert.deepEqual(marks(found), [
      [1, 1000],
      [2, 2000],
    ]);
    has(found.warnings, "pairs-by-order");
  });

  test("names of any script, and names that differ in case and signs alone", async () => {
    const names = ["\u00e4", "\u00f6", "\u00e9", "\u82b1\u74f6", "\u{1f600}", "\u{1f601}", "a", "A", "a!", "a "];
    const files = Object.fromEntries(
      names.flatMap((name, at) => [
        [`${name}_rgb.png`, colour(at)],
        [`${name.normalize("NFD")}_depth.png`, depth(1000 + at)],
      ]),
    );
    const found = await folder(files);
    assert.deepEqual(marks(found).sort(), names.map((_, at) => [at, 1000 + at]).sort());
    assert.ok(!found.warnings.some(({ code }) => code === "names-ambiguous"), JSON.stringify(found.warnings));
  });

  test("frames of several scenes, whose names are the same", async () => {
    const files = Object.fromEntries(
      ["one", "two"].flatMap((scene, at) => [
        [`${scene}/color/1.png`, colour(at)],
        [`${scene}/depth/1.png`, depth(1000 + at)],
      ]),
    );
    assert.deepEqual(marks(await folder(files)), [
      [0, 1000],
      [1, 1001],
    ]);
  });

  test("what may belong to several is left out, and said", async () => {
    const found = await folder({
      "a_rgb.png": colour(1),
      "A-rgb.png": colour(2),
      "a.depth.png": depth(1000),
      "b_rgb.png": colour(3),
      "b_depth.png": depth(3000),
    });
    assert.deepEqual(marks(found), [[3, 3000]]);
    has(found.warnings, "names-ambiguous", /^a.depth.png: several files have names like this one/);
  });

  test("a picture without another of its name is left out, and said", async () => {
    const found = await folder({
      "rgb_1.png": colour(1),
      "depth_1.png": depth(1000),
      "rgb_2.png": colour(2),
      "depth_3.png": depth(3000),
    });
    assert.deepEqual(marks(found), [[1, 1000]]);
    const alone = found.warnings.filter(({ code }) => code === "file-alone");
    assert.deepEqual(
      alone.map(({ isDoubt, files, message }) => [isDoubt, files, message]),
      [
        [
          false,
          2,
          "depth_3.png: its name matches no other file or more than one; it was left out. (and 1 more like it)",
        ],
      ],
    );
  });

  test("a large folder is read in part, evenly", async () => {
    const files = Object.fromEntries(
      Array.from({ length: 41 }, (_, at) => [
        [`color/${at}.png`, colour(at)],
        [`depth/${at}.png`, depth(1000 + at)],
      ]).flat(),
    );
    assert.deepEqual(marks(await folder(files, { frames: 3 })), [
      [0, 1000],
      [20, 1020],
      [40, 1040],
    ]);
    const found = await folder(files);
    assert.equal(found.frames.length, 20);
    has(found.warnings, "pairs-sampled", /20 of 41 pairs are read/);
    await assert.rejects(folder(files, { frames: 0 }), { code: "option" });
  });

  test("a file that cannot be read costs its frame only; what is said of many is said once", async () => {
    const found = await folder({
      "color/1.png": colour(1),
      "color/2.png": colour(2),
      "color/3.png": colour(3),
      "depth/1.png": depth(1000).slice(0, 60),
      "depth/2.png": depth(2000),
      "depth/3.png": depth(3000),
    });
    assert.deepEqual(marks(found), [
      [2, 2000],
      [3, 3000],
    ]);
    has(found.warnings, "file-left-out", /^depth\/1.png: this PNG is cut off.*left out/);
    assert.equal(found.warnings.filter(({ code }) => code === "unit-guessed").length, 1);
    has(found.warnings, "unit-guessed", /and 1 more like it/);
    assert.equal(found.warnings.find(({ code }) => code === "unit-guessed").files, 2);
  });

  test("nothing of use is an error", async () => {
    await assert.rejects(folder({ "a.txt": text("hello") }), { code: "file", message: /no pair/ });
    await assert.rejects(folder({}), { code: "file" });
  });
});

describe("cameras are given to the pictures they took", () => {
  const pair = { "color.png": colour(1), "depth.png": depth(1000) };
  const focals = async (files) => {
    const { frames, warnings } = await folder(files);
    return [
      frames[0].image.camera?.fx,
      frames[0].depth.camera?.fx,
      warnings.filter(({ code }) => code !== "unit-guessed" && code !== "units-differ"),
    ];
  };

  test("by the names of files and of cameras", async () => {
    assert.deepEqual(await focals({ ...pair, "K_rgb.txt": K(500), "K_depth.txt": K(400) }), [500, 400, []]);
    const json = text(
      JSON.stringify({ ir: { fx: 400, fy: 400, cx: 1, cy: 1 }, colour: { fx: 500, fy: 500, cx: 1, cy: 1 } }),
    );
    assert.deepEqual(await focals({ ...pair, "calib.json": json }), [500, 400, []]);
  });

  test("by the size of the images", async () => {
    const json = text(
      JSON.stringify([
        { fx: 400, fy: 400, cx: 1, cy: 0.5, width: 2, height: 1 },
        { fx: 500, fy: 500, cx: 2, cy: 0.5, width: 4, height: 1 },
      ]),
    );
    const [image, map] = await focals({ "color.png": colour(1, 4), "depth.png": depth(1000), "calib.json": json });
    assert.deepEqual([image, map], [500, 400]);
  });

  test("one for both, one without the other, neither named, sizes that do not fit: each with a word", async () => {
    const shared = await focals({ ...pair, "K.txt": K(500) });
    assert.deepEqual(shared.slice(0, 2), [500, 500]);
    has(shared[2], "camera-shared");
    const colourOnly = await focals({ ...pair, "rgb_K.txt": K(500) });
    assert.deepEqual(colourOnly.slice(0, 2), [500, undefined]);
    has(colourOnly[2], "depth-camera-missing");
    const depthOnly = await focals({ ...pair, "depth_K.txt": K(500) });
    assert.deepEqual(depthOnly.slice(0, 2), [undefined, 500]);
    has(depthOnly[2], "colour-camera-missing");
    const unnamed = await focals({ ...pair, "1.txt": K(500), "2.txt": K(400) });
    assert.deepEqual(unnamed.slice(0, 2), [500, 400]);
    has(unnamed[2], "cameras-by-order");
    const wrong = await focals({
      ...pair,
      "rgb.json": text('{"fx": 500, "fy": 500, "cx": 1, "cy": 1, "width": 64, "height": 48}'),
      "depth_K.txt": K(400),
    });
    has(wrong[2], "camera-size", /are for 64x48 pixels, but these pictures have 2x1/);
    // If the size is not stated, the principal point reveals it.
    const outside = await focals({ ...pair, "rgb.json": text('{"fx": 500, "fy": 500, "cx": 320, "cy": 240}') });
    has(outside[2], "principal-point", /outside the picture \(320, 240 of 2x1\)/);
  });

  test("poses between cameras are kept, poses of frames are not", async () => {
    const pose = text("1 0 0 0.1\n0 1 0 0\n0 0 1 0\n0 0 0 1\n");
    const { poses } = await folder({
      "frame-1.color.png": colour(1),
      "frame-1.depth.png": depth(1000),
      "frame-1.pose.txt": pose,
      "extrinsics.txt": pose,
    });
    assert.equal(poses.length, 1);
    assert.deepEqual(poses[0].pose.translation, [0.1, 0, 0]);
  });
});

describe("other people's folders", {
  skip: existsSync(new URL("../../../shared/data", import.meta.url)) ? false : "needs ../shared/data",
}, () => {
  const shared = (name) => {
    const path = fileURLToPath(new URL(`../../../shared/data/${name}/`, import.meta.url));
    return readRigFolder(
      readdirSync(path).map((file) => ({ name: file, bytes: new Uint8Array(readFileSync(path + file)) })),
    );
  };

  test("nyu_raw_pair: one frame, both cameras, the extrinsics", async () => {
    const { frames, poses } = await shared("nyu_raw_pair");
    assert.equal(frames.length, 1);
    close(
      [frames[0].image.camera.fx, frames[0].depth.camera.fx, frames[0].depth.unit],
      [518.858, 582.624, 0.001],
      1e-3,
    );
    close(poses[0].pose.translation, [-0.02503, -0.00066, 0.00029], 1e-5);
  });

  test("seven_scenes, mitten, rgbd_object, android: frames, units, masks", async () => {
    const found = {};
    for (const name of ["seven_scenes", "mitten_rgbd", "rgbd_object", "android_rgbd"]) {
      const { frames, poses } = await shared(name);
      found[name] = [
        frames.length,
        poses.length,
        frames[0].depth.unit,
        frames[0].image.mask !== undefined,
        frames[0].image.camera?.fx,
      ];
    }
    assert.deepEqual(found, {
      seven_scenes: [3, 0, 0.001, false, 585],
      mitten_rgbd: [3, 0, 0.0002, true, 1216.73],
      rgbd_object: [8, 0, 0.001, true, undefined],
      android_rgbd: [1, 0, 0.0002, true, 1216.7],
    });
  });
});

test("a signal ends the reading between two files", async () => {
  const bytes = new Uint8Array(readFileSync(new URL("../fixtures/rig/colour-srgb.png", import.meta.url)));
  const files = Array.from({ length: 8 }, (_, i) => ({ name: `${i % 2 ? "rgb" : "depth"}/${i >> 1}.png`, bytes }));
  const reason = new Error("enough");
  const control = new AbortController();
  const reading = readRigFolder(files, { signal: control.signal });
  setImmediate(() => control.abort(reason));
  await assert.rejects(reading, (error) => error === reason);
  const aborted = { signal: AbortSignal.abort(reason) };
  await assert.rejects(readRigFolder(files, aborted), (error) => error === reason);
  await assert.rejects(readRigFile(files[0], aborted), (error) => error === reason);
  await assert.rejects(readRigFolder(files, { signal: 5 }), { code: "type", field: "options.signal" });
});
