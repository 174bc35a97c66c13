// Recordings of a rig: which topics are taken, in which encodings, with which cameras and transforms, and what is said where something is amiss.
import assert from "node:assert/strict";
import { readFileSync } from "node:fs";
import { test } from "node:test";
import { fileURLToPath } from "node:url";
import { isRecording, openRecording } from "../../pkg/rig-recordings.js";
import * as rig from "../../pkg/rig.js";
import {
  FRAMES,
  cloudMessage,
  compressedDepthMessage,
  depthMessage,
  driver,
  headerOf,
  imageMessage,
  infoMessage,
  lz4Frame,
  mcap,
  transform,
  zstdFrame,
} from "./recordings.mjs";
import {
  H,
  W,
  close,
  distortion,
  metres,
  millimetres,
  refusedFile,
  rgb,
  rotation,
  translation,
} from "./rig-support.mjs";

const POSE = { rotation, translation };
/** Of pictures as small as these. */
const K = { fx: 14, fy: 14.5, cx: 8.25, cy: 5.75 };
const CAMERA = { ...K, distortion };
const START = 1_700_000_000;

/** A scene that is another one for each index: the same picture, farther and darker. */
function frame(index = 0) {
  const data = new Uint8Array(4 * W * H).fill(255);
  rgb.forEach((colour, pixel) =>
    data.set(
      colour.map((value) => value / (1 + ((pixel + index) % 3))),
      4 * pixel,
    ),
  );
  const depth = Uint16Array.from(millimetres, (value) => value && value + 200 * index);
  return {
    image: { width: W, height: H, data, camera: CAMERA },
    depth: { width: W, height: H, data: depth, camera: K },
  };
}
const frames = (count) => Array.from({ length: count }, (_, index) => frame(index));
const recorded = (options, count = 3) => driver(frames(count), POSE, { compress: false, ...options });

const opened = (content, name = "a.mcap") => openRecording({ name, content });
const written = async (messages, options) => opened(await mcap(messages, options));
const codes = ({ warnings }) => warnings.map(({ code }) => code);

/** The three messages of one more picture. */
const image = (topic, message, type = "sensor_msgs/Image") => ({ topic, type, time: START + 0.2, message });

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

const bayer = (pattern) => ({ width: W, height: H, encoding: `bayer_${pattern}8`, step: W, is_bigendian: 0 });
/** Each encoding stores the same grey picture of rows. */
const ENCODINGS = {
  bgra8: [4, (value) => [value, value, value, 255]],
  mono8: [1, (value) => [value]],
  rgb16: [6, (value) => [value, value, value].flatMap((each) => [0, each])],
  yuv422_yuy2: [2, (value) => [value, 128]],
  uyvy: [2, (value) => [128, value]],
};
for (const [encoding, [step, bytes]] of Object.entries(ENCODINGS))
  test(`pictures stored as ${encoding} are read`, async () => {
    const values = Array.from({ length: W * H }, (_, pixel) => 20 * Math.floor(pixel / W));
    const message = {
      header: headerOf(START + 0.1, FRAMES.colour),
      width: W,
      height: H,
      encoding,
      is_bigendian: 0,
      step: step * W,
      data: Uint8Array.from(values.flatMap(bytes)),
    };
    const messages = [
      ...recorded({}, 1).filter(({ topic }) => topic !== "/camera/color/image_raw"),
      image("/camera/color/image_raw", message),
    ];
    const {
      frames: [{ image: found }],
    } = await (await written(messages)).read();
    const scale = found.data instanceof Uint16Array ? 256 : 1;
    assert.deepEqual(
      [...found.data].filter((_, at) => at % 4 === 1),
      values.map((value) => value * scale),
    );
  });

test("a Bayer pattern keeps its own colour at each pixel, and fills in the others", async () => {
  const data = Uint8Array.from({ length: W * H }, (_, pixel) => {
    const [x, y] = [pixel % W, Math.floor(pixel / W)];
    return y % 2 === 0 ? (x % 2 === 0 ? 200 : 100) : x % 2 === 0 ? 100 : 50;
  });
  const message = { header: headerOf(START + 0.1, FRAMES.colour), ...bayer("rggb"), data };
  const messages = [
    ...recorded({}, 1).filter(({ topic }) => topic !== "/camera/color/image_raw"),
    image("/camera/color/image_raw", message),
  ];
  const {
    frames: [{ image: found }],
  } = await (await written(messages)).read();
  for (let pixel = 0; pixel < W * H; pixel++)
    assert.deepEqual([...found.data.slice(4 * pixel, 4 * pixel + 3)], [200, 100, 50]);
});

test("depth of 32 bits is in metres, compressed as inverse depths, too", async () => {
  const floats = Float32Array.from(millimetres, (value) => (value ? value / 1000 : NaN));
  const [a, b] = [3000, -20];
  const inverse = Uint16Array.from(floats, (value) => (Number.isNaN(value) ? 0 : Math.round(a / value + b)));
  const stored = { width: W, height: H, data: floats };
  for (const [type, message, tolerance] of [
    ["sensor_msgs/Image", depthMessage(stored, START + 0.1, FRAMES.depth), 0],
    [
      "sensor_msgs/CompressedImage",
      compressedDepthMessage({ ...stored, data: inverse }, START + 0.1, FRAMES.depth, { quantised: [a, b] }),
      2e-3,
    ],
  ]) {
    const topic = "/camera/depth/image_rect";
    const messages = [
      ...recorded({}, 1).filter(({ topic }) => topic !== "/camera/depth/image_raw"),
      image(topic, message, type),
    ];
    const {
      frames: [found],
    } = await (await written(messages)).read();
    close(
      metres(found),
      millimetres.map((value) => value / 1000),
      tolerance + 1e-6,
    );
  }
});

test("runs of RVL are read as depth", async () => {
  // Two pixels without depth, then 1000, 1003 and 998 millimetres: counts and differences by zigzag, three bits a nibble.
  const words = [2, 3, 2000, 6, 9];
  const nibbles = words.flatMap((value) => {
    const found = [];
    for (let rest = value; found.length === 0 || rest > 0; rest >>>= 3) found.push((rest & 7) | (rest >>> 3 ? 8 : 0));
    return found;
  });
  const data = new DataView(new ArrayBuffer(12 + 8 + 4 * Math.ceil(nibbles.length / 8)));
  data.setUint32(12, 5, true);
  data.setUint32(16, 1, true);
  nibbles.forEach((nibble, at) => {
    const place = 20 + 4 * Math.floor(at / 8);
    data.setUint32(place, (data.getUint32(place, true) | (nibble << (28 - 4 * (at % 8)))) >>> 0, true);
  });
  const message = {
    header: headerOf(START + 0.1, FRAMES.depth),
    format: "16UC1; compressedDepth rvl",
    data: new Uint8Array(data.buffer),
  };
  const messages = [
    ...recorded({}, 1).filter(({ topic }) => topic !== "/camera/depth/image_raw"),
    image("/camera/depth/image_raw/compressedDepth", message, "sensor_msgs/CompressedImage"),
  ];
  const {
    frames: [found],
  } = await (await written(messages)).read();
  assert.deepEqual([...found.depth.data], [0, 0, 1000, 1003, 998]);
});

test("an organised PointCloud2 is taken as depth, in its own frame", async () => {
  const points = Float32Array.from({ length: 3 * W * H }, (_, at) =>
    at % 3 === 2 ? 1 + 0.01 * (at % 7) : 0.01 * (at % 50),
  );
  const topic = "/camera/depth/points";
  const base = recorded({}, 1).filter(({ topic }) => !topic.startsWith("/camera/depth"));
  const cloud = (size) =>
    image(topic, cloudMessage({ ...size, points }, START + 0.1, FRAMES.depth), "sensor_msgs/PointCloud2");
  const {
    frames: [found],
    poses,
  } = await (await written([...base, cloud({ width: W, height: H })])).read();
  close([...found.depth.points], [...points], 1e-6);
  close(poses[0].pose.translation, translation, 1e-9);
  const flat = await written([...base, cloud({ width: W * H, height: 1 })]);
  await refusedFile(flat.read(), "a.mcap", /without rows and columns.+organised/);
});

test("a rectified picture has P's camera and no distortion, a picture in bins the camera of its bins", async () => {
  const p = [700, 0, 8, 0, 0, 710, 6, 0, 0, 0, 1, 0];
  const base = recorded({}, 1).filter(({ topic }) => topic !== "/camera/color/camera_info");
  const time = START + 0.1;
  const info = (more, size = { width: W, height: H }) =>
    image("/camera/color/camera_info", infoMessage(CAMERA, size, time, FRAMES.colour, more), "sensor_msgs/CameraInfo");
  const rectified = base.map((each) =>
    each.topic === "/camera/color/image_raw" ? { ...each, topic: "/camera/color/image_rect_color" } : each,
  );
  const first = await (await written([...rectified, info({ p })])).read();
  assert.deepEqual(first.frames[0].image.camera, { fx: 700, fy: 710, cx: 8, cy: 6 });
  const second = await (
    await written([...base, info({ binning_x: 2, binning_y: 2 }, { width: 2 * W, height: 2 * H })])
  ).read();
  const { fx, fy, cx, cy } = second.frames[0].image.camera;
  close([fx, fy, cx, cy], [K.fx / 2, K.fy / 2, (K.cx + 0.5) / 2 - 0.5, (K.cy + 0.5) / 2 - 0.5], 1e-9);
});

test("transforms of /tf are taken where tf_static has none, and one that moves is a doubt", async () => {
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
  const none = await (await written(base)).read();
  assert.deepEqual(none.poses, []);
  assert.ok(codes(none).includes("transform-missing"));
});

test("pictures of different moments, of two clocks and of one view are said", async () => {
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

test("out of many moments ten are taken, and at most so many as are asked for", async () => {
  const recording = await written(recorded({ every: 0.1 }, 60));
  assert.equal((await recording.read()).frames.length, 10);
  assert.equal((await recording.read({ frames: 4 })).frames.length, 4);
});

test("the best of several topics is chosen, and any other can be asked for", async () => {
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
  // Registered to the colour image: one frame, and no motion between the two.
  close(poses[0].pose.translation, [0, 0, 0], 1e-12);
  assert.equal(first.depth.camera.fx, K.fx);
});

test("what cannot be read is refused in words that name it and the way out", async () => {
  const protobuf = recorded({}, 1).map((each) => ({ ...each, encoding: "protobuf", schemaEncoding: "protobuf" }));
  await refusedFile((await written(protobuf)).read(), "a.mcap", /protobuf.+ROS 1 and ROS 2/);
  const h264 = recorded({ compress: true }, 1).map((each) =>
    each.topic.endsWith("/compressed") ? { ...each, message: { ...each.message, format: "h264" } } : each,
  );
  await refusedFile((await written(h264)).read(), "a.mcap", /"h264", which is not read here/);
  await refusedFile(
    opened(new Uint8Array([...Buffer.from("\x89MCAP0\r\n", "latin1"), ...new Uint8Array(300)])),
    "a.mcap",
    /damaged|index|cut off/,
  );
  await refusedFile(opened(new TextEncoder().encode("#ROSBAG V2.0\n no more"), "a.bag"), "a.bag", /rosbag reindex/);
  await refusedFile(opened(new Uint8Array(100), "a.txt"), "a.txt", /no recording/);
  await assert.rejects((await written(recorded())).read({ topics: [] }), { code: "option" });
  const controller = new AbortController();
  controller.abort();
  await assert.rejects((await written(recorded())).read({ signal: controller.signal }), { name: "AbortError" });
});

test("recordings are known by their first bytes, and readers of single files say where they are read", async () => {
  const bytes = await mcap(recorded({}, 1));
  assert.ok(isRecording(bytes) && rig.isRecording(bytes));
  assert.ok(!isRecording(new TextEncoder().encode("fx: 500")));
  await refusedFile(rig.readRigFile({ name: "a.mcap", bytes }), "a.mcap", /MCAP.+ROS.+rig-recordings/);
});

const fixture = (name) =>
  new Uint8Array(readFileSync(fileURLToPath(new URL(`../fixtures/recordings/${name}`, import.meta.url))));

test("bags that rosbags has written are read, compressed by LZ4, by bzip2 and not at all", async () => {
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

test("librealsense's own recordings have cameras, units and motions below the names of their streams", async () => {
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
