// Recordings of a rig: the chosen topics, frames with cameras and transforms, warnings and errors.
import assert from "node:assert/strict";
import { readFileSync } from "node:fs";
import { test } from "node:test";
import { fileURLToPath } from "node:url";
import { isRecording, openRecording } from "../../pkg/rig-recordings.js";
import * as rig from "../../pkg/rig.js";
import { POSE, K, CAMERA, START, frame, frames, recorded, opened, written, codes, image } from "./recorded.mjs";
import {
  FRAMES,
  depthMessage,
  driver,
  headerOf,
  imageMessage,
  infoMessage,
  lz4Frame,
  matroska,
  mcap,
  transform,
  zstdFrame,
} from "./recordings.mjs";
import { H, W, close, refusedFile, rotation, translation } from "./rig-support.mjs";

async function isWhole(recording, count = 3) {
  const { frames: found, cameras, poses, warnings } = await recording.read();
  assert.deepEqual(
    found.map(({ name }) => name),
    ["0.10 s", "0.60 s", "1.10 s"].slice(0, count),
  );
  for (const [index, { image, depth }] of found.entries()) {
    const { width, height } = image;
    assert.deepEqual([width, height, depth.width, depth.height], [W, H, W, H]);
    assert.deepEqual([...depth.data], [...frame(index).depth.data]);
    assert.equal(depth.unit, 0.001);
    assert.deepEqual(depth.camera, K);
    assert.deepEqual(image.camera, CAMERA);
  }
  assert.deepEqual(
    cameras.map(({ name }) => name),
    ["colour", "depth"],
  );
  const [{ pose, from, to }] = poses;
  assert.deepEqual([from, to], [FRAMES.depth, FRAMES.colour]);
  close(pose.rotation, rotation, 1e-6);
  close(pose.translation, translation, 1e-9);
  assert.deepEqual(
    warnings.filter(({ isDoubt }) => isDoubt),
    [],
  );
  return found;
}

const CHUNKS = {
  "not compressed": {},
  "by LZ4": { compressChunk: (data) => ({ compression: "lz4", compressedData: lz4Frame(data) }) },
  "by Zstandard": { compressChunk: (data) => ({ compression: "zstd", compressedData: zstdFrame(data) }) },
  "not in chunks": { chunks: false },
  "broken off": { cut: 60 },
  "of ROS 1": { generation: "ros1" },
};
for (const [words, options] of Object.entries(CHUNKS))
  test(`an MCAP ${words} gives frames, cameras and the transform between them`, async () => {
    const found = await isWhole(await written(recorded(), options));
    assert.deepEqual([...found[1].image.data], [...frame(1).image.data]);
  });

test("topics are listed with type, size and rate, and those of the two cameras are chosen", async () => {
  const { topics, chosen, says, seconds } = await written(recorded());
  assert.deepEqual(chosen, { colour: "/camera/color/image_raw", depth: "/camera/depth/image_raw" });
  const named = new Map(topics.map((topic) => [topic.name, topic]));
  const depth = named.get("/camera/depth/image_raw");
  assert.deepEqual(
    { ...depth, rate: Math.round(10 * depth.rate) / 10 },
    {
      name: "/camera/depth/image_raw",
      type: "sensor_msgs/msg/Image",
      kind: "picture",
      messages: 3,
      rate: 1.8,
      stored: `${W}x${H} 16UC1`,
      bytes: 2 * W * H,
      role: "depth",
    },
  );
  assert.equal(named.get("/chatter").kind, "other");
  assert.equal(says, "MCAP, 1.1 s, 6 topics");
  assert.ok(Math.abs(seconds - 1.104) < 1e-3);
});

test("a blob is read in parts, as a browser's file is", async () => {
  const bytes = await mcap(recorded());
  await isWhole(await openRecording({ name: "a.mcap", content: new Blob([bytes]) }));
});

test("compressed pictures and depth are taken", async () => {
  const found = await isWhole(await written(recorded({ compress: true })));
  close([...found[0].image.data.slice(0, 4)], [...frame().image.data.slice(0, 4)], 40);
});

test("transforms of /tf are taken where tf_static has none, and one that moves, however slowly, has a warning", async () => {
  const base = recorded({}, 1).filter(({ topic }) => topic !== "/tf_static");
  const still = (time, shift = 0) => ({
    topic: "/tf",
    type: "tf2_msgs/TFMessage",
    time,
    message: {
      transforms: [
        transform(
          FRAMES.colour,
          FRAMES.depth,
          { rotation, translation: [translation[0] + shift, ...translation.slice(1)] },
          time,
        ),
      ],
    },
  });
  const fixed = await (await written([...base, still(START + 0.2), still(START + 0.3)])).read();
  close(fixed.poses[0].pose.translation, translation, 1e-9);
  assert.ok(!codes(fixed).includes("transform-moves"));
  const moving = await (await written([...base, still(START + 0.2), still(START + 0.3, 0.01)])).read();
  assert.ok(codes(moving).includes("transform-moves"));
  const slow = Array.from({ length: 30 }, (_, at) => still(START + 0.2 + 0.01 * at, 0.0003 * at));
  assert.ok(codes(await (await written([...base, ...slow])).read()).includes("transform-moves"));
  const none = await (await written(base)).read();
  assert.deepEqual(none.poses, []);
  assert.ok(codes(none).includes("transform-missing"));
});

test("frames of different moments, of two clocks and of one view have warnings", async () => {
  assert.ok(codes(await (await written(recorded({ late: 0.09 }))).read()).includes("times-apart"));
  const twoClocks = recorded().map((each) =>
    each.topic === "/camera/depth/image_raw"
      ? { ...each, message: { ...each.message, header: headerOf(17, FRAMES.depth) } }
      : each,
  );
  const found = await (await written(twoClocks)).read();
  assert.ok(codes(found).includes("clocks-differ"));
  assert.equal(found.frames.length, 3);
  const alike = await (await written(driver([frame(), frame(), frame(1), frame(1)], POSE))).read();
  assert.equal(alike.frames.length, 2);
  assert.ok(codes(alike).includes("frames-alike"));
});

test("ten frames are taken from many moments, or as many as an option says", async () => {
  const recording = await written(recorded({ every: 0.1 }, 60));
  assert.equal((await recording.read()).frames.length, 10);
  assert.equal((await recording.read({ frames: 4 })).frames.length, 4);
});

test("the best of several topics is chosen, and an option takes another", async () => {
  const time = START + 0.1;
  const { image: colour, depth } = frame();
  const more = [
    image("/camera/infra1/image_raw", { ...depthMessage(depth, time, FRAMES.depth), encoding: "mono16" }),
    image("/camera/aligned_depth_to_color/image_raw", depthMessage(depth, time, FRAMES.colour)),
    image("/camera/left/image_mono", imageMessage(colour, time, FRAMES.colour)),
  ];
  const recording = await written([...recorded({}, 1), ...more]);
  assert.deepEqual(recording.chosen, { colour: "/camera/color/image_raw", depth: "/camera/depth/image_raw" });
  const roles = new Map(recording.topics.map(({ name, role }) => [name, role]));
  assert.equal(roles.get("/camera/infra1/image_raw"), undefined);
  const {
    poses,
    frames: [first],
  } = await recording.read({ depth: "/camera/aligned_depth_to_color/image_raw" });
  // The depth map is registered to the colour image, so both share one frame.
  close(poses[0].pose.translation, [0, 0, 0], 1e-12);
  assert.equal(first.depth.camera.fx, K.fx);
});

test("an unreadable recording is refused with its name, the reason and a remedy", async () => {
  const protobuf = recorded({}, 1).map((each) => ({ ...each, encoding: "protobuf", schemaEncoding: "protobuf" }));
  await refusedFile((await written(protobuf)).read(), "a.mcap", /protobuf.+ROS 1 and ROS 2/);
  const h264 = recorded({ compress: true }, 1).map((each) =>
    each.topic.endsWith("/compressed") ? { ...each, message: { ...each.message, format: "h264" } } : each,
  );
  await refusedFile((await written(h264)).read(), "a.mcap", /"h264", which is not supported/);
  await refusedFile(
    opened(new Uint8Array([...Buffer.from("\x89MCAP0\r\n", "latin1"), ...new Uint8Array(300)])),
    "a.mcap",
    /damaged|index|cut off/,
  );
  await refusedFile(opened(new TextEncoder().encode("#ROSBAG V2.0\n no more"), "a.bag"), "a.bag", /rosbag reindex/);
  await refusedFile(opened(new Uint8Array(100), "a.txt"), "a.txt", /not a supported recording/);
  await assert.rejects((await written(recorded())).read({ topics: [] }), { code: "option" });
  const controller = new AbortController();
  controller.abort();
  await assert.rejects((await written(recorded())).read({ signal: controller.signal }), { name: "AbortError" });
});

test("recordings are told by their first bytes, and readers of single files refer to the readers of recordings", async () => {
  const bytes = await mcap(recorded({}, 1));
  assert.ok(isRecording(bytes) && rig.isRecording(bytes));
  assert.ok(!isRecording(new TextEncoder().encode("fx: 500")));
  await refusedFile(rig.readRigFile({ name: "a.mcap", bytes }), "a.mcap", /recording of ROS.+rig-recordings/);
});

const fixture = (name) =>
  new Uint8Array(readFileSync(fileURLToPath(new URL(`../fixtures/recordings/${name}`, import.meta.url))));

test("bags written by rosbags are read, compressed by LZ4, by bzip2 and uncompressed", async () => {
  const walk = await opened(fixture("walk-lz4.bag"), "walk.bag");
  assert.equal(walk.format, "ROS 1 bag");
  const { frames: found, poses, cameras } = await walk.read();
  assert.equal(found.length, 3);
  assert.deepEqual([found[0].image.width, found[0].depth.width, cameras.length], [240, 128, 2]);
  assert.equal(poses[0].from, FRAMES.depth);
  const depths = [];
  for (const name of ["depth-none.bag", "depth-bz2.bag"]) {
    const { topics, chosen } = await opened(fixture(name), name);
    assert.equal(chosen.depth, "/camera/depth/image_raw/compressedDepth");
    depths.push(topics);
  }
  assert.deepEqual(depths[0], depths[1]);
});

test("recordings of librealsense have cameras, units and motions below the names of their streams", async () => {
  const { image: colour, depth } = frame();
  const at = "/device_0/sensor_0";
  const time = START + 0.1;
  const motion = (topic, pose) => image(topic, transform("", "", pose).transform, "geometry_msgs/Transform");
  const identity = { rotation: [1, 0, 0, 0, 1, 0, 0, 0, 1], translation: [0, 0, 0] };
  const messages = [
    image(`${at}/option/Depth_Units/value`, { data: 0.00025 }, "std_msgs/Float32"),
    motion(`${at}/Depth_0/tf/0`, identity),
    motion("/device_0/sensor_1/Color_0/tf/0", POSE),
    image(`${at}/Depth_0/info/camera_info`, infoMessage(K, depth, time, ""), "sensor_msgs/CameraInfo"),
    image(
      "/device_0/sensor_1/Color_0/info/camera_info",
      infoMessage(CAMERA, colour, time, ""),
      "sensor_msgs/CameraInfo",
    ),
    image(`${at}/Depth_0/image/data`, { ...depthMessage(depth, time, "0"), encoding: "mono16" }),
    image(`${at}/Infrared_1/image/data`, { ...depthMessage(depth, time, "1"), encoding: "16UC1" }),
    image("/device_0/sensor_1/Color_0/image/data", imageMessage(colour, time, "2")),
  ];
  const recording = await written(messages, { generation: "ros1" });
  const {
    frames: [found],
    poses,
  } = await recording.read();
  assert.equal(found.depth.unit, Math.fround(0.00025));
  assert.deepEqual([found.depth.camera, found.image.camera], [K, CAMERA]);
  close(poses[0].pose.rotation, rotation, 1e-6);
  close(poses[0].pose.translation, translation, 1e-9);
});

/** A calibration that names its cameras and their sizes. */
const CALIBRATION = JSON.stringify({
  depth: { ...K, width: W, height: H },
  depth_other: { ...K, fx: 28, fy: 29, width: 2 * W, height: 2 * H },
  color: { ...CAMERA, distortion_model: "plumb_bob", width: W, height: H },
  depth_to_color: { rotation_matrix: [0, 1, 2].map((row) => rotation.slice(3 * row, 3 * row + 3)), translation },
});
for (const [words, options] of [
  ["in single blocks", {}],
  ["in groups", { groups: true }],
  ["in clusters of unknown size", { isOpen: true }],
])
  test(`a Matroska file of an Azure Kinect ${words} gives frames and its attached calibration's cameras`, async () => {
    const recording = await opened(matroska(frames(3), CALIBRATION, options), "a.mkv");
    assert.equal(recording.says, "Matroska, 1.0 s, 3 tracks");
    assert.deepEqual(recording.chosen, { colour: "COLOR", depth: "DEPTH" });
    const { frames: found, cameras, poses, warnings } = await recording.read();
    assert.equal(found.length, 3);
    assert.deepEqual([...found[2].depth.data], [...frame(2).depth.data]);
    assert.deepEqual(found[0].depth.camera, K);
    assert.deepEqual(found[0].image.camera, CAMERA);
    assert.equal(cameras.length, 2);
    close(poses[0].pose.translation, translation, 1e-9);
    assert.deepEqual(
      warnings.filter(({ isDoubt }) => isDoubt),
      [],
    );
  });

test("a Matroska file without a calibration, of other codecs or cut off has warnings or errors", async () => {
  const found = await (await opened(matroska(frames(2), "{}"), "a.mkv")).read();
  assert.deepEqual(
    codes(found).filter((code) => /missing/.test(code)),
    ["colour-camera-missing", "depth-camera-missing", "transform-missing"],
  );
  const bytes = matroska(frames(2), CALIBRATION);
  const other = Buffer.from(bytes.toString("latin1").replaceAll("MJPG", "H264"), "latin1");
  await refusedFile((await opened(other, "a.mkv")).read(), "a.mkv", /"H264", which is not supported.+MJPG/);
  await refusedFile(opened(bytes.subarray(0, 700), "a.mkv"), "a.mkv", /cut off/);
  const half = await opened(bytes.subarray(0, bytes.length - 1000), "a.mkv");
  assert.equal((await half.read()).frames.length, 1);
});

test("moments at which the rig rests are preferred to those at which it moves", async () => {
  // Two frames at each place, and one on the way to the next.
  const all = Array.from({ length: 8 }, (_, place) => [
    frame(2 * place),
    frame(2 * place),
    frame(2 * place + 1),
  ]).flat();
  const { frames: found } = await (await written(driver(all, POSE, { every: 0.1 }))).read({ frames: 4 });
  const depths = new Set(Array.from({ length: 8 }, (_, place) => Math.max(...frame(2 * place).depth.data)));
  assert.equal(found.length, 4);
  for (const { depth } of found) assert.ok(depths.has(Math.max(...depth.data)));
});
