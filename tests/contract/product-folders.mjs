// Small folders of datasets and apps, and recordings, by the keys of js/rig/formats/catalogue, in the products' layouts, with few frames.
import { readFileSync } from "node:fs";
import { fileURLToPath } from "node:url";
import { PICTURE_SAMPLES } from "./product-pictures.mjs";
import { CAMERA, K, START, frame, frames, image, recorded } from "./recorded.mjs";
import { depthMessage, imageMessage, infoMessage, matroska, mcap, transform } from "./recordings.mjs";
import { H, W, fixture, quaternion, rotation, rows, text, translation } from "./rig-support.mjs";
import { png } from "./support.mjs";

const each = (width, height, value) =>
  Array.from({ length: height }, (_, y) => Array.from({ length: width }, (_, x) => value(x, y)).flat());
const colour = (width = 64, height = 48) =>
  png({
    width,
    height,
    depth: 8,
    colourType: 2,
    rows: each(width, height, (x, y) => [(3 * x) & 255, (5 * y) & 255, (x * y) & 255]),
  });
const levels = (value, width = 64, height = 48) =>
  png({
    ...{ width, height, depth: 16, colourType: 0 },
    rows: each(width, height, (x, y) => [value(x, y) >> 8, value(x, y) & 255]),
  });
const depth = (width, height) => levels((x, y) => 1500 + 7 * x + y, width, height);
const grey = (value, width = 64, height = 48) =>
  png({ width, height, depth: 8, colourType: 0, rows: each(width, height, (x, y) => [value(x, y)]) });
const json = (value) => JSON.stringify(value);
const folder = (files) => ({
  files: Object.entries(files).map(([name, bytes]) => ({
    name,
    bytes: typeof bytes === "string" ? text(bytes) : bytes,
  })),
});
/** Calibration of camera 2, for small pictures. */
const KITTI = `P2: 100 0 61.5 0 0 100 18.5 0 0 0 1 0\nR0_rect: 1 0 0 0 1 0 0 0 1\nTr_velo_to_cam: 0 -1 0 0.1 0 0 -1 0.2 1 0 0 0.3\n`;
const small = { fx: 55, fy: 55, cx: 31.5, cy: 23.5 };
const pose = [
  ...[0, 1, 2].map((at) => [...rotation.slice(3 * at, 3 * at + 3), translation[at]].join(" ")),
  "0 0 0 1",
].join("\n");

const FOLDERS = {
  pairs: folder({
    ...{ "color/0001.png": colour(), "depth/0001.png": depth(), "color/0002.png": colour(), "depth/0002.png": depth() },
    "rig.json": json({ color: { ...small, width: 64, height: 48 }, depth: { ...small, width: 64, height: 48 } }),
  }),
  tum: folder({
    ...{
      "rgb/1305031102.175304.png": colour(),
      "depth/1305031102.160407.png": levels((x, y) => 5 * (1500 + 7 * x + y)),
    },
    "rgb.txt": "# timestamp filename\n1305031102.175304 rgb/1305031102.175304.png\n",
    "depth.txt": "# timestamp filename\n1305031102.160407 depth/1305031102.160407.png\n",
    "groundtruth.txt": `# timestamp tx ty tz qx qy qz qw\n1305031102.1758 1 2 3 ${quaternion.join(" ")}\n`,
  }),
  redwood: folder({
    ...{ "image/0000001-000000000000.jpg": fixture("colour.jpg"), "depth/0000001-000000000000.png": depth(16, 12) },
    "camera.json": json({ width: 16, height: 12, intrinsic_matrix: [14, 0, 0, 0, 14, 0, 7.5, 5.5, 1] }),
  }),
  "kitti-folder": folder({
    "training/image_2/000000.png": colour(124, 38),
    "training/velodyne/000000.bin": PICTURE_SAMPLES["scan-kitti"].bytes,
    "training/calib/000000.txt": KITTI,
  }),
  "scannet-folder": folder({
    ...{ "color/0.jpg": fixture("colour.jpg"), "depth/0.png": depth(16, 12), "pose/0.txt": pose },
    "intrinsic/intrinsic_color.txt": "14 0 7.5 0\n0 14 5.5 0\n0 0 1 0\n0 0 0 1\n",
    "intrinsic/intrinsic_depth.txt": "13 0 7.5 0\n0 13 5.5 0\n0 0 1 0\n0 0 0 1\n",
    "intrinsic/extrinsic_color.txt": "1 0 0 0\n0 1 0 0\n0 0 1 0\n0 0 0 1\n",
  }),
  "bop-folder": folder({
    ...{
      "rgb/000000.png": colour(),
      "depth/000000.png": depth(),
      "mask_visib/000000_000000.png": grey((x) => (x > 20 ? 255 : 0)),
    },
    "scene_camera.json": json({ 0: { cam_K: [55, 0, 31.5, 0, 55, 23.5, 0, 0, 1], depth_scale: 1 } }),
  }),
  stray: folder({
    ...{
      "rgb/000000.png": colour(96, 72),
      "depth/000000.png": depth(32, 24),
      "confidence/000000.png": grey((x) => x % 3, 32, 24),
    },
    "camera_matrix.csv": "80.0, 0.0, 47.5\n0.0, 80.0, 35.5\n0.0, 0.0, 1.0\n",
    "odometry.csv": "timestamp, frame, x, y, z, qx, qy, qz, qw\n0.1, 000000, 0, 0, 0, 0, 0, 0, 1\n",
  }),
  polycam: folder({
    ...{ "keyframes/images/100000.jpg": fixture("colour.jpg"), "keyframes/depth/100000.png": depth(8, 6) },
    "keyframes/confidence/100000.png": grey((x) => (x % 2 ? 255 : 54), 8, 6),
    "keyframes/cameras/100000.json": json({ fx: 14, fy: 14, cx: 7.5, cy: 5.5, width: 16, height: 12 }),
  }),
  record3d: folder({
    ...{
      "rgbd/0.jpg": fixture("colour.jpg"),
      "rgbd/0.exr": fixture("depth-zip.exr"),
      "rgbd/0.conf": new Uint8Array([0x62, 0x76, 0x78, 0x32, 0]),
    },
    metadata: json({ K: [14, 0, 0, 0, 14, 0, 7.5, 5.5, 1], w: 16, h: 12, dw: 16, dh: 12, fps: 30, poses: [] }),
  }),
  "realsense-viewer": folder({
    ...{ "snap_Color.png": colour(), "snap_Depth.png": colour() },
    "snap_Depth.raw": new Uint8Array(Uint16Array.from({ length: 64 * 48 }, (_, at) => 1500 + (at % 64)).buffer),
    "snap_Color_metadata.csv": `Stream,Color\nResolution x,64\nResolution y,48\nFx,55\nFy,55\nPPx,31.5\nPPy,23.5\nDistorsion,None\n`,
    "snap_Depth_metadata.csv": `Stream,Depth\nResolution x,64\nResolution y,48\nFx,50\nFy,50\nPPx,31.5\nPPy,23.5\nDistorsion,Brown Conrady\n`,
  }),
  "colmap-folder": folder({
    "images/0001.png": colour(16, 12),
    "stereo/depth_maps/0001.png.geometric.bin": PICTURE_SAMPLES["depth-colmap"].bytes,
    "sparse/cameras.txt": "1 PINHOLE 16 12 14 14 8 6\n",
  }),
  "middlebury-folder": folder({
    "im0.png": colour(),
    "disp0.pfm": new Uint8Array(
      Buffer.concat([Buffer.from("Pf\n64 48\n-1\n"), Buffer.from(new Float32Array(64 * 48).fill(9).buffer)]),
    ),
    "calib.txt":
      "cam0=[55 0 31.5; 0 55 23.5; 0 0 1]\ncam1=[55 0 33.5; 0 55 23.5; 0 0 1]\ndoffs=2\nbaseline=193\nwidth=64\nheight=48\n",
  }),
};

const at = "/device_0/sensor_0";
const motion = (topic, [turn, shift]) =>
  image(topic, transform("", "", { rotation: turn, translation: shift }).transform, "geometry_msgs/Transform");
const IDENTITY = [
  [1, 0, 0, 0, 1, 0, 0, 0, 1],
  [0, 0, 0],
];
/** The topics of librealsense, named after its streams. */
const librealsense = () => {
  const { image: picture, depth: map } = frame();
  const time = START + 0.1;
  return [
    image(`${at}/option/Depth_Units/value`, { data: 0.00025 }, "std_msgs/Float32"),
    motion(`${at}/Depth_0/tf/0`, IDENTITY),
    motion("/device_0/sensor_1/Color_0/tf/0", [rotation, translation]),
    image(`${at}/Depth_0/info/camera_info`, infoMessage(K, map, time, ""), "sensor_msgs/CameraInfo"),
    image(
      "/device_0/sensor_1/Color_0/info/camera_info",
      infoMessage(CAMERA, picture, time, ""),
      "sensor_msgs/CameraInfo",
    ),
    image(`${at}/Depth_0/image/data`, { ...depthMessage(map, time, "0"), encoding: "mono16" }),
    image("/device_0/sensor_1/Color_0/image/data", imageMessage(picture, time, "2")),
  ];
};
const bag = (name) => readFileSync(fileURLToPath(new URL(`../fixtures/recordings/${name}`, import.meta.url)));
const attached = json({
  depth: { ...K, width: W, height: H },
  color: { ...CAMERA, distortion_model: "plumb_bob", width: W, height: H },
  depth_to_color: { rotation_matrix: rows, translation },
});

const RECORDINGS = {
  "ros2-mcap": { name: "rosbag2.mcap", recording: () => mcap(recorded()) },
  "ros1-bag": { name: "walk.bag", recording: () => bag("walk-lz4.bag") },
  "realsense-bag": { name: "recording.mcap", recording: () => mcap(librealsense(), { generation: "ros1" }) },
  "azure-mkv": { name: "output.mkv", recording: () => matroska(frames(3), attached) },
  "ros2-db3": { name: "rosbag2_0.db3", bytes: text("SQLite format 3\0") },
  bridge: { robot: () => recorded({}, 1) },
};

export const FOLDER_SAMPLES = { ...FOLDERS, ...RECORDINGS };
