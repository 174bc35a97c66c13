// Writes the files of a few synthetic rigs, for independent readers (rig-written.py) and for tests/contract/rig-write.test.mjs.
//
// npm run build && node scripts/reference/rig-written.mjs     writes tests/fixtures/rig/
import { mkdirSync, realpathSync, writeFileSync } from "node:fs";
import { poseFormats, writeClouds, writePose } from "../../pkg/rig-write.js";
import { inRoot } from "../shell.mjs";

export const FOLDER = "tests/fixtures/rig";

/** The rotation of an x y z w quaternion of any length, row-major. */
function rotation(x, y, z, w) {
  const s = 2 / (x * x + y * y + z * z + w * w);
  return [
    ...[1 - s * (y * y + z * z), s * (x * y - w * z), s * (x * z + w * y)],
    ...[s * (x * y + w * z), 1 - s * (x * x + z * z), s * (y * z - w * x)],
    ...[s * (x * z - w * y), s * (y * z + w * x), 1 - s * (x * x + y * y)],
  ];
}

const pose = (turn, translation) => ({
  scale: 1,
  rotation: rotation(...turn),
  translation,
  angles: { alpha: 0, beta: 0, gamma: 0 },
});
const vga = [640, 480];

export const RIGS = {
  /** A depth sensor without distortion beside a colour camera with distortion. */
  usual: {
    pose: pose([0.004, -0.011, 0.0023, 1], [-0.02503, 0.00017, 1 / 3000]),
    context: {
      depth: { fx: 580.6, fy: 581.1, cx: 313.45, cy: 238.4, distortion: [0, 0, 0, 0, 0] },
      colour: {
        fx: 517.306408,
        fy: 516.469215,
        cx: 318.64304,
        cy: 255.313989,
        distortion: [0.262383, -0.953104, -0.005358, 0.002628, 1.163314],
      },
      sizes: { depth: vga, colour: [1280, 960] },
    },
  },
  /** Nearly half a turn, tiny and round numbers, the lens models with the fewest and the most numbers. */
  turned: {
    pose: pose([0.7, -0.1, 0.7, 1e-9], [1, -2e-7, 3.25e-21]),
    context: {
      depth: { model: "fisheye", fx: 300, fy: 300.5, cx: 320, cy: 240, distortion: [0.01, -1e-7, 0, 0.25] },
      colour: { fx: 1000, fy: 1001, cx: 640, cy: 360, distortion: [0.1, 0.2, 0.001, 0.002, 0.3, 0.4, 0.5, 0.6] },
      sizes: { depth: vga, colour: [1280, 720] },
      frames: { depth: "tof_optical_frame", colour: "rig/colour" },
    },
  },
  /** Four distortion coefficients, which every format holds, and no sizes. */
  radial: {
    pose: pose([-0.2, 0.3, 0.1, 0.9], [0.1, 0.2, -0.3]),
    context: {
      depth: { fx: 365, fy: 365, cx: 256, cy: 212, distortion: [0.09, -0.27, 0, 1e-5] },
      colour: { fx: 1050, fy: 1050, cx: 960, cy: 540 },
    },
  },
  /** Only the pose. */
  bare: { pose: pose([0, 0, 0, 1], [0, -0.05, 0]), context: {} },
};

/** In Open3D there are no extrinsics without intrinsics. */
export const formatsOf = (rig) => poseFormats.filter((format) => format !== "open3d" || RIGS[rig].context.colour);

/** Two small clouds: the first with missing points, the second without colours. */
export const CLOUDS = [
  {
    name: "depth",
    points: new Float32Array([0, 0.1, 1, NaN, NaN, NaN, -0.2, 1 / 3, 2.5]),
    colours: new Uint8Array([255, 0, 7, 1, 2, 3, 10, 20, 30]),
  },
  { name: "colour", points: new Float32Array([1e-7, -4, 8]) },
];

/** Every file by its name. */
export function files() {
  const made = {};
  for (const [rig, { pose, context }] of Object.entries(RIGS)) {
    for (const format of formatsOf(rig)) {
      const { name, text } = writePose(pose, format, context);
      made[`${rig}/${name}`] = new TextEncoder().encode(text);
    }
  }
  return { ...made, "clouds.ply": writeClouds(CLOUDS), "cloud.ply": writeClouds(CLOUDS.slice(0, 1)) };
}

if (import.meta.filename === realpathSync(process.argv[1])) {
  for (const rig of Object.keys(RIGS)) mkdirSync(inRoot(FOLDER, rig), { recursive: true });
  for (const [name, bytes] of Object.entries(files())) writeFileSync(inRoot(FOLDER, name), bytes);
}
