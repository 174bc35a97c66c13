/**
 * Cameras and motions in JSON, YAML and XML, whatever program wrote them: ROS, OpenCV, Open3D, Kalibr, RealSense, or by hand.
 *
 * A walk over all objects that knows them by the names and shapes of their members. Names are compared word by word, "cameraMatrix1",
 * "camera_matrix_1" and "CAMERA-MATRIX 1" being the same; what is left of a name beside the words that are known names the camera. Walks
 * are bounded in depth and in number of objects, which also bounds what aliases of YAML unfold to.
 */
import { badFile } from "../../errors.js";
import type { NamedCamera, NamedPose } from "../types.js";
import { type RawCamera, cameraOf } from "./cameras.js";
import { type Matrix, type Node, type Numbers, isNode, matrixOf, numberOf, transposed } from "./numbers.js";
import {
  chained,
  inverseOf,
  isLastRow,
  motion,
  motionOfMatrix,
  ofQuaternion,
  ofVector,
  rowsOfTwelve,
} from "./poses.js";
import { type ReaderWarning, warning } from "../warnings.js";

export interface Calibration {
  cameras: NamedCamera[];
  poses: NamedPose[];
  warnings: ReaderWarning[];
  /** Metres per stored unit of the depth maps beside it, where the file says it. */
  depthUnit?: number;
}

const MOST_NODES = 50_000;
const MOST_MEMBERS = 200_000;
/** Members of one object that is a camera or a motion; larger ones may hold some. */
const MOST_OWN = 300;
const MOST_DEPTH = 24;
/** Cameras and poses of a file. */
const MOST_FOUND = 5000;
/** Letters of a name that means anything here. */
const LONGEST_NAME = 80;

const INTRINSICS = [
  ["camera", "matrix"],
  ["intrinsic", "matrix"],
  ["camera", "intrinsics"],
  ["intrinsics"],
  ["intrinsic"],
  ["mtx"],
  ["k"],
  ["m"],
];
const LENS = [
  ["distortion", "coefficients"],
  ["distortion", "coeffs"],
  ["dist", "coeffs"],
  ["dist", "coeff"],
  ["distortion"],
  ["dist"],
  ["coeffs"],
  ["d"],
];
const ROTATION = [
  ["rotation", "matrix"],
  ["rotation", "vector"],
  ["rotation"],
  ["orientation"],
  ["quaternion"],
  ["rot"],
  ["rvec"],
  ["r"],
];
const TRANSLATION = [["translation", "vector"], ["translation"], ["position"], ["trans"], ["tvec"], ["t"]];
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
function wordsOf(name: string): string[] {
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
    if (known.size > MOST_FOUND) known.clear();
    const value = of(name);
    known.set(name, value);
    return value;
  };
}

/** What is left of a name without one of some phrases at its beginning or end; nothing where it has none. */
function leftover(phrases: string[][]): (name: string) => string | undefined {
  return remembered((name) => {
    const words = wordsOf(name);
    for (const phrase of phrases) {
      const is = (some: string[]) => some.length === phrase.length && some.every((word, at) => word === phrase[at]);
      if (is(words.slice(0, phrase.length))) return words.slice(phrase.length).join(" ");
      if (is(words.slice(-phrase.length))) return words.slice(0, -phrase.length).join(" ");
    }
    return undefined;
  });
}

const isIntrinsics = leftover(INTRINSICS);
const isRotation = leftover(ROTATION);
const isNoMotion = leftover(NO_MOTION);
const lensNames = LENS.map((phrase) => leftover([phrase]));
const translationNames = TRANSLATION.map((phrase) => leftover([phrase]));
const isLens = leftover(LENS);

const bare = remembered((name) => (name.length > LONGEST_NAME ? "" : name.toLowerCase().replace(/[^a-z0-9]/g, "")));

/** A member by one of its names, without regard to case and punctuation. */
function member(node: Node, ...names: string[]): unknown {
  for (const key in node) if (names.includes(bare(key))) return node[key];
  return undefined;
}

/** The member whose name is one of some phrases and this label. */
function labelled(
  node: Node,
  names: ((name: string) => string | undefined)[],
  label: string,
): { key: string; value: unknown } | undefined {
  for (const besides of names)
    for (const key of Object.keys(node)) if (besides(key) === label) return { key, value: node[key] };
  return undefined;
}

const textOf = (value: unknown): string | undefined =>
  typeof value === "string" && value !== "" ? value.slice(0, 200) : undefined;
const isLike = (value: number | undefined, to: number): boolean => value !== undefined && Math.abs(value - to) < 1e-6;

/** Nine numbers as a matrix of intrinsics, row by row, however they stood. */
function intrinsics(matrix: Matrix | undefined): Numbers | undefined {
  const values = matrix?.values;
  if (values?.length !== 9 || !isLike(values[8], 1)) return undefined;
  const isTriangle = (m: Numbers) => isLike(m[3], 0) && isLike(m[6], 0) && isLike(m[7], 0) && !isLike(m[0], 0);
  if (isTriangle(values))
    return isLike(values[2], 0) && isLike(values[5], 0) && isLike(values[0], 1) ? undefined : values;
  const turned = transposed(values, 3);
  return isTriangle(turned) ? turned : undefined;
}

interface Frames {
  from?: string;
  to?: string;
}

class Search implements Calibration {
  readonly cameras: NamedCamera[] = [];
  readonly poses: NamedPose[] = [];
  readonly warnings: ReaderWarning[] = [];
  #nodes = 0;
  #members = 0;

  walk(value: unknown, name: string, frames: Frames, depth: number): void {
    if (typeof value !== "object" || value === null) return;
    if (++this.#nodes > MOST_NODES) throw badFile(`it holds more than ${MOST_NODES} lists and objects`);
    if (depth > MOST_DEPTH) throw badFile(`it is nested deeper than ${MOST_DEPTH}`);
    if (this.cameras.length + this.poses.length > MOST_FOUND)
      throw badFile(`it holds more than ${MOST_FOUND} cameras and poses`);
    if (Array.isArray(value)) {
      if (typeof value[0] !== "object") return;
      for (const each of value) this.walk(each, name, frames, depth + 1);
      return;
    }
    const node = value as Node;
    const keys = Object.keys(node);
    this.#members += keys.length;
    if (this.#members > MOST_MEMBERS) throw badFile(`its objects have more than ${MOST_MEMBERS} members`);
    const inner = keys.length > MOST_OWN ? frames : this.#read(node, name, frames);
    for (const [group, members] of dotted(node, keys)) this.walk(members, group, frames, depth + 1);
    for (const key of keys)
      if (matrixOf(node[key]) === undefined) this.walk(node[key], nameOf(key, name), inner, depth + 1);
  }

  /** The cameras and motions that are members of this object, and the frames that it names. */
  #read(node: Node, name: string, frames: Frames): Frames {
    const before = this.cameras.length;
    this.#cameraOf(node, name);
    const [first, second, ...more] = this.cameras.slice(before);
    // OpenCV's stereo calibration: R and T carry points of camera 1 into camera 2. Of other names the order says nothing.
    const stereo = first?.name === "1" && second?.name === "2" && more.length === 0 ? { from: "1", to: "2" } : frames;
    const inner = this.#framesOf(node) ?? stereo;
    this.#motionsOf(node, name, inner);
    return inner;
  }

  #add(raw: RawCamera): void {
    this.cameras.push(cameraOf(raw, this.warnings));
  }

  #cameraOf(node: Node, parent: string): void {
    const name = textOf(member(node, "cameraname")) ?? (parent === "" ? undefined : parent);
    const [fx, cx] = [numberOf(member(node, "fx")), numberOf(member(node, "cx", "ppx"))];
    if (fx !== undefined && cx !== undefined) {
      const [fy, cy] = [numberOf(member(node, "fy")), numberOf(member(node, "cy", "ppy"))];
      if (fy === undefined || cy === undefined) throw badFile("it has a camera of fx and cx without fy and cy");
      return this.#add({ name, focal: [fx, fy], centre: [cx, cy], ...this.#rest(node, "") });
    }
    const kalibr = textOf(member(node, "cameramodel"));
    const four = matrixOf(member(node, "intrinsics"))?.values;
    if (kalibr !== undefined && four !== undefined) {
      if (kalibr !== "pinhole")
        throw badFile(
          `its camera "${name ?? ""}" is of Kalibr's model "${kalibr.slice(0, 40)}"; only pinhole is known here`,
        );
      if (four.length !== 4)
        throw badFile(`its camera "${name ?? ""}" has ${four.length} intrinsics; fu fv pu pv are needed`);
      return this.#add({ name, focal: four.slice(0, 2), centre: four.slice(2), ...this.#rest(node, "") });
    }
    for (const key of Object.keys(node)) this.#cameraOfMatrix(node, key, name);
  }

  #cameraOfMatrix(node: Node, key: string, parent: string | undefined): void {
    const label = isIntrinsics(key);
    if (label === undefined) return;
    const matrix = matrixOf(node[key]);
    const k = intrinsics(matrix);
    if (k === undefined) {
      if (matrix?.values.length === 9 && label === "" && key !== "M")
        throw badFile(`its ${key} is no matrix of intrinsics, fx 0 cx / 0 fy cy / 0 0 1`);
      return;
    }
    const [fx = NaN, skew = 0, cx = NaN, , fy = NaN, cy = NaN] = k;
    this.#add({
      name: label === "" ? parent : label,
      focal: [fx, fy],
      centre: [cx, cy],
      skew,
      ...this.#rest(node, label),
    });
  }

  /** Distortion, model and size of the camera with this label. */
  #rest(node: Node, label: string): Pick<RawCamera, "distortion" | "model" | "width" | "height"> {
    const written = labelled(node, lensNames, label)?.value ?? member(node, "distk1k2p1p2k3");
    const singles = ["k1", "k2", "p1", "p2", "k3", "k4", "k5", "k6"].map((key) => numberOf(member(node, key)));
    const isFisheye = numberOf(member(node, "fisheyemodel")) === 1 || member(node, "fisheye") === true;
    const model = isFisheye
      ? "fisheye"
      : (textOf(member(node, "distortionmodel", "lensmodel", "lens")) ?? textOf(member(node, "model")));
    const fisheye = [0, 1, 4, 5].map((index) => singles[index]);
    const listed = isNode(written) && written.data === undefined ? undefined : matrixOf(written)?.values;
    if (
      written !== undefined &&
      !isNode(written) &&
      listed === undefined &&
      !isEmpty(written) &&
      typeof written !== "string"
    )
      throw badFile("its distortion is not made of numbers");
    if (singles.some((value) => value !== undefined) && listed === undefined) {
      const used = /fisheye|kannala|equi/i.test(model ?? "") ? fisheye : singles;
      return { distortion: used.map((value) => value ?? 0), model, ...sizeOf(node, label) };
    }
    return { distortion: listed, model, ...sizeOf(node, label) };
  }

  /** ROS: the transform carries points of the child frame into the parent. */
  #framesOf(node: Node): Frames | undefined {
    const child = textOf(member(node, "childframeid", "childframe"));
    const header = member(node, "header");
    const parent = textOf(member(isNode(header) ? header : node, "frameid", "parentframe"));
    return child === undefined ? undefined : { from: child, ...(parent !== undefined && { to: parent }) };
  }

  #motionsOf(node: Node, parent: string, frames: Frames): void {
    for (const key of Object.keys(node)) {
      const label = isRotation(key);
      if (label !== undefined) this.#motionOfPair(node, key, label, parent, frames);
      this.#motionOfMatrix(node, key, parent, frames);
    }
    const quaternion = ["qx", "qy", "qz", "qw"].map((key) => numberOf(member(node, key)));
    const shift = ["x", "y", "z"].map((key) => numberOf(member(node, key, `t${key}`)));
    if (quaternion.every((value) => value !== undefined) && shift.every((value) => value !== undefined)) {
      this.poses.push(motion(ofQuaternion(quaternion, this.warnings), shift, named(parent, frames), this.warnings));
    }
  }

  #motionOfPair(node: Node, key: string, label: string, parent: string, frames: Frames): void {
    const other = labelled(node, translationNames, label);
    if (other === undefined) return;
    const [r, t] = [parts(node[key], ["x", "y", "z", "w"]), parts(other.value, ["x", "y", "z"])];
    if (r === undefined || t === undefined) return;
    const name = label === "" ? parent : label;
    const own = named(label.replace(/ /g, "_"), {});
    const names = own.from === undefined ? named(name, frames) : own;
    const say = (rotation: Numbers) => this.poses.push(motion(rotation, t.values, names, this.warnings));
    if (t.values.length !== 3) throw badFile(`its ${other.key} has ${t.values.length} numbers, not three`);
    // RealSense writes these two names, flat, and its rotations column by column.
    const isRealSense = key === "rotation" && r.rows === undefined && r.values.length === 9;
    if (r.values.length === 9) say(isRealSense ? transposed(r.values, 3) : r.values);
    else if (r.values.length === 4) say(ofQuaternion(r.values, this.warnings));
    else if (r.values.length === 3) say(ofVector(r.values));
    else
      throw badFile(
        `its ${key} has ${r.values.length} numbers: 9 of a matrix, 4 of a quaternion or 3 of a vector are needed`,
      );
  }

  #motionOfMatrix(node: Node, key: string, parent: string, frames: Frames): void {
    if (isNoMotion(key) !== undefined) return;
    const matrix = matrixOf(node[key]);
    const length = matrix?.values.length;
    if (matrix === undefined || (length !== 16 && length !== 12) || isLens(key) === "") return;
    if (length === 12 && matrix.rows !== 3) return this.#motionOfTwelve(matrix.values, key, frames);
    const isOpen3D = key === "extrinsic" || key === "pose";
    const names = isOpen3D
      ? named(parent, key === "extrinsic" ? { from: "world", to: "camera" } : { from: "camera", to: "world" })
      : (this.#kalibr(key, parent) ?? named(key, frames));
    const isFlat = matrix.rows === undefined && length === 16;
    const byColumns =
      isFlat &&
      (isOpen3D ||
        (!isLastRow(matrix.values.slice(12)) && isLastRow([3, 7, 11, 15].map((index) => matrix.values[index] ?? NaN))));
    const values = byColumns ? transposed(matrix.values, 4) : matrix.values;
    this.poses.push(motionOfMatrix(values, names, this.warnings, !isOpen3D));
  }

  /** A list without rows, as programs dump what librealsense gives. */
  #motionOfTwelve(values: Numbers, key: string, frames: Frames): void {
    const found = rowsOfTwelve(values);
    if (found === undefined) return;
    this.poses.push(motionOfMatrix(found.rows, named(key, frames), this.warnings));
    if (found.isByColumns)
      this.warnings.push(
        warning(
          "pose-assumed",
          `The twelve numbers of "${key}" were read as a rotation column by column and a translation, as librealsense keeps them; nothing in the file says so.`,
        ),
      );
  }

  /** Kalibr's names, where cn is the camera that the matrix stands in, cnm1 the one before. */
  #kalibr(key: string, parent: string): Omit<NamedPose, "pose"> | undefined {
    const number = /^cam(\d+)$/.exec(parent)?.[1];
    if (number === undefined) return undefined;
    const before = `cam${Number(number) - 1}`;
    if (key === "T_cn_cnm1") return { name: `${parent} from ${before}`, from: before, to: parent };
    if (key === "T_cam_imu") return { name: `${parent} from imu`, from: "imu", to: parent };
    return undefined;
  }

  /** Of cameras that are each related to the same inertial unit, the motion from one to the next. */
  chain(): void {
    for (const { from, to, pose } of [...this.poses]) {
      const next = /^cam(\d+)$/.exec(to ?? "")?.[1];
      if (from !== "imu" || next === undefined) continue;
      const before = this.poses.find((other) => other.from === "imu" && other.to === `cam${Number(next) - 1}`);
      if (
        before?.to === undefined ||
        to === undefined ||
        this.poses.some((other) => other.from === before.to && other.to === to)
      )
        continue;
      this.poses.unshift({
        name: `${to} from ${before.to}`,
        from: before.to,
        to,
        pose: chained(pose, inverseOf(before.pose)),
      });
    }
  }
}

/** Members that are named "Camera.fx", as ORB-SLAM writes them, by what stands before the dot. */
function dotted(node: Node, keys: string[]): Map<string, Node> {
  const groups = new Map<string, Node>();
  for (const key of keys) {
    const [, group, name] = /^(\w{1,40})\.(\w{1,40})$/.exec(key) ?? [];
    if (group === undefined || name === undefined) continue;
    groups.set(group, { ...groups.get(group), [name]: node[key] });
    if (groups.size > MOST_OWN) break;
  }
  return groups;
}

/** What a member's cameras and poses are called: members that only say what they are take their parent's name. */
const nameOf = (key: string, parent: string): string =>
  /^(transforms?|intrinsics?|pose|opencv_storage|launch|parameters|ros__parameters|nodes)$/.test(key) ? parent : key;

const isEmpty = (value: unknown): boolean =>
  value === null || value === "" || (Array.isArray(value) && value.length === 0);

/** A list or matrix, or an object of x, y, z and w. */
function parts(value: unknown, axes: string[]): Matrix | undefined {
  if (!isNode(value) || value.data !== undefined) return matrixOf(value);
  const values = axes.map((axis) => numberOf(value[axis]));
  return values.every((each) => each !== undefined) ? { values } : undefined;
}

function sizeOf(node: Node, label: string): { width?: number; height?: number } {
  const both = matrixOf(member(node, "resolution", "imagesize", "size"))?.values;
  if (both?.length === 2) return { width: both[0] ?? 0, height: both[1] ?? 0 };
  const side = (...names: string[]) =>
    numberOf(member(node, ...names.flatMap((name) => (label === "" ? [name] : [`${name}${label}`, name]))));
  const [width, height] = [side("imagewidth", "width"), side("imageheight", "height")];
  return { ...(width !== undefined && { width }), ...(height !== undefined && { height }) };
}

/** Frames from a name: "depth_to_color", "color_from_depth", "T_color_depth". */
function named(name: string, frames: Frames): Omit<NamedPose, "pose"> {
  if (frames.from !== undefined || frames.to !== undefined) return { ...(name !== "" && { name }), ...frames };
  if (name === "") return {};
  const towards = /^(?:T_)?([a-z0-9]+)_?(?:_to_|2(?=[a-z]))_?([a-z0-9]+)$/i.exec(name);
  if (towards) return { name, from: towards[1] ?? "", to: towards[2] ?? "" };
  const backwards = /^(?:T_)?([a-z0-9]+)_from_([a-z0-9]+)$/i.exec(name) ?? /^T_([a-z0-9]+)_([a-z0-9]+)$/i.exec(name);
  if (backwards) return { name, from: backwards[2] ?? "", to: backwards[1] ?? "" };
  return { name };
}

export function searchTree(value: unknown): Calibration {
  const search = new Search();
  search.walk(value, "", {}, 0);
  search.chain();
  return search;
}
