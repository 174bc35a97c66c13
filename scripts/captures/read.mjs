// The captures for measuring the check: whole frames without masks, as clouds, with the extrinsics that their authors state.
import { after, inverse, moved, poseOf, quantile } from "../rigs/draws.mjs";
import { bytes, capture } from "../real-pairs.mjs";
import { IDENTITY } from "../../protocols/rotations.mjs";
import { cloud } from "./lens.mjs";

const MILLIMETRE = 0.001;
const SAME = poseOf(IDENTITY, [0, 0, 0]);

/** A frame before its truth is hidden; `centre` is the pivot of rotations about the scene, colour frame. */
function sight(name, { image, depth }, truth, centre) {
  const points = depth.points ?? cloud(depth);
  return {
    name,
    image,
    grid: { width: depth.width, height: depth.height },
    points,
    truth,
    centre: centre ?? middle(points, truth),
  };
}

/** Medians of the points' coordinates in the colour frame. */
function middle(points, truth, isAsked = () => true) {
  const axes = [[], [], []];
  for (let index = 0; index < points.length / 3; index += 3) {
    const point = points.subarray(3 * index, 3 * index + 3);
    if (point[2] > 0 && isAsked(index)) moved(truth, [...point]).forEach((value, axis) => axes[axis].push(value));
  }
  return axes.map((values) => quantile(values, 0.5));
}

/** The frame as it was taken. */
export function nyuRig({ decodeColour, decodeDepth }) {
  const read = (name) => bytes("nyu_raw_pair", name);
  const calib = JSON.parse(read("calib.json").toString());
  const camera = ({ fx, fy, cx, cy, dist_k1k2p1p2k3: distortion }) => ({ fx, fy, cx, cy, distortion });
  const image = { ...decodeColour(read("color_raw.png")), camera: camera(calib.rgb) };
  const depth = { ...decodeDepth(read("depth_raw_mm.png")), camera: camera(calib.depth), unit: MILLIMETRE };
  return { name: "nyu_raw_pair", frames: [{ image, depth }], pose: poseOf(calib.R.flat(), calib.t) };
}

export function nyu(files) {
  const { name, frames, pose } = nyuRig(files);
  return sight(name, frames[0], pose);
}

/** The depth map of frame `from` with the colour image of frame `to`. The pose follows from the camera's two poses in the room. */
export function sevenScenes(from, to, { decodeColour, decodeDepth }) {
  const read = (number, kind) => bytes("seven_scenes", `frame-000${number}.${kind}`);
  const [[fx, , cx], [, fy, cy]] = numbers(bytes("seven_scenes", "camera-intrinsics.txt"));
  const place = (number) => {
    const rows = numbers(read(number, "pose.txt")).slice(0, 3);
    return poseOf(
      rows.flatMap((row) => row.slice(0, 3)),
      rows.map((row) => row[3]),
    );
  };
  const camera = { fx, fy, cx, cy };
  const image = { ...decodeColour(read(to, "color.png")), camera };
  const depth = { ...decodeDepth(read(from, "depth.png")), camera, unit: MILLIMETRE };
  return sight(
    `seven_scenes ${from} onto ${to}`,
    { image, depth },
    from === to ? SAME : after(inverse(place(to)), place(from)),
  );
}

/** A frame of a rig, read from files. */
export function rigSight({ name, image, depth }, truth) {
  const unit = depth.unit ?? (depth.data instanceof Uint16Array ? MILLIMETRE : 1);
  return sight(name, { image, depth: { ...depth, unit } }, truth);
}

const numbers = (text) =>
  text
    .toString()
    .split("\n")
    .filter((line) => line.trim() !== "")
    .map((line) => line.trim().split(/\s+/).map(Number));

const OBJECTS = ["coffee_mug_1", "bowl_1", "cap_1", "cereal_box_1"].flatMap((name) =>
  [1, 2].map((frame) => [name, frame]),
);
const LAMPS = [1, 7, 14].map((frame) => ["mitten_rgbd", frame]);
const REGISTERED = [...OBJECTS, ["vase_rgbd", ""], ["android_rgbd", ""], ...LAMPS];

/** Registered captures of single objects with their surroundings; the middle is that of the masked object. */
export function registered(files) {
  return REGISTERED.map(([name, frame]) => {
    const { image, depth } = capture(name, frame, files);
    const points = cloud(depth);
    const centre = middle(points, SAME, (index) => depth.mask[index]);
    // Both files of the android have the background removed; the other captures include it.
    const masked = name === "android_rgbd";
    const { mask, ...bare } = image;
    const shown = sight(
      `${name} ${frame}`.trim(),
      { image: masked ? image : bare, depth: { ...depth, points } },
      SAME,
      centre,
    );
    return masked ? { ...shown, mask: depth.mask } : shown;
  });
}

/**
 * A frame with its cloud in another frame of reference, so that the answer differs from the identity and from the authors' pose.
 * Clouds are transformed point by point; nothing is rendered, so no depth is interpolated.
 */
export function hide(frame, motion) {
  const points = new Float32Array(frame.points.length);
  for (let at = 0; at < points.length; at += 3) points.set(moved(motion, [...frame.points.subarray(at, at + 3)]), at);
  return { ...frame, points, truth: after(frame.truth, inverse(motion)) };
}

/** The frame in the form that the package takes. */
export const checkFrame = ({ name, image, grid, points, mask }) => ({
  name,
  image,
  depth: { ...grid, points, ...(mask && { mask }) },
});
