/**
 * Names of members: their words, and the phrases that identify intrinsics, lenses, rotations and translations.
 *
 * Names are compared word by word, so that "cameraMatrix1", "camera_matrix_1" and "CAMERA-MATRIX 1" are the same. The words of a name that
 * are not those of its phrase are the label of the camera or of the motion.
 */

/** Largest number of letters of a name that is considered. */
const LONGEST_NAME = 80;
/** Largest number of names whose results are cached. */
const MOST_KEPT = 5000;

const INTRINSICS = [
  ["camera", "matrix"],
  ["intrinsics", "matrix"],
  ["intrinsic", "matrix"],
  ["intrinsic", "mat"],
  ["intrinsic", "parameters"],
  ["intrinsic", "params"],
  ["projection", "parameters"],
  ["camera", "intrinsics"],
  ["camera", "intrinsic"],
  ["cam", "matrix"],
  ["camera", "mat"],
  ["cameramat"],
  ["cameramatrix"],
  // mmdetection3d's "cam2img".
  ["cam", "2img"],
  ["intrinsics"],
  ["intrinsic"],
  ["mtx"],
  ["k"],
  ["m"],
  ["matrix"],
];
const LENS = [
  ["distortion", "coefficients"],
  ["distortion", "coefficient"],
  ["distortion", "coeffs"],
  ["distortion", "parameters"],
  ["distortion", "params"],
  ["distortion", "vector"],
  ["lens", "distortion"],
  ["dist", "coeffs"],
  ["dist", "coeff"],
  ["dist", "coefs"],
  ["dist", "coef"],
  ["distcoeffs"],
  ["distcoeff"],
  ["distortions"],
  ["disto"],
  ["distortion"],
  ["dist"],
  ["coeffs"],
  ["d"],
];
const ROTATION = [
  ["rotation", "matrix"],
  ["rotation", "mat"],
  ["rotation", "vector"],
  ["rotation", "quaternion"],
  ["rotation"],
  ["orientation"],
  ["quaternion"],
  ["quat"],
  ["qvec"],
  ["rot"],
  ["rvec"],
  ["rotvec"],
  ["rodrigues"],
  ["heading"],
  ["r"],
  ["q"],
];
const TRANSLATION = [
  ["translation", "vector"],
  ["translation", "matrix"],
  ["translation"],
  ["position"],
  ["trans"],
  ["tvec"],
  ["t"],
  ["pos"],
  ["xyz"],
  ["location"],
  ["p"],
];
/** Matrices of 3x4 and 4x4 that are not motions: projections, and disparity to depth. */
const NO_MOTION = [
  ["p"],
  ["q"],
  ["projection", "matrix"],
  ["projection"],
  ["disp", "to", "depth"],
  ["disparity", "to", "depth"],
  ["covariance"],
];

/** The words of a name. */
export function wordsOf(name: string): string[] {
  if (name.length > LONGEST_NAME) return [];
  return name
    .replace(/([a-z])([A-Z])/g, "$1 $2")
    .replace(/([A-Za-z])(\d)/g, "$1 $2")
    .toLowerCase()
    .split(/[^a-z0-9]+/)
    .filter((word) => word !== "");
}

/** The function `of` with a cache, because the same names are looked up many times. */
function remembered<T>(of: (name: string) => T): (name: string) => T {
  const known = new Map<string, T>();
  return (name) => {
    const found = known.get(name);
    if (found !== undefined || known.has(name)) return found as T;
    if (known.size > MOST_KEPT) known.clear();
    const value = of(name);
    known.set(name, value);
    return value;
  };
}

/** The words without the first phrase with which they begin or end; undefined without one. */
function without(words: string[], phrases: string[][]): string | undefined {
  for (const phrase of phrases) {
    const is = (some: string[]) => some.length === phrase.length && some.every((word, at) => word === phrase[at]);
    if (is(words.slice(0, phrase.length))) return words.slice(phrase.length).join(" ");
    if (is(words.slice(-phrase.length))) return words.slice(0, -phrase.length).join(" ");
  }
  return undefined;
}

const leftover = (phrases: string[][]): ((name: string) => string | undefined) =>
  remembered((name) => without(wordsOf(name), phrases));

export const isIntrinsics = leftover(INTRINSICS);
export const isNoMotion = leftover(NO_MOTION);
export const isLens = leftover(LENS);
export const lensNames = LENS.map((phrase) => leftover([phrase]));

/** Properties of numbers that the words of their name specify. */
export interface Attributes {
  /** The order of a quaternion. */
  order?: "wxyz" | "xyzw";
  /** Whether the three numbers of a rotation are Euler angles or a rotation vector. */
  kind?: "euler" | "vector";
  angle?: "degrees" | "radians";
  /** Metres per unit. */
  unit?: number;
}

const LENGTHS: Record<string, number> = {
  ...{ mm: 1e-3, millimeter: 1e-3, millimeters: 1e-3, millimetre: 1e-3, millimetres: 1e-3 },
  ...{ cm: 1e-2, centimeter: 1e-2, centimeters: 1e-2, centimetre: 1e-2, centimetres: 1e-2 },
  ...{ dm: 0.1, decimeter: 0.1, decimeters: 0.1, decimetre: 0.1, decimetres: 0.1 },
  ...{ meter: 1, meters: 1, metre: 1, metres: 1, inch: 0.0254, inches: 0.0254 },
};
const ATTRIBUTES: Record<string, Attributes> = {
  ...{ wxyz: { order: "wxyz" }, xyzw: { order: "xyzw" } },
  ...{
    deg: { angle: "degrees" },
    degs: { angle: "degrees" },
    degree: { angle: "degrees" },
    degrees: { angle: "degrees" },
  },
  ...{
    rad: { angle: "radians" },
    rads: { angle: "radians" },
    radian: { angle: "radians" },
    radians: { angle: "radians" },
  },
  ...{ euler: { kind: "euler" }, rpy: { kind: "euler" }, angles: {} },
};
/** Words for rotation vectors. */
const VECTORS = /^(?:rvec|rotvec|rodrigues|axis)$/;

/** Metres per unit of a word like "mm". */
export const lengthOf = (word: string): number | undefined => {
  const name = word.trim().toLowerCase();
  if (name === "m") return 1;
  return Object.hasOwn(LENGTHS, name) ? LENGTHS[name] : undefined;
};
/** The unit of angles that a word begins with. */
export const angleOf = (word: string): "degrees" | "radians" | undefined =>
  /^deg/i.test(word.trim()) ? "degrees" : /^rad/i.test(word.trim()) ? "radians" : undefined;

/** The name of a rotation or of a translation: its label, and what its other words specify. */
export interface MotionName extends Attributes {
  label: string;
}

/** Frames of one letter each, as in robotics papers: "Rcl" is the rotation from the LiDAR to the camera. */
const LETTERED = /^([RrTtPpX])_?(?:([a-z])_?([a-z])|([A-Z])_?([A-Z]))$/;
/** Frames in capitals, as in OKVIS, whose "T_SC" has the inertial sensor beside a camera, and in EuRoC, whose "T_BS" has any sensor. */
const CAPITALS: Record<string, string> = {
  ...{ B: "body", S: "sensor", C: "camera" },
  ...{ W: "world", G: "world", L: "lidar", I: "imu" },
};
const LETTERS: Record<string, string> = {
  ...{ c: "camera", l: "lidar", i: "imu", b: "body", w: "world", v: "vehicle", d: "depth", e: "ego", r: "radar" },
};

/** The cameras of a stereo pair: ORB-SLAM's "Tlr" carries points of the right camera into the left one. */
const SIDES: Record<string, string> = { l: "left", r: "right" };

/** Frames of ViSP's "cMo" and "eMc": camera, end effector, the robot's fixed frame, object, world. */
const VISP = /^([cefow])[MT]([cefow])$/;
const OF_VISP: Record<string, string> = { c: "camera", e: "gripper", f: "base", o: "object", w: "world" };

/** The frames of "Rcl", "T_ic", "cMo" and the like. */
export function letteredFrames(name: string): { from: string; to: string } | undefined {
  const [, into, of] = VISP.exec(name) ?? [];
  if (into !== of) return { from: OF_VISP[of ?? ""] ?? "", to: OF_VISP[into ?? ""] ?? "" };
  const [, , to = "", from = "", above = "", below = ""] = LETTERED.exec(name) ?? [];
  const pair = [SIDES[to || above.toLowerCase()], SIDES[from || below.toLowerCase()]];
  if (pair[0] !== undefined && pair[1] !== undefined && pair[0] !== pair[1]) return { from: pair[1], to: pair[0] };
  const named = (lower: string, upper: string, other: string) =>
    LETTERS[lower] ?? (upper === "S" && other === "C" ? "imu" : CAPITALS[upper]);
  const [target, source] = [named(to, above, below), named(from, below, above)];
  return target !== undefined && source !== undefined && target !== source ? { from: source, to: target } : undefined;
}

function motionName(name: string, phrases: string[][], letters: string): MotionName | undefined {
  const frames = letters.includes(name[0] ?? "") ? letteredFrames(name) : undefined;
  if (frames !== undefined) return { label: `${frames.from} to ${frames.to}` };
  const words = wordsOf(name);
  const isAttribute = (word: string) => Object.hasOwn(ATTRIBUTES, word) || Object.hasOwn(LENGTHS, word);
  const said: Attributes = {};
  for (const word of words) {
    if (Object.hasOwn(ATTRIBUTES, word)) Object.assign(said, ATTRIBUTES[word]);
    if (Object.hasOwn(LENGTHS, word)) Object.assign(said, { unit: LENGTHS[word] });
    if (VECTORS.test(word)) said.kind ??= "vector";
  }
  if (words.join(" ").includes("rotation vector")) said.kind ??= "vector";
  if (words.includes("qvec")) said.order ??= "wxyz";
  const rest = words.filter((word) => !isAttribute(word));
  if (phrases !== ROTATION && rest.length > 1 && rest.at(-1) === "m") {
    rest.pop();
    said.unit ??= 1;
  }
  const label = without(rest, phrases);
  if (label !== undefined) return { label, ...said };
  // "euler_deg" and "rpy" name a rotation even without another word.
  return phrases === ROTATION && said.kind === "euler" ? { label: rest.join(" "), ...said } : undefined;
}

export const rotationName = remembered((name) => motionName(name, ROTATION, "Rr"));
const translationNames = TRANSLATION.map((phrase) => remembered((name) => motionName(name, [phrase], "TtPp")));

/** The translation that belongs to the rotation with this label. */
export function translationOf(
  node: Readonly<Record<string, unknown>>,
  label: string,
): (MotionName & { key: string; value: unknown }) | undefined {
  for (const named of translationNames)
    for (const key of Object.keys(node)) {
      const name = named(key);
      if (name?.label === label) return { ...name, key, value: node[key] };
    }
  return undefined;
}
/** Whether a name is that of a translation. */
export const isTranslation = (name: string): boolean => translationNames.some((named) => named(name) !== undefined);

export const bare = remembered((name) =>
  name.length > LONGEST_NAME ? "" : name.toLowerCase().replace(/[^a-z0-9]/g, ""),
);

/** A member by one of its names, without regard to case and punctuation. */
export function member(node: Readonly<Record<string, unknown>>, ...names: string[]): unknown {
  for (const key in node) if (names.includes(bare(key))) return node[key];
  return undefined;
}

/** The member whose name consists of one of these phrases and this label. */
export function labelled(
  node: Readonly<Record<string, unknown>>,
  names: ((name: string) => string | undefined)[],
  label: string,
): { key: string; value: unknown } | undefined {
  for (const besides of names)
    for (const key of Object.keys(node)) if (besides(key) === label) return { key, value: node[key] };
  return undefined;
}
