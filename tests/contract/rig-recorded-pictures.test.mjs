// The encodings of images, depths and clouds in recordings, and the cameras of each.
import assert from "node:assert/strict";
import { test } from "node:test";
import { K, CAMERA, START, recorded, replacing, written, image } from "./recorded.mjs";
import {
  FRAMES,
  cloudMessage,
  compressedDepthMessage,
  depthMessage,
  headerOf,
  infoMessage,
  transform,
} from "./recordings.mjs";
import { H, W, close, metres, millimetres, translation } from "./rig-support.mjs";

const bayer = (pattern) => ({ width: W, height: H, encoding: `bayer_${pattern}8`, step: W, is_bigendian: 0 });
/** Each encoding stores the same grey picture, given in rows. */
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
    const recording = await replacing("/camera/color/image_raw", image("/camera/color/image_raw", message));
    const {
      frames: [{ image: found }],
    } = await recording.read();
    const scale = found.data instanceof Uint16Array ? 256 : 1;
    assert.deepEqual(
      [...found.data].filter((_, at) => at % 4 === 1),
      values.map((value) => value * scale),
    );
  });

test("a Bayer pattern keeps the measured colour of each pixel and interpolates the others", async () => {
  const data = Uint8Array.from({ length: W * H }, (_, pixel) => {
    const [x, y] = [pixel % W, Math.floor(pixel / W)];
    return y % 2 === 0 ? (x % 2 === 0 ? 200 : 100) : x % 2 === 0 ? 100 : 50;
  });
  const message = { header: headerOf(START + 0.1, FRAMES.colour), ...bayer("rggb"), data };
  const recording = await replacing("/camera/color/image_raw", image("/camera/color/image_raw", message));
  const {
    frames: [{ image: found }],
  } = await recording.read();
  for (let pixel = 0; pixel < W * H; pixel++)
    assert.deepEqual([...found.data.slice(4 * pixel, 4 * pixel + 3)], [200, 100, 50]);
});

test("32-bit depth is in metres, and so is depth compressed as inverse depths", async () => {
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
    const recording = await replacing("/camera/depth/image_raw", image("/camera/depth/image_rect", message, type));
    const {
      frames: [found],
    } = await recording.read();
    close(
      metres(found),
      millimetres.map((value) => value / 1000),
      tolerance + 1e-6,
    );
  }
});

test("RVL data is read as depth", async () => {
  // Two pixels without depth, then 1000, 1003 and 998 millimetres, as counts and zigzag-coded differences with three bits per nibble.
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
  const compressed = image("/camera/depth/image_raw/compressedDepth", message, "sensor_msgs/CompressedImage");
  const {
    frames: [found],
  } = await (await replacing("/camera/depth/image_raw", compressed)).read();
  assert.deepEqual([...found.depth.data], [0, 0, 1000, 1003, 998]);
});

test("an organised PointCloud2 is read as depth, in its frame", async () => {
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
});

test("a PointCloud2 without rows and columns is sorted into a range image, in its axes", async () => {
  const [rows, columns] = [16, 180];
  const angle = (degrees) => (degrees * Math.PI) / 180;
  // A LiDAR's axes: x forward, z up; the wall is a cylinder around it.
  const points = Float32Array.from({ length: 3 * rows * columns }, (_, at) => {
    const [point, axis] = [Math.floor(at / 3), at % 3];
    const [up, around] = [angle(Math.floor(point / columns) - 8), angle(2 * (point % columns))];
    return 5 * [Math.cos(around), Math.sin(around), Math.tan(up)][axis];
  });
  const base = recorded({}, 1).filter(({ topic }) => !topic.startsWith("/camera/depth"));
  const size = { width: rows * columns, height: 1 };
  const message = cloudMessage({ ...size, points }, START + 0.1, FRAMES.depth);
  const found = await (await written([...base, image("/lidar/points", message, "sensor_msgs/PointCloud2")])).read();
  const [{ depth }] = found.frames;
  assert.ok(depth.height >= rows && depth.width >= columns, `${depth.width}x${depth.height}`);
  const valid = depth.points.filter((value, at) => at % 3 === 0 && Number.isFinite(value)).length;
  assert.ok(valid > 0.98 * rows * columns, `${valid} points`);
  assert.ok(
    found.warnings.some(({ code }) => code === "points-sorted"),
    JSON.stringify(found.warnings),
  );
  close(found.poses[0].pose.translation, translation, 1e-9);
});

test("a rectified image has the camera of P without distortion, a binned image the camera of its bins", async () => {
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

test("a cloud in a robot's axes, x forward and z up, is turned as its transform says", async () => {
  const points = Float32Array.from({ length: 3 * W * H }, (_, at) => {
    const [x, y] = [Math.floor(at / 3) % W, Math.floor(at / 3 / W)];
    const z = 1 + 0.01 * ((x + y) % 7);
    return [((x - W / 2) * z) / 14, ((y - H / 2) * z) / 14, z][at % 3];
  });
  const body = points.map((_, at) => [points[at + 2], -points[at - 1], -points[at - 1]][at % 3]);
  const topic = "/lidar/points";
  const base = recorded({}, 1).filter(({ topic }) => !/depth|tf_static/.test(topic));
  const toOptical = [0, -1, 0, 0, 0, -1, 1, 0, 0];
  const messages = [
    ...base,
    {
      topic: "/tf_static",
      type: "tf2_msgs/TFMessage",
      time: START,
      message: { transforms: [transform(FRAMES.colour, "lidar", { rotation: toOptical, translation })] },
    },
    image(topic, cloudMessage({ width: W, height: H, points: body }, START + 0.1, "lidar"), "sensor_msgs/PointCloud2"),
  ];
  const {
    frames: [found],
    poses,
  } = await (await written(messages)).read();
  close([...found.depth.points], [...points], 1e-6);
  close(poses[0].pose.rotation, [1, 0, 0, 0, 1, 0, 0, 0, 1], 1e-9);
  close(poses[0].pose.translation, translation, 1e-9);
});
