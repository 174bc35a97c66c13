/**
 * What members of a file are called: names taken apart into words, and the phrases that say what a member is.
 *
 * Names are compared word by word, "cameraMatrix1", "camera_matrix_1" and "CAMERA-MATRIX 1" being the same; what is left of a name beside
 * the words of a phrase is the label of the camera or of the motion.
 */

/** Letters of a name that means anything here. */
const LONGEST_NAME = 80;
/** Names that are kept with their words. */
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
/** Matrices of 3x4 and 4x4 that are no motions: projections, and disparity to depth. */
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

/** Names come again and again: what `of` says of one is kept, for as many names as a file may have. */
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

/** What is left of some words without one of some phrases at their beginning or end; nothing where they have none. */
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

/** What the words of a name say of the numbers under it. */
export interface Attributes {
  /** Where a quaternion's w stands. */
  order?: "wxyz" | "xyzw";
  /** Three numbers of a rotation are angles about axes, or a vector. */
  kind?: "euler" | "vector";
  angle?: "degrees" | "radians";
  /** Metres per unit. */
  unit?: number;
}

const LENGTHS: Record<string, number> = {
  ...{ mm: 1e-3, millimeter: 1e-3, millimeters: 1e-3, millimetre: 1e-3, millimetres: 1e-3 },
  ...{ cm: 1e-2, centimeter: 1e-2, centimeters: 1e-2, centimetre: 1e-2, centimetres: 1e-2 },
  ...{ meter: 1, meters: 1, metre: 1, metres: 1 },
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
/** Names of rotations that say what their three numbers are. */
const VECTORS = /^(?:rvec|rotvec|rodrigues|axis)$/;

/** Metres per unit that a word like "mm" says. */
export const lengthOf = (word: string): number | undefined => {
  const name = word.trim().toLowerCase();
  if (name === "m") return 1;
  return Object.hasOwn(LENGTHS, name) ? LENGTHS[name] : undefined;
};
/** Degrees or radians, where a word says one of them. */
export const angleOf = (word: string): "degrees" | "radians" | undefined =>
  /^deg/i.test(word.trim()) ? "degrees" : /^rad/i.test(word.trim()) ? "radians" : undefined;

/** A name of a rotation or of a translation: its label, and what else its words say. */
export interface MotionName extends Attributes {
  label: string;
}

/** Frames by one letter each, as robotics papers name them: "Rcl" turns points of the LiDAR into the camera. */
const LETTERED = /^([RrTtPp])_?(?:([a-z])_?([a-z])|([A-Z])_?([A-Z]))$/;
/** .. and by capitals, as OKVIS and EuRoC write them. */
const CAPITALS: Record<string, string> = {
  ...{ B: "body", S: "sensor", C: "camera" },
  ...{ W: "world", G: "world", L: "lidar", I: "imu" },
};
const LETTERS: Record<string, string> = {
  ...{ c: "camera", l: "lidar", i: "imu", b: "body", w: "world", v: "vehicle", d: "depth", e: "ego", r: "radar" },
};

/** The frames of "Rcl", "T_ic" and the like. */
export function letteredFrames(name: string): { from: string; to: string } | undefined {
  const [, , to = "", from = "", above = "", below = ""] = LETTERED.exec(name) ?? [];
  const [target, source] = [LETTERS[to] ?? CAPITALS[above], LETTERS[from] ?? CAPITALS[below]];
  return target !== undefined && source !== undefined && target !== source ? { from: source, to: target } : undefined;
}

function motionName(name: string, phrases: string[][], letters: string): MotionName | undefined {
  const frames = letters.includes(name[0] ?? "") ? letteredFrames(name) : undefined;
  if (frames !== undefined) return { label: `${frames.from} to ${frames.to}` };
  const words = wordsOf(name);
  const isSaid = (word: string) => Object.hasOwn(ATTRIBUTES, word) || Object.hasOwn(LENGTHS, word);
  const said: Attributes = {};
  for (const word of words) {
    if (Object.hasOwn(ATTRIBUTES, word)) Object.assign(said, ATTRIBUTES[word]);
    if (Object.hasOwn(LENGTHS, word)) Object.assign(said, { unit: LENGTHS[word] });
    if (VECTORS.test(word)) said.kind ??= "vector";
  }
  if (words.join(" ").includes("rotation vector")) said.kind ??= "vector";
  if (words.includes("qvec")) said.order ??= "wxyz";
  const rest = words.filter((word) => !isSaid(word));
  if (phrases !== ROTATION && rest.length > 1 && rest.at(-1) === "m") {
    rest.pop();
    said.unit ??= 1;
  }
  const label = without(rest, phrases);
  if (label !== undefined) return { label, ...said };
  // "euler_deg" and "rpy" name a rotation without any other word.
  return phrases === ROTATION && said.kind === "euler" ? { label: rest.join(" "), ...said } : undefined;
}

export const rotationName = remembered((name) => motionName(name, ROTATION, "Rr"));
const translationNames = TRANSLATION.map((phrase) => remembered((name) => motionName(name, [phrase], "TtPp")));

/** The member that translates where the rotation with this label turns. */
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
/** Whether a name is one of translations. */
export const isTranslation = (name: string): boolean => translationNames.some((named) => named(name) !== undefined);

export const bare = remembered((name) =>
  name.length > LONGEST_NAME ? "" : name.toLowerCase().replace(/[^a-z0-9]/g, ""),
);

/** A member by one of its names, without regard to case and punctuation. */
export function member(node: Readonly<Record<string, unknown>>, ...names: string[]): unknown {
  for (const key in node) if (names.includes(bare(key))) return node[key];
  return undefined;
}

/** The member whose name is one of some phrases and this label. */
export function labelled(
  node: Readonly<Record<string, unknown>>,
  names: ((name: string) => string | undefined)[],
  label: string,
): { key: string; value: unknown } | undefined {
  for (const besides of names)
    for (const key of Object.keys(node)) if (besides(key) === label) return { key, value: node[key] };
  return undefined;
}
