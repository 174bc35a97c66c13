// Two pinhole cameras: rendered pairs, and registered captures whose depth is rendered again from elsewhere.
import { FROM_ANYWHERE, NOISE } from "./scenes.mjs";

/** Two frames of each object of `rgbd_object`; colour and depth of one frame belong together. Silhouette registration was tuned on `tuned`. */
export const CAPTURES = [
  ...["coffee_mug_1", "bowl_1", "cap_1", "cereal_box_1"].flatMap((object) =>
    [1, 2].map((frame) => ({ name: object, frame, tuned: frame === 1 })),
  ),
  { name: "vase_rgbd", tuned: false },
  { name: "android_rgbd", tuned: false },
  { name: "mitten_rgbd", frame: 1, tuned: true },
  { name: "mitten_rgbd", frame: 14, tuned: false },
];
/** Rotations of the depth's viewpoint, degrees. */
const TURNS = [0, 20, 40];
/** Error of a given initial pose: a rotation about the sensor, and a shift. */
const OFF_DEGREES = 3;
const OFF_METRES = 0.02;

const captureCell = ({ name, frame, tuned }, turned, told) => ({
  id: `rgbd/${name}/${frame ?? 1}/${turned}/${told ? "told" : "search"}`,
  kind: "capture",
  row: { name: frame ? `${name} ${frame}` : name, turned, start: told ? "told" : "search", tuned },
  capture: { name, frame: frame ?? 1 },
  turned,
  off: told ? { degrees: OFF_DEGREES, metres: OFF_METRES } : null,
  options: FROM_ANYWHERE,
});

export const rgbd = {
  name: "rgbd",
  title:
    "Registered RGB-D captures, depth map rendered from further left: initial pose 3 degrees and 20 mm off, and nothing known",
  cells: ({ complete }, quick) => {
    if (!complete) return [];
    const [captures, turns] = quick ? [CAPTURES.slice(3, 4), [20]] : [CAPTURES, TURNS];
    return captures.flatMap((capture) =>
      turns.flatMap((turned) => [true, false].map((told) => captureCell(capture, turned, told))),
    );
  },
};

const SCENES = 50;
const QUICK_SCENES = 2;
/** Errors of a given initial pose about the sensor, degrees; null: no initial pose. */
export const STARTS = [null, 1, 2, 4, 8];
/** The object's height and distance, metres; noise of its depth, metres. */
const HEIGHT = 0.2;
const DISTANCE = 0.8;
const DEPTH_NOISE = 0.0005;
const SIZE = { width: 160, height: 120 };

/** The members of a scene of two pinhole cameras, except its seed. */
export const PINHOLE = { size: SIZE, height: HEIGHT, distance: DISTANCE, noise: NOISE, depthNoise: DEPTH_NOISE };

const pinholeCell = (kit, seed, degrees) => ({
  id: `pinhole/${seed}/${degrees ?? "search"}`,
  kind: "pinhole",
  row: { scene: seed, start: degrees ?? "search" },
  kit,
  seed,
  ...PINHOLE,
  off: degrees === null ? null : { degrees, metres: 0 },
  options: FROM_ANYWHERE,
});

export const pinhole = {
  name: "pinhole",
  title:
    "Two pinhole cameras: 0.2 m at 0.8 m, 160x120, 0.5 mm of depth noise, 1 % of colour noise; nothing known, and initial poses rotated about the sensor",
  cells: (kit, quick) =>
    Array.from({ length: quick ? QUICK_SCENES : SCENES }, (_, index) => index + 1).flatMap((seed) =>
      (quick ? [null, 8] : STARTS).map((degrees) => pinholeCell(kit, seed, degrees)),
    ),
};
