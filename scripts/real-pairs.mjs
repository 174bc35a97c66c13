// Real pairs from the data beside the project, and the loop's results on them; shared by `pairs.mjs`, `captures.mjs` and the tests.
import { existsSync, readFileSync } from "node:fs";
import { join } from "node:path";
import { inRoot } from "./shell.mjs";

/** Other people's data, never part of the project. */
const DATA = inRoot("../shared/data");

/** A Kinect v1 with the nominal values of the data set's authors. */
export const KINECT = { fx: 525, fy: 525, cx: 319.5, cy: 239.5 };
const MILLIMETRE = 0.001;

export const hasData = () => existsSync(DATA);
export const MISSING = `no data in ${DATA}`;

export const bytes = (...path) => readFileSync(join(DATA, ...path));

/** Colour of one frame and depth of the same frame, or of another that the same camera took a moment later. */
function frames(object, [first, second], { decodeColour, decodeDepth, decodeMask }) {
  const frame = (number, kind) => bytes("rgbd_object", `${object}_1_${number}_${kind}`);
  const camera = (number) => {
    // The crop's first column and row in the whole frame, counted from 1.
    const [column, row] = frame(number, "loc.txt").toString().split(",").map(Number);
    return { ...KINECT, cx: KINECT.cx - (column - 1), cy: KINECT.cy - (row - 1) };
  };
  const mask = (number) => decodeMask(frame(number, "maskcrop.png")).data;
  return {
    image: { ...decodeColour(frame(first, "crop.png")), mask: mask(first), camera: camera(first) },
    depth: {
      ...decodeDepth(frame(second, "depthcrop.png")),
      mask: mask(second),
      camera: camera(second),
      unit: MILLIMETRE,
    },
  };
}

/** Colour and depth of one moment, so that the true pose is the identity. */
function vase({ decodeColour, decodeDepth, decodeMask }) {
  const { fx, fy, cx, cy } = JSON.parse(bytes("vase_rgbd", "camera.json").toString());
  const shared = { mask: decodeMask(bytes("vase_rgbd", "mask.png")).data, camera: { fx, fy, cx, cy } };
  return {
    image: { ...decodeColour(bytes("vase_rgbd", "color.png")), ...shared },
    depth: { ...decodeDepth(bytes("vase_rgbd", "depth_mm.png")), ...shared, unit: MILLIMETRE },
  };
}

/** A colour image at half its resolution: means of blocks of 2x2 pixels. */
function halved({ width, height, data, ...rest }) {
  const half = { width: width / 2, height: height / 2, data: new data.constructor(data.length / 4) };
  for (let index = 0; index < half.width * half.height; index++) {
    const first = 2 * (index % half.width) + 2 * width * Math.floor(index / half.width);
    for (let channel = 0; channel < 4; channel++) {
      const sum = [0, 1, width, width + 1].reduce((total, step) => total + data[4 * (first + step) + channel], 0);
      half.data[4 * index + channel] = Math.round(sum / 4);
    }
  }
  return { ...rest, ...half };
}

/** A registered colour image and mask, twice as large as the depth map: `android_rgbd`, and a lamp of `mitten_rgbd`. */
function twofold(folder, names, camera, { decodeColour, decodeDepth, decodeMask }) {
  const [colour, depth, mask] = names.map((name) => bytes(folder, name));
  const { width, data } = decodeMask(mask);
  const shared = { mask: data.filter((_, index) => index % 2 === 0 && Math.floor(index / width) % 2 === 0), camera };
  const FIFTH = 0.2 * MILLIMETRE;
  return {
    image: { ...halved(decodeColour(colour)), ...shared },
    depth: { ...decodeDepth(depth), ...shared, unit: FIFTH },
  };
}

/** Colour and depth of one moment, seen by one camera, so that the true pose is the identity. */
export function capture(name, frame, files) {
  if (name === "vase_rgbd") return vase(files);
  if (name === "android_rgbd") {
    const camera = { fx: 608.35, fy: 608.35, cx: 319.75, cy: 239.75 };
    return twofold(name, ["color.png", "depth.png", "mask.png"], camera, files);
  }
  if (name === "mitten_rgbd") {
    const camera = { fx: 608.365, fy: 608.365, cx: 319.5, cy: 239.5 };
    return twofold(name, [`color_${frame}.png`, `depth_${frame}.png`, "mask.png"], camera, files);
  }
  return frames(name, [frame, frame], files);
}

const OBJECTS = ["coffee_mug_1", "bowl_1", "cap_1", "cereal_box_1"];

/** Names of the pairs, and how to read each with the package's decoders. */
export const PAIRS = {
  ...Object.fromEntries(OBJECTS.map((object) => [object, (files) => frames(object, [1, 2], files)])),
  vase_rgbd: vase,
};

/** Degrees of the rotation with this row-major matrix. */
const degrees = ([a, , , , b, , , , c]) => (Math.acos(Math.min(1, Math.max(-1, (a + b + c - 1) / 2))) * 180) / Math.PI;

/** Runs the loop to its end. Both frames are metric, so the pose's translation is in metres. */
export async function runPair(Estimator, { image, depth }, options = {}) {
  const estimator = new Estimator(image, depth, {
    light: "estimate",
    start: "identity",
    registration: "icp",
    shading: "pixel",
    ...options,
  });
  try {
    const before = estimator.report;
    const after = await estimator.run();
    const refined = estimator.refinedDepth();
    const holes = [...depth.data.keys()].filter((pixel) => depth.mask[pixel] && depth.data[pixel] === 0);
    return {
      report: after,
      rotation: degrees(after.pose.rotation),
      shift: 1000 * Math.hypot(...after.pose.translation),
      residualBefore: before.residual,
      residualAfter: after.residual,
      holes: holes.length,
      filled: holes.filter((pixel) => Number.isFinite(refined[pixel])).length,
      refined,
      imageNormals: estimator.imageNormals(),
      depthNormals: estimator.depthNormals(),
    };
  } finally {
    estimator.free();
  }
}

const HEADINGS = [
  "pair",
  "status",
  "iterations",
  "alpha",
  "beta",
  "gamma",
  "rotation",
  "shift mm",
  "residual",
  "holes filled",
];

/** The rows of a text table under its headings. */
export function table(rows) {
  const cells = rows.map(([name, { report, rotation, shift, residualBefore, residualAfter, holes, filled }]) => [
    name,
    report.status,
    String(report.iteration),
    ...Object.values(report.pose.angles).map((angle) => angle.toFixed(2)),
    rotation.toFixed(2),
    shift.toFixed(1),
    `${residualBefore.toFixed(3)} -> ${residualAfter.toFixed(3)}`,
    `${filled} of ${holes}`,
  ]);
  const all = [HEADINGS, ...cells];
  const widths = HEADINGS.map((_, column) => Math.max(...all.map((row) => row[column].length)));
  return all.map((row) =>
    row
      .map((cell, column) => cell.padEnd(widths[column]))
      .join("  ")
      .trimEnd(),
  );
}
