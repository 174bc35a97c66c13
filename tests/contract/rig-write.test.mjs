// Files of a rig: the same files that independent readers have read, and the readers' results.
import assert from "node:assert/strict";
import { existsSync, readFileSync } from "node:fs";
import { describe, test } from "node:test";
import { BimodalError as WriteError, poseFormats, writeClouds, writePose } from "../../pkg/rig-write.js";
import { readRigFile } from "../../pkg/rig.js";
import { CLOUDS, FOLDER, RIGS, files, formatsOf } from "../../scripts/reference/rig-written.mjs";
import { inRoot } from "../../scripts/shell.mjs";
import { BimodalError, refused } from "./support.mjs";

const read = JSON.parse(readFileSync(inRoot(FOLDER, "read.json"), "utf8"));
const found = (rig, format) => read[`${rig}/${writePose(RIGS[rig].pose, format, RIGS[rig].context).name}`];
const NO_POSE = {
  scale: 1,
  rotation: [1, 0, 0, 0, 1, 0, 0, 0, 1],
  translation: [0, 0, 0],
  angles: { alpha: 0, beta: 0, gamma: 0 },
};

test("both modules throw the same class", () => assert.equal(WriteError, BimodalError));

test("every file is written again, byte for byte", () => {
  const made = files();
  assert.deepEqual(Object.keys(made).sort(), Object.keys(read).sort());
  for (const [name, bytes] of Object.entries(made))
    assert.deepEqual(Buffer.from(bytes), readFileSync(inRoot(FOLDER, name)), name);
});

describe("what others read is what was written", () => {
  for (const [rig, { pose }] of Object.entries(RIGS)) {
    for (const format of formatsOf(rig)) {
      test(`${rig}: the pose from ${format}`, () => {
        const { rotation: r, translation: t } = pose;
        const expected = [0, 1, 2].map((i) => [...r.slice(3 * i, 3 * i + 3), t[i]]);
        // A quaternion preserves a rotation up to rounding; all other numbers are exact.
        const tolerance = format === "ros2" ? 1e-12 : 0;
        const { matrix } = found(rig, format);
        assert.deepEqual(matrix[3], [0, 0, 0, 1]);
        expected.forEach((row, i) =>
          row.forEach((value, j) =>
            assert.ok(Math.abs(matrix[i][j] - value) <= tolerance, `${i} ${j}: ${matrix[i][j]}, not ${value}`),
          ),
        );
      });
    }
  }

  /** Checks that a reader found the given camera; trailing zeros of a distortion are not significant. */
  function same(camera, given, size, { distortion = true } = {}) {
    const { fx, fy, cx, cy } = given;
    assert.deepEqual([camera.fx, camera.fy, camera.cx, camera.cy], [fx, fy, cx, cy]);
    assert.deepEqual(camera.size, size ?? null);
    if (!distortion) return;
    const length = Math.max(camera.distortion.length, given.distortion?.length ?? 0);
    const padded = (values) => Array.from({ length }, (_, k) => values?.[k] ?? 0);
    assert.deepEqual(padded(camera.distortion), padded(given.distortion));
  }

  /** Compares every camera of every rig with its reading in a format that holds `most` coefficients of Brown's distortion. */
  function each(format, most, model) {
    let count = 0;
    for (const [rig, { context }] of Object.entries(RIGS)) {
      for (const name of ["depth", "colour"].filter((name) => context[name])) {
        const given = context[name];
        const camera = found(rig, format)[name];
        if (given.model !== "fisheye" && given.distortion?.slice(most).some(Boolean)) {
          assert.equal(camera, undefined, `${rig} ${name}: without its distortion it would be another camera`);
          continue;
        }
        same(camera, given, context.sizes?.[name]);
        assert.equal(camera.model, model(given));
        count++;
      }
    }
    return count;
  }

  test("cameras from OpenCV's", () => {
    assert.equal(
      each(
        "opencv",
        8,
        ({ model, distortion }) => model ?? (distortion?.length === 8 ? "rational_polynomial" : "plumb_bob"),
      ),
      6,
    );
  });

  test("cameras from Kalibr's, whose radtan has four numbers", () => {
    assert.equal(
      each("kalibr", 4, ({ model }) => (model === "fisheye" ? "equidistant" : "radtan")),
      4,
    );
  });

  test("cameras from RealSense's, which has five", () => {
    const brown = ({ distortion }) => (distortion?.some(Boolean) ? "Brown Conrady" : "None");
    assert.equal(
      each("realsense", 5, (given) => (given.model === "fisheye" ? "Kannala Brandt4" : brown(given))),
      5,
    );
  });

  test("the colour camera from Open3D's, which has no distortion", () => {
    for (const [rig, { context }] of Object.entries(RIGS)) {
      if (context.colour)
        same(found(rig, "open3d").colour, context.colour, context.sizes?.colour ?? [0, 0], { distortion: false });
    }
  });

  test("ROS's parent is the colour camera", () => {
    const frames = ({ parent, child }) => [parent, child];
    assert.deepEqual(frames(found("usual", "ros2")), ["camera_color_optical_frame", "camera_depth_optical_frame"]);
    assert.deepEqual(frames(found("turned", "ros2")), ["rig/colour", "tof_optical_frame"]);
  });

  test("a pose from axes with x forward belongs to a LiDAR's frame, unless a name is given", () => {
    const ahead = { ...NO_POSE, rotation: [0, -1, 0, 0, 0, -1, 1, 0, 0] };
    assert.match(writePose(ahead, "ros2").text, /--child-frame-id lidar\n/);
    assert.match(writePose(ahead, "ros2", { frames: { depth: "velodyne" } }).text, /--child-frame-id velodyne\n/);
    assert.match(writePose(NO_POSE, "ros2").text, /--child-frame-id camera_depth_optical_frame\n/);
  });

  test("an estimate is called so in name and content, and reads back", async () => {
    const pose = { ...NO_POSE, translation: [0.125, 0, 0.5] };
    const camera = { fx: 5, fy: 5, cx: 3, cy: 2 };
    const context = { colour: camera, depth: camera, sizes: { colour: [8, 4], depth: [8, 4] } };
    for (const format of poseFormats) {
      const plain = writePose(pose, format, context);
      const { name, text } = writePose(pose, format, { ...context, isEstimate: true });
      assert.equal(name.replace(".estimate", ""), plain.name);
      assert.notEqual(name, plain.name);
      assert.ok(/no check has confirmed/.test(text) && !/no check has confirmed/.test(plain.text), format);
      if (format === "ros2") continue;
      const again = await readRigFile({ name, bytes: new TextEncoder().encode(text) });
      assert.deepEqual([...again.poses[0].pose.translation], pose.translation, format);
    }
  });

  test("clouds, without what is missing", () => {
    const there = [0, 1, 2, 6, 7, 8];
    const [first, second] = CLOUDS;
    const rows = (values) => Array.from({ length: values.length / 3 }, (_, k) => [...values.slice(3 * k, 3 * k + 3)]);
    const points = rows(there.map((k) => first.points[k]));
    const colours = rows(there.map((k) => first.colours[k]));
    assert.deepEqual(read["cloud.ply"], { points, colours, label: null });
    assert.deepEqual(read["clouds.ply"], {
      points: [...points, ...rows(second.points)],
      colours: [...colours, [128, 128, 128]],
      label: [0, 0, 1],
    });
  });
});

/** The package's own readers, if the build includes them. */
const readers = existsSync(inRoot("pkg/rig.js")) ? await import("../../pkg/rig.js") : undefined;
const skip = readers ? false : "this build has no readers";

describe("the package reads what it writes", () => {
  for (const [rig, { pose, context }] of Object.entries(RIGS)) {
    for (const format of formatsOf(rig)) {
      test(`${rig}: ${format}`, { skip }, async () => {
        const { name, text } = writePose(pose, format, context);
        const {
          poses,
          cameras = [],
          warnings,
        } = await readers.readRigFile({ name, bytes: new TextEncoder().encode(text) });
        assert.deepEqual(warnings, []);
        assert.equal(poses.length, 1);
        const off = (key) => Math.max(...poses[0].pose[key].map((value, k) => Math.abs(value - pose[key][k])));
        assert.ok(off("rotation") < 1e-12 && off("translation") < 1e-12);
        const numbers = ({ fx, fy, cx, cy, model = "brown" }) => [fx, fy, cx, cy, model];
        const given = new Set([context.depth, context.colour].filter(Boolean).map((camera) => numbers(camera).join()));
        for (const { camera } of cameras)
          assert.ok(format === "open3d" || given.has(numbers(camera).join()), JSON.stringify(camera));
      });
    }
  }
});

describe("what a format has no place for is said", () => {
  const notes = (format, rig) => writePose(RIGS[rig].pose, format, RIGS[rig].context).notes.join("; ");

  test("in notes", () => {
    assert.match(notes("kalibr", "usual"), /colour camera's intrinsics are left out: .*radtan/);
    assert.match(notes("open3d", "usual"), /distortion is left out/);
    assert.match(notes("realsense", "turned"), /colour camera's intrinsics are left out/);
    assert.match(notes("kalibr", "radial"), /depth camera's resolution is not known; the colour camera's resolution/);
    assert.match(notes("realsense", "bare"), /intrinsics are not known/);
    for (const format of poseFormats)
      if (!["kalibr", "open3d"].includes(format)) assert.equal(notes(format, "usual"), "", format);
  });

  test("and in comments, where the format has them", () => {
    const { text, notes } = writePose(RIGS.usual.pose, "kalibr", RIGS.usual.context);
    for (const note of notes) assert.ok(text.includes(`# ${note}`), note);
  });
});

test("any number keeps its digits", () => {
  for (const value of [0.1 + 0.2, -5e-324, 1.7976931348623157e308, 123456789012345680000, 1e21, 1e-7, -0]) {
    const { text } = writePose({ ...NO_POSE, translation: [value, 0, 0] }, "matrix");
    const written = text.split(/\s+/)[3];
    assert.equal(Number(written), value === 0 ? 0 : value);
    assert.match(written, /^-?\d+\.\d+(e[+-]\d+)?$/, "what YAML 1.1 takes for a number");
  }
});

test("quaternions of every quadrant", () => {
  // These rotations make each of the four components the largest once.
  for (const [x, y, z, w] of [
    [1, 0, 0, 0],
    [0, 1, 0, 0],
    [0, 0, 1, 0],
    [0.1, 0.2, 0.3, 0.9],
    [0.9, 0.3, -0.2, 0.1],
    [-0.2, 0.9, 0.1, -0.3],
    [0.1, -0.2, 0.9, -0.3],
  ]) {
    const n = Math.hypot(x, y, z, w);
    const s = 2 / n ** 2;
    const rotation = [
      ...[1 - s * (y * y + z * z), s * (x * y - w * z), s * (x * z + w * y)],
      ...[s * (x * y + w * z), 1 - s * (x * x + z * z), s * (y * z - w * x)],
      ...[s * (x * z - w * y), s * (y * z + w * x), 1 - s * (x * x + y * y)],
    ];
    const { text } = writePose({ ...NO_POSE, rotation }, "ros2");
    const written = ["x", "y", "z", "w"].map((part) => Number(new RegExp(`--q${part} (\\S+)`).exec(text)[1]));
    const sign = w < 0 ? -1 : 1;
    [x, y, z, w].forEach((value, k) =>
      assert.ok(Math.abs(written[k] - (sign * value) / n) < 1e-15, `${[x, y, z, w]}: ${written}`),
    );
  }
});

describe("refused", () => {
  const write =
    (pose, format = "matrix", context = {}) =>
    () =>
      writePose({ ...NO_POSE, ...pose }, format, context);

  test("poses that are no rig's", () => {
    refused(write({ scale: 1.2 }), "range", "pose.scale");
    refused(write({ translation: [0, NaN, 0] }), "range", "pose.translation");
    refused(write({ translation: [0, 0] }), "size", "pose.translation");
    refused(write({ rotation: [1, 0, 0, 0, 1, 0, 0, 0, -1] }), "range", "pose.rotation");
    refused(write({ rotation: [1, 0.001, 0, 0, 1, 0, 0, 0, 1] }), "range", "pose.rotation");
  });

  test("what is no pose, no numbers and no context", () => {
    for (const pose of [undefined, null, "pose"]) refused(() => writePose(pose, "matrix"), "type", "pose");
    refused(() => writePose({}, "matrix"), "range", "pose.scale");
    for (const translation of [undefined, 5]) refused(write({ translation }), "size", "pose.translation");
    for (const translation of [new Array(3), ["1", "2", "3"]])
      refused(write({ translation }), "range", "pose.translation");
    for (const format of [undefined, Symbol("matrix")]) refused(() => writePose(NO_POSE, format), "option", "format");
    for (const context of [null, 5]) refused(write({}, "matrix", context), "type", "context");
    refused(write({}, "matrix", { colour: null }), "type", "context.colour");
    for (const colour of [5, null, [640]])
      refused(write({}, "matrix", { sizes: { colour } }), "size", "context.sizes.colour");
    let times = 0;
    const name = { toString: () => (times++ > 0 ? "a; rm -rf ." : "a") };
    refused(write({}, "ros2", { frames: { colour: name } }), "range", "context.frames.colour");
  });

  test("words, cameras, sizes and names that nobody could read", () => {
    const camera = { fx: 500, fy: 500, cx: 320, cy: 240 };
    refused(write({}, "urdf"), "option", "format");
    refused(write({}, "constructor"), "option", "format");
    refused(write({}, "opencv", { colour: { ...camera, fx: 0 } }), "range", "context.colour");
    refused(write({}, "opencv", { colour: { ...camera, cx: Infinity } }), "range", "context.colour");
    refused(write({}, "opencv", { depth: { ...camera, distortion: [1, 2, 3] } }), "size", "context.depth.distortion");
    refused(
      write({}, "opencv", { depth: { ...camera, model: "fisheye", distortion: [1, 2, 3, 4, 5] } }),
      "size",
      "context.depth.distortion",
    );
    refused(write({}, "opencv", { depth: { ...camera, model: "omni" } }), "option", "context.depth.model");
    refused(write({}, "open3d", { depth: camera }), "missing", "context.colour");
    refused(write({}, "kalibr", { depth: camera, sizes: { depth: [640, 0.5] } }), "size", "context.sizes.depth");
    for (const name of ["a; rm -rf .", "$(x)", "", "/slash", "new\nline", "--frame-id"]) {
      refused(write({}, "ros2", { frames: { colour: name } }), "range", "context.frames.colour");
    }
    refused(write({}, "ros2", { frames: { colour: "camera_depth_optical_frame" } }), "range", "context.frames");
  });

  test("clouds of the wrong length", () => {
    refused(() => writeClouds([]), "size", "clouds");
    refused(() => writeClouds([{ points: new Float32Array(4) }]), "size", "clouds[0].points");
    refused(() => writeClouds([{ points: [1, 2, 3] }]), "type", "clouds[0].points");
    for (const clouds of [[null], new Array(1)]) refused(() => writeClouds(clouds), "type", "clouds[0].points");
    refused(
      () => writeClouds([{ points: new Float32Array(3) }, { points: new Float32Array(3), colours: new Uint8Array(4) }]),
      "size",
      "clouds[1].colours",
    );
  });
});

test("a cloud's name cannot end its line, nor can its unit", () => {
  const points = new Float32Array(3);
  for (const name of [5, Symbol("s")])
    assert.match(Buffer.from(writeClouds([{ points, name }])).toString("latin1"), /^comment (5|Symbol\(s\))$/m);
  assert.match(Buffer.from(writeClouds([{ points }], "m\nend_header")).toString("latin1"), /^comment m\?end_header; /m);
  const text = Buffer.from(writeClouds([{ points, name: "a\nend_header\nµ" }])).toString("latin1");
  assert.match(text, /^comment a\?end_header\?\?$/m);
  assert.equal(text.match(/^end_header$/gm).length, 1);
});
