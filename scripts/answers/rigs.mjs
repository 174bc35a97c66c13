// Scenes of rendered rigs whose calibration is checked: candidates that are right and wrong, fewer cues, an unknown camera, masks.
import { chance, wrong } from "../rigs/draws.mjs";

/** Errors of candidates: degrees about the colour camera, and millimetres. */
const LITTLE = { little: { degrees: 0.5, millimetres: 5 } };
const FAR = { far: { degrees: 3, millimetres: 40 } };
const AS_IT_IS = { degrees: 0, millimetres: 0 };
/**
 * Depth of the end of the object, in metres; everything nearer belongs to it. Its image mask covers its projected points and their
 * neighbouring pixels.
 */
const OBJECT = 1.2;
const BESIDE = 3;

const rig = (kind, seed, off, rest = {}) => ({ kind, seed, off, ...rest });

export const RIGS = [
  { name: "rig of objects: the true calibration, and one far off", rig: rig("objects", 1, { true: AS_IT_IS, ...FAR }) },
  { name: "rig of objects: one far off, and one a little", rig: rig("objects", 4, { ...FAR, ...LITTLE }) },
  { name: "rig of a sheet: one a little off, two frames", rig: rig("sheet", 1, LITTLE, { frames: 2 }) },
  { name: "rig of boxes: the true calibration", rig: rig("boxes", 1, { true: AS_IT_IS, ...LITTLE }) },
  {
    name: "rig of boxes by edges and information alone",
    rig: rig("boxes", 5, FAR, { cues: ["edges", "information"] }),
  },
  { name: "rig of a room: one far off", rig: rig("room", 1, { ...FAR, true: AS_IT_IS }) },
  {
    name: "rig of a room without the image's camera",
    rig: rig("room", 4, { true: AS_IT_IS, ...LITTLE }, { isGuessed: true }),
  },
  {
    name: "rig of objects with masks, by silhouettes and edges",
    rig: rig("objects", 7, { true: AS_IT_IS, ...LITTLE }, { cues: ["silhouette", "edges"], isMasked: true }),
  },
];

/** The frame with masks of the near object, as a user who knows the rig would draw them. */
async function masked(frame, { projectFrame }) {
  const { width, height } = frame.image;
  const unit = frame.depth.unit ?? 0.001;
  const mask = Uint8Array.from(frame.depth.data, (value) => Number(value > 0 && value * unit < OBJECT));
  const depth = { ...frame.depth, mask };
  const { points } = await projectFrame({ ...frame, depth }, frame.pose);
  const object = new Uint8Array(width * height);
  for (let first = 0; first < points.length; first += 3) {
    const [left, top] = [points[first], points[first + 1]].map((value) => Math.round(value) - BESIDE);
    for (let row = Math.max(top, 0); row <= Math.min(top + 2 * BESIDE, height - 1); row++) {
      object.fill(1, row * width + Math.max(left, 0), row * width + Math.min(left + 2 * BESIDE + 1, width));
    }
  }
  return { ...frame, image: { ...frame.image, mask: object }, depth };
}

async function frameOf({ kind, seed, isGuessed, isMasked }, frame, api) {
  const made = await api.sampleRig({ kind, seed, frame });
  const whole = isMasked ? await masked(made, api) : made;
  if (!isGuessed) return whole;
  const { camera: _, ...image } = whole.image;
  return { ...whole, image };
}

/** The check of a scene's rig, and its input. */
export async function checkOf(request, api) {
  const { seed, off, cues, frames: count = 1 } = request;
  const frames = [];
  for (let frame = 0; frame < count; frame++) frames.push(await frameOf(request, frame, api));
  const { direction } = chance(seed);
  const candidates = Object.fromEntries(
    Object.entries(off).map(([name, error]) => [name, wrong(frames[0].pose, error, direction)]),
  );
  const report = await api.checkCalibration(frames, candidates, cues ? { cues } : {});
  return { frames, report };
}
