/** The motions that are members of one object: rotations beside translations, matrices, and what looks like one and is not read. */
import { badFile } from "../../errors.js";
import type { NamedCamera, NamedPose } from "../types.js";
import { type ReaderWarning, warning } from "../warnings.js";
import { type Frames, type PoseNames, isOfWorld, named, worldFrames } from "./ends.js";
import {
  type Attributes,
  type MotionName,
  angleOf,
  isLens,
  isNoMotion,
  isTranslation,
  lengthOf,
  member,
  rotationName,
  translationOf,
  wordsOf,
} from "./names.js";
import { type Matrix, type Node, type Numbers, isNode, matrixOf, numberOf, transposed } from "./numbers.js";
import { chained, inverseOf, isLastRow, motion, motionOfMatrix, ofQuaternion, poseOf } from "./poses.js";
import { degreesOf, numbersAsRotation, ofFour, ofNine, ofThree, orderWarning } from "./turns.js";

/** What the text of a file and the objects around a motion say of it. */
export interface Context extends Frames {
  /** Metres per unit. */
  unit?: number;
  angle?: "degrees" | "radians";
}

/** Signs in the text of a whole file. */
export interface Signs {
  isRealSense: boolean;
  order: "wxyz" | "xyzw" | undefined;
  hasImu: boolean;
  hasLidar: boolean;
  isARKit: boolean;
}
export function signsOf(text: string): Signs {
  const first = /\bw[ ,]+x[ ,]+y[ ,]+z\b|wxyz/i.test(text);
  const last = /\bx[ ,]+y[ ,]+z[ ,]+w\b|xyzw/i.test(text);
  return {
    isRealSense: /realsense|\bppx\b|brown[ _]conrady|"coeffs"/i.test(text),
    order: first === last ? undefined : first ? "wxyz" : "xyzw",
    hasImu: /imu/i.test(text),
    isARKit: /trackingState|\bAR(?:Kit|Frame|Camera)|cameraPoseARFrame|worldMappingStatus|"columns"\s*:\s*\[/i.test(
      text,
    ),
    hasLidar: /lid(?:ar)?_|lidar|livox|velodyne/i.test(text),
  };
}

/** Unused poses that are named one by one. */
const FEW = 4;
/** Inverse motions of one file agree within this: degrees and metres. */
const AGREES = { degrees: 0.02, metres: 1e-3 };
/** A rotation block off by more than this is none. */
const ROTATION_TOLERANCE = 1e-2;
/** Names of transformations; a matrix of another name that is no motion is something else. */
const TRANSFORM = /^T_|(?:_to_|_from_|2)[a-z]|transform|extrinsic|pose/i;
/** Lists of what was seen of boards and the like. */
const SERIES =
  /^(?:rvecs|tvecs|rotations|translations|poses|extrinsics|transforms|rotation vectors|translation vectors)$/;

const at = (values: Numbers, index: number): number => values[index] ?? NaN;

/** Whether nine numbers are a rotation, to the digits of a file. */
function isRotation(r: Numbers): boolean {
  if (r.length !== 9) return false;
  let off = 0;
  for (let i = 0; i < 3; i++)
    for (let j = i; j < 3; j++) {
      const dot = [0, 1, 2].reduce((sum, k) => sum + at(r, 3 * i + k) * at(r, 3 * j + k), 0);
      off = Math.max(off, Math.abs(dot - (i === j ? 1 : 0)));
    }
  return off <= ROTATION_TOLERANCE;
}
const block = (m: Numbers): Numbers => [0, 1, 2, 4, 5, 6, 8, 9, 10].map((index) => at(m, index));

/** A list or matrix, or an object of members by these names. */
function parts(value: unknown, names: string[]): Matrix | undefined {
  if (!isNode(value) || value.data !== undefined) return matrixOf(value);
  const values = names.map((name) => numberOf(member(value, name)));
  return values.every((each) => each !== undefined) ? { values } : undefined;
}

/** Units that members of an object say for all beside them. */
export function contextOf(node: Node, frames: Context): Context {
  const said = member(node, "unit", "units", "lengthunit", "lengthunits", "translationunit", "translationunits");
  const turned = member(node, "angleunit", "angleunits", "rotationunit", "rotationunits", "unit", "units");
  const word = (value: unknown, ...names: string[]) => {
    const each = isNode(value) ? member(value, ...names) : value;
    return typeof each === "string" ? each : "";
  };
  const unit = lengthOf(word(said, "translation", "length", "position", "t"));
  const angle = angleOf(word(turned, "rotation", "angle", "angles", "r"));
  return { ...frames, ...(unit !== undefined && { unit }), ...(angle !== undefined && { angle }) };
}

export class Motions {
  readonly poses: NamedPose[] = [];
  /** Whose rotations may stand column by column: nothing says which. */
  readonly #open = new Map<NamedPose, string>();
  readonly #unused: string[] = [];
  /** Poses that a format defines as those in a world. */
  readonly #defined = new Set<NamedPose>();
  readonly #signs: Signs;
  readonly #warnings: ReaderWarning[];

  constructor(signs: Signs, warnings: ReaderWarning[]) {
    this.#signs = signs;
    this.#warnings = warnings;
  }

  /** Adds the motions of an object; `isCamera`: cameras of it have rotations and projections that rectify. */
  read(node: Node, parent: string, context: Context, isCamera: boolean): void {
    const used = new Set<string>();
    for (const key of Object.keys(node)) {
      const name = rotationName(key);
      if (name !== undefined && this.#pair(node, key, name, parent, context)) {
        used.add(key);
        const other = translationOf(node, name.label);
        if (other !== undefined) used.add(other.key);
      }
      if (this.#matrix(node, key, parent, context)) used.add(key);
    }
    this.#members(node, parent, context);
    const rectifies = isCamera || Object.keys(node).some((key) => isNoMotion(key) !== undefined);
    for (const key of Object.keys(node))
      if (!used.has(key) && isPoseLike(key, node[key], rectifies)) this.#unused.push(key);
  }

  #add(found: NamedPose): NamedPose {
    this.poses.push(found);
    return found;
  }

  /** A quaternion or angles whose numbers are members, beside x, y and z or a translation. */
  #members(node: Node, parent: string, context: Context): void {
    const numbers = (...names: string[][]) => names.map((each) => numberOf(member(node, ...each)));
    const isWhole = (values: (number | undefined)[]): values is Numbers => values.every((value) => value !== undefined);
    const listed = parts(translationOf(node, "")?.value, ["x", "y", "z"])?.values;
    const shift = listed?.length === 3 ? listed : numbers(["x", "tx"], ["y", "ty"], ["z", "tz"]);
    if (!isWhole(shift)) return;
    const quaternion = numbers(["qx"], ["qy"], ["qz"], ["qw"]);
    const angles = numbers(
      ["roll", "rolldeg", "rollrad"],
      ["pitch", "pitchdeg", "pitchrad"],
      ["yaw", "yawdeg", "yawrad"],
    );
    const names = named(parent, context);
    if (isWhole(quaternion)) {
      const rotation = ofQuaternion(quaternion, this.#warnings);
      this.#add(this.#motion(rotation, shift, names, context.unit));
    } else if (isWhole(angles)) {
      const angle = angleOf(
        Object.keys(node)
          .find((key) => /deg|rad/i.test(key))
          ?.replace(/^.*?(deg|rad)/i, "$1") ?? "",
      );
      const said: Attributes = {
        kind: "euler",
        ...((angle ?? context.angle) && { angle: angle ?? context.angle }),
      } as Attributes;
      const rotation = ofThree(angles, said, "roll, pitch, yaw", this.#warnings);
      this.#add(this.#motion(rotation, shift, names, context.unit));
    }
  }

  #motion(rotation: Numbers, translation: Numbers, names: PoseNames, unit: number | undefined): NamedPose {
    const metres = unit === undefined ? translation : translation.map((value) => value * unit);
    return motion(rotation, metres, names, this.#warnings, unit === undefined && !isOfWorld(names));
  }

  /** Whether the rotation under this key and its translation are a motion. */
  #pair(node: Node, key: string, name: MotionName, parent: string, context: Context): boolean {
    const other = translationOf(node, name.label);
    if (other === undefined) return false;
    const r = this.#rotationParts(node[key]);
    const t = parts(other.value, ["x", "y", "z"]);
    if (r === undefined || t === undefined) return false;
    // Single letters are also those of projections and of disparity.
    if (/^[qp]$/i.test(key) && r.values.length !== 4) return false;
    if (/^p/i.test(other.key) && t.values.length !== 3) return false;
    if (t.values.length !== 3) throw badFile(`its ${other.key} has ${t.values.length} numbers, not three`);
    const own = named(name.label.replace(/ /g, "_"), {});
    const around = context.from === undefined ? { ...context, ...worldFrames(other.key) } : context;
    const names = own.from === undefined ? named(name.label === "" ? parent : name.label, around) : own;
    const isNamedAsRealSense = key === "rotation" && other.key === "translation";
    const angle = name.angle ?? context.angle;
    const said: Attributes = { ...name, ...r.said, ...(angle !== undefined && { angle }) };
    const { rotation, isOrderOpen, isByColumns } = this.#turn(r, said, key, {
      isNamedAsRealSense,
      parent,
      isOfWorld: isOfWorld(names),
    });
    const unit = other.unit ?? name.unit ?? context.unit;
    const found = this.#add(this.#motion(rotation, t.values, names, unit));
    if (isOrderOpen) this.#open.set(found, isByColumns ? "columns" : "rows");
    return true;
  }

  /** The numbers of a rotation, and what the names of its members say of them. */
  #rotationParts(value: unknown): (Matrix & { said: Attributes; isMatrix: boolean }) | undefined {
    const isMatrix = isNode(value) && value.data !== undefined;
    const four = parts(value, ["x", "y", "z", "w"]) ?? parts(value, ["qx", "qy", "qz", "qw"]);
    if (four !== undefined) return { ...four, isMatrix, said: isNode(value) && !isMatrix ? { order: "xyzw" } : {} };
    const angles = parts(value, ["roll", "pitch", "yaw"]);
    if (angles !== undefined) return { ...angles, isMatrix, said: { kind: "euler" } };
    const three = parts(value, ["x", "y", "z"]);
    return three && { ...three, isMatrix, said: {} };
  }

  #turn(
    { values, rows, isMatrix }: Matrix & { isMatrix: boolean },
    said: Attributes,
    key: string,
    around: { isNamedAsRealSense: boolean; parent: string; isOfWorld: boolean },
  ): { rotation: Numbers; isOrderOpen?: boolean; isByColumns: boolean } {
    const { isNamedAsRealSense, parent } = around;
    // Nobody checks where a camera stood.
    const warnings = around.isOfWorld ? [] : this.#warnings;
    const kind = numbersAsRotation(values, key);
    if (kind === "quaternion") {
      const order = said.order ?? this.#signs.order;
      const rotation = ofFour(values, { ...said, ...(order !== undefined && { order }) }, key, warnings);
      return { rotation, isByColumns: false };
    }
    if (kind === "three") {
      // OpenCV's matrices of three numbers are those of Rodrigues.
      const as: Attributes = isMatrix ? { ...said, kind: said.kind ?? "vector" } : said;
      return { rotation: ofThree(values, as, key, warnings), isByColumns: false };
    }
    // A message of realsense-ros has these two members and no name around them.
    const isMessage = parent === "" && rows === undefined;
    const layout = { rows, isMatrix, isNamedAsRealSense, isRealSense: this.#signs.isRealSense };
    const turn = ofNine(values, layout);
    if (isMessage && isNamedAsRealSense && !this.#signs.isRealSense)
      return { rotation: transposed(values, 3), isOrderOpen: turn.isOrderOpen === true, isByColumns: true };
    return { ...turn, isByColumns: false };
  }

  /** Whether the matrix under this key is a motion. */
  #matrix(node: Node, key: string, parent: string, context: Context): boolean {
    if (isNoMotion(key) !== undefined) return false;
    const matrix = matrixOf(node[key]);
    const length = matrix?.values.length;
    if (matrix !== undefined && length === 7) return this.#seven(matrix.values, key, context);
    if (matrix === undefined || (length !== 16 && length !== 12) || isLens(key) === "") return false;
    if (length === 12 && matrix.rows !== 3)
      return matrix.rows === undefined && this.#twelve(matrix.values, key, context);
    const isOpen3D = (key === "extrinsic" || key === "pose") && matrix.rows === undefined;
    const names = isOpen3D
      ? named(parent, key === "extrinsic" ? { from: "world", to: "camera" } : { from: "camera", to: "world" })
      : (kalibr(key, parent) ?? named(key, worldFrames(key) ?? context));
    const isFlat = matrix.rows === undefined && length === 16;
    const byColumns =
      isFlat &&
      (isOpen3D ||
        (!isLastRow(matrix.values.slice(12)) && isLastRow([3, 7, 11, 15].map((index) => at(matrix.values, index)))));
    const values = byColumns ? transposed(matrix.values, 4) : matrix.values;
    if (!TRANSFORM.test(key) && kalibr(key, parent) === undefined && !isRotation(block(values))) return false;
    const metres =
      context.unit === undefined
        ? values
        : values.map((value, index) => (index % 4 === 3 && index < 12 ? value * (context.unit ?? 1) : value));
    const found = this.#add(
      motionOfMatrix(metres, names, this.#warnings, context.unit === undefined && !isOfWorld(names)),
    );
    if (isOpen3D) this.#defined.add(found);
    return true;
  }

  /** A translation and a quaternion in one list. */
  #seven(values: Numbers, key: string, context: Context): boolean {
    const quaternion = values.slice(3);
    if (!TRANSFORM.test(key) || Math.abs(Math.hypot(...quaternion) - 1) > ROTATION_TOLERANCE) return false;
    const names = named(key, worldFrames(key) ?? context);
    const order = this.#signs.order;
    const rotation = ofFour(quaternion, order === undefined ? {} : { order }, key, this.#warnings);
    this.#add(this.#motion(rotation, values.slice(0, 3), names, context.unit));
    return true;
  }

  /** Twelve numbers in a row: three rows of four, or a rotation before its translation. */
  #twelve(values: Numbers, key: string, context: Context): boolean {
    const names = named(key, worldFrames(key) ?? context);
    if (isRotation(block(values))) {
      const shift = [3, 7, 11].map((index) => at(values, index));
      this.#add(this.#motion(block(values), shift, names, context.unit));
    } else if (isRotation(values.slice(0, 9))) {
      // As librealsense keeps its extrinsics.
      const rotation = transposed(values.slice(0, 9), 3);
      this.#open.set(this.#add(this.#motion(rotation, values.slice(9), names, context.unit)), "columns");
    } else return false;
    return true;
  }

  /** What only the whole file tells: rotations by their inverses, frames by what else it names, and the warnings. */
  finish(cameras: readonly NamedCamera[], own: readonly NamedPose[]): void {
    this.#dropReference(cameras);
    // Where several cameras have a pose each, these relate them to a world and not to each other.
    const each = own.filter((pose) => this.poses.includes(pose));
    if (each.length > 1)
      for (const pose of each)
        if (pose.from === undefined && pose.to === undefined) Object.assign(pose, { from: "world", to: "camera" });
    for (const pose of this.#open.keys()) this.#checkOrder(pose);
    for (const [pose, order] of this.#open) this.#warnings.push(orderWarning(pose.name ?? "", order === "columns"));
    for (const pose of this.poses) this.#nameExtrinsic(pose);
    // ARKit's transforms are those of the camera in its world.
    if (this.#signs.isARKit) this.placeInWorld(0);
    // So that nobody takes them for extrinsics, they all lead into the world.
    for (const pose of this.poses)
      if (pose.from === "world" && pose.to !== undefined && !this.#defined.has(pose))
        Object.assign(pose, { from: pose.to, to: "world", pose: inverseOf(pose.pose) });
    const ofWorld = this.poses.filter((pose) => isOfWorld(pose) && !this.#defined.has(pose));
    const [first] = ofWorld;
    if (first !== undefined)
      this.#warnings.push(
        warning(
          "camera-to-world",
          `"${first.name ?? "its pose"}"${ofWorld.length > 1 ? ` and ${ofWorld.length - 1} more say` : " says"} where the camera stood in the world (camera to world): no pose between two cameras, and not taken for one.`,
          { poses: ofWorld.length },
        ),
      );
    for (const key of [...new Set(this.#unused)].slice(0, FEW))
      this.#warnings.push(warning("pose-left-out", `"${key}" looks like a pose and was not used.`, { name: key }));
  }

  /** Poses from this one on that say no frames are where a camera stood. */
  placeInWorld(first: number): void {
    for (const pose of this.poses.slice(first))
      if (pose.from === undefined && pose.to === undefined) Object.assign(pose, { from: "camera", to: "world" });
  }

  /** The identity under a camera's name says that all others are related to this one: it relates no two cameras. */
  #dropReference(cameras: readonly NamedCamera[]): void {
    const isReference = ({ name, from, to, pose }: NamedPose) =>
      from === undefined &&
      to === undefined &&
      cameras.some((camera) => camera.name === name && name !== undefined) &&
      degreesOf(pose.rotation) === 0 &&
      pose.translation.every((value) => value === 0);
    if (cameras.length < 2) return;
    const kept = this.poses.filter((pose) => !isReference(pose));
    for (const { name = "" } of this.poses.filter(isReference)) this.#unused.push(name);
    this.poses.splice(0, this.poses.length, ...kept);
  }

  /** Where the way back is in the file, too, the two have to be inverse: rows or columns then follow. */
  #checkOrder(pose: NamedPose): void {
    const other = this.poses.find(({ from, to }) => from !== undefined && from === pose.to && to === pose.from);
    if (other === undefined || !this.#open.has(other)) return;
    const turned = ({ pose: { rotation, translation } }: NamedPose) => poseOf(transposed(rotation, 3), translation);
    const isInverse = agrees(chained(pose.pose, other.pose));
    if (isInverse === agrees(chained(turned(pose), turned(other)))) return;
    if (!isInverse) for (const each of [pose, other]) each.pose = turned(each);
    this.#open.delete(pose);
    this.#open.delete(other);
  }

  /** FAST-LIO's "extrinsic_R" leads from the LiDAR, VINS's "extrinsicRotation" from the camera, both into the inertial unit. */
  #nameExtrinsic(pose: NamedPose): void {
    if (pose.from !== undefined || pose.to !== undefined || !this.#signs.hasImu) return;
    if (!/^extrinsic|^extrin/i.test(pose.name ?? "")) return;
    Object.assign(pose, { from: this.#signs.hasLidar ? "lidar" : "camera", to: "imu" });
  }
}

const agrees = ({ rotation, translation }: NamedPose["pose"]): boolean =>
  degreesOf(rotation) < AGREES.degrees && Math.hypot(...translation) < AGREES.metres;

/** Kalibr's names, where cn is the camera that the matrix stands in, cnm1 the one before. */
function kalibr(key: string, parent: string): PoseNames | undefined {
  const number = /^cam(\d+)$/.exec(parent)?.[1];
  if (number === undefined) return undefined;
  const before = `cam${Number(number) - 1}`;
  if (key === "T_cn_cnm1") return { name: `${parent} from ${before}`, from: before, to: parent };
  if (key === "T_cam_imu") return { name: `${parent} from imu`, from: "imu", to: parent };
  return undefined;
}

/** Whether a member that was not read looks like a pose. */
function isPoseLike(key: string, value: unknown, rectifies: boolean): boolean {
  const words = wordsOf(key).join(" ");
  const isMatrix = (each: unknown) => [12, 16].includes(matrixOf(each)?.values.length ?? 0);
  if (SERIES.test(words))
    return Array.isArray(value) && value.length > 0 && !value.every(isMatrix) && !value.some(isNode);
  if (/rect|essential|fundamental|homography/.test(words) || isNoMotion(key) !== undefined) return false;
  const values = matrixOf(value)?.values;
  if (values === undefined) return false;
  if (values.length === 16 || values.length === 12) return isRotation(block(values));
  if ((values.length === 6 || values.length === 7) && TRANSFORM.test(key)) return true;
  // A camera's R rectifies, and so does the identity under any name.
  const isIdentity = values.length === 9 && values.every((each, index) => each === (index % 4 === 0 ? 1 : 0));
  if (rectifies && isIdentity) return false;
  if (rotationName(key) !== undefined && !/^[qr]\d*$/i.test(key))
    return values.length === 9 ? isRotation(values) : values.length === 4 || values.length === 3;
  if (rotationName(key) !== undefined) return !rectifies && values.length === 9 && isRotation(values);
  return values.length === 3 && isTranslation(key) && !/^[pt]\d*$/i.test(key);
}
