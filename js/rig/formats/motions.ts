/** The motions among the members of an object: rotations with their translations, and matrices. A warning names those that were not read. */
import { badFile } from "../../errors.js";
import type { NamedCamera, NamedPose } from "../types.js";
import { type ReaderWarning, warning } from "../warnings.js";
import { type PoseNames, isFirstEstimate, isOfWorld, mentionsTwo, named, worldFrames } from "./ends.js";
import {
  type Attributes,
  type MotionName,
  angleOf,
  isLens,
  isNoMotion,
  member,
  rotationName,
  translationOf,
} from "./names.js";
import { PROJECTION, forColumns, intrinsicsOf4x4, isProjection } from "./blocks.js";
import type { Context } from "./context.js";
import { isOfGroup } from "./groups.js";
import { checkLength } from "./lengths.js";
import { lookForward } from "./forward.js";
import { TRANSFORM, isPoseLike } from "./pose-like.js";
import { kalibr, productFrames } from "./product-frames.js";
import type { Signs } from "./signs.js";
import { type Matrix, type Node, type Numbers, isNode, matrixOf, numberOf, transposed } from "./numbers.js";
import {
  chained,
  degreesOf,
  inverseOf,
  isLastRow,
  isRotation,
  motion,
  motionOfMatrix,
  ofQuaternion,
  parted,
  poseOf,
} from "./poses.js";
import { type Turn, numbersAsRotation, ofFour, ofNine, ofThree, orderWarning } from "./turns.js";

/** Largest number of unused poses that warnings name. */
const FEW = 4;
/** Tolerances within which two motions of a file are inverse, degrees and metres. */
const AGREES = { degrees: 0.02, metres: 1e-3 };
/** Largest deviation from 1 of the length of a quaternion in a list of seven numbers. */
const QUATERNION_TOLERANCE = 1e-2;
const at = (values: Numbers, index: number): number => values[index] ?? NaN;

/** The numbers of a list, a matrix, or an object with these members. */
function parts(value: unknown, names: string[]): Matrix | undefined {
  if (!isNode(value) || value.data !== undefined) return matrixOf(value);
  const values = names.map((name) => numberOf(member(value, name)));
  return values.every((each) => each !== undefined) ? { values } : undefined;
}

export class Motions {
  readonly poses: NamedPose[] = [];
  /** Poses with rotations whose order of rows and columns was assumed. */
  readonly #open = new Map<NamedPose, "rows" | "columns">();
  readonly #unused: string[] = [];
  /** Poses whose matrices were for row vectors. */
  readonly #turned = new Set<NamedPose>();
  /** Poses of a rig whose unit the file does not state. */
  readonly #unitless: NamedPose[] = [];
  /** The names of the objects around poses. */
  readonly #parents = new Map<NamedPose, string>();
  /** Poses that, by the definition of a format, lead into the world. */
  readonly #defined = new Set<NamedPose>();
  readonly #signs: Signs;
  readonly #warnings: ReaderWarning[];

  constructor(signs: Signs, warnings: ReaderWarning[]) {
    this.#signs = signs;
    this.#warnings = warnings;
  }

  /** Adds the motions of an object. With `isCamera` it has a camera, whose rotation and projection belong to the rectification. */
  read(node: Node, parent: string, context: Context, isCamera: boolean): void {
    const used = new Set<string>();
    const before = this.poses.length;
    for (const key of Object.keys(node)) {
      // Members of a group are read when the walk reaches their group.
      if (isOfGroup(node, key)) continue;
      const name = rotationName(key);
      if (name !== undefined && this.#pair(node, key, name, parent, context)) {
        used.add(key);
        const other = translationOf(node, name.label);
        if (other !== undefined) used.add(other.key);
      }
      if (this.#matrix(node, key, parent, context)) used.add(key);
    }
    this.#members(node, parent, context);
    this.#dropRowVectors(before);
    for (const pose of this.poses.slice(before)) this.#parents.set(pose, parent);
    const rectifies = isCamera || Object.keys(node).some((key) => isNoMotion(key) !== undefined);
    for (const key of Object.keys(node))
      if (!used.has(key) && !isOfGroup(node, key) && isPoseLike(key, node[key], rectifies)) this.#unused.push(key);
  }

  /** Drops rotations for row vectors that stand beside a matrix for row vectors, as in MATLAB's rigid3d, which has both. */
  #dropRowVectors(first: number): void {
    const all = this.poses.splice(first);
    const isTwin = ({ pose }: NamedPose) =>
      all.some((other) => {
        const back = transposed(other.pose.rotation, 3);
        return (
          this.#turned.has(other) && back.every((value, index) => Math.abs(value - at(pose.rotation, index)) < 1e-6)
        );
      });
    this.poses.push(...all.filter((pose) => this.#turned.has(pose) || !isTwin(pose)));
  }

  #add(found: NamedPose): NamedPose {
    this.poses.push(found);
    return found;
  }

  /** Adds the motion of an object whose members are x, y, z or a translation, and the numbers of a quaternion or angles. */
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
    const isOpen = unit === undefined && !isOfWorld(names);
    const found = motion(rotation, metres, names, this.#warnings, isOpen);
    if (isOpen) this.#unitless.push(found);
    return found;
  }

  /** Adds the motion of a rotation and its translation; false where they are not one. */
  #pair(node: Node, key: string, name: MotionName, parent: string, context: Context): boolean {
    const other = translationOf(node, name.label);
    if (other === undefined) return false;
    const r = this.#rotationParts(node[key]);
    const t = parts(other.value, ["x", "y", "z"]);
    if (r === undefined || t === undefined) return false;
    // A single letter may also name a projection or a disparity matrix.
    if (/^[qp]$/i.test(key) && r.values.length !== 4) return false;
    if (/^p/i.test(other.key) && t.values.length !== 3) return false;
    if (t.values.length !== 3) throw badFile(`its ${other.key} has ${t.values.length} numbers, not three`);
    const own = { ...named(name.label.replace(/ /g, "_"), {}), ...productFrames(key, other.key, this.#signs) };
    const around = context.from === undefined ? { ...context, ...worldFrames(other.key) } : context;
    const names = own.from === undefined ? named(name.label === "" ? parent : name.label, around) : own;
    const isNamedAsRealSense = key === "rotation" && other.key === "translation";
    const angle = name.angle ?? context.angle;
    const said: Attributes = { ...name, ...r.said, ...(angle !== undefined && { angle }) };
    const { rotation, assumed } = this.#turn(r, said, key, {
      isNamedAsRealSense,
      isAtRoot: parent === "",
      isOfWorld: isOfWorld(names),
    });
    const unit = other.unit ?? name.unit ?? context.unit;
    const found = this.#add(this.#motion(rotation, t.values, names, unit));
    if (assumed !== undefined) this.#open.set(found, assumed);
    return true;
  }

  /** The numbers of a rotation, and the properties that the names of its members specify. */
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
    around: { isNamedAsRealSense: boolean; isAtRoot: boolean; isOfWorld: boolean },
  ): Turn {
    // Poses of a camera in the world are not used, so that their readings need no warnings.
    const warnings = around.isOfWorld ? [] : this.#warnings;
    const kind = numbersAsRotation(values, key);
    if (kind === "quaternion") {
      const order = said.order ?? this.#signs.order;
      return { rotation: ofFour(values, { ...said, ...(order !== undefined && { order }) }, key, warnings) };
    }
    if (kind === "three") {
      // A matrix of three numbers is a rotation vector of OpenCV.
      const as: Attributes = isMatrix ? { ...said, kind: said.kind ?? "vector" } : said;
      return { rotation: ofThree(values, as, key, warnings) };
    }
    const { isNamedAsRealSense, isAtRoot } = around;
    return ofNine(values, { rows, isMatrix, isNamedAsRealSense, isAtRoot, isRealSense: this.#signs.isRealSense });
  }

  /** Adds the motion of a matrix; false where it is not one. */
  #matrix(node: Node, key: string, parent: string, context: Context): boolean {
    if (isNoMotion(key) !== undefined) return false;
    const matrix = matrixOf(node[key]);
    const length = matrix?.values.length;
    if (matrix !== undefined && length === 7) return this.#seven(matrix.values, key, context);
    if (matrix === undefined || (length !== 16 && length !== 12) || isLens(key) === "") return false;
    if (intrinsicsOf4x4(matrix.values) !== undefined) return false;
    if (length === 12 && matrix.rows !== 3)
      return matrix.rows === undefined && this.#twelve(matrix.values, key, context);
    const isLast = [matrix.values.slice(12), [3, 7, 11, 15].map((index) => at(matrix.values, index))].map(isLastRow);
    // SUSTechPOINTS has the same name, row by row.
    const isByRows = isLast[0] === true && isLast[1] === false;
    const isOpen3D = (key === "extrinsic" || key === "pose") && matrix.rows === undefined && !isByRows;
    const names = isOpen3D
      ? named(parent, key === "extrinsic" ? { from: "world", to: "camera" } : { from: "camera", to: "world" })
      : (kalibr(key, parent) ?? named(key, worldFrames(key) ?? context));
    const isFlat = matrix.rows === undefined && length === 16;
    const byColumns = isFlat && (isOpen3D || (isLast[0] === false && isLast[1] === true));
    if (isProjection(matrix.values)) {
      this.#warnings.push(warning("pose-left-out", `"${key}" ${PROJECTION}.`, { name: key, isProjection: true }));
      return true;
    }
    const values = byColumns
      ? transposed(matrix.values, 4)
      : forColumns(matrix.values, key, isOfWorld(names) ? [] : this.#warnings);
    if (!TRANSFORM.test(key) && kalibr(key, parent) === undefined && !isRotation(parted(values)[0])) return false;
    const metres =
      context.unit === undefined
        ? values
        : values.map((value, index) => (index % 4 === 3 && index < 12 ? value * (context.unit ?? 1) : value));
    const isUnitless = context.unit === undefined && !isOfWorld(names);
    const found = this.#add(motionOfMatrix(metres, names, this.#warnings, isUnitless));
    if (isUnitless) this.#unitless.push(found);
    if (!byColumns && values !== matrix.values) this.#turned.add(found);
    if (isOpen3D) this.#defined.add(found);
    return true;
  }

  /** Adds the motion of a list with a translation and a quaternion. */
  #seven(values: Numbers, key: string, context: Context): boolean {
    const quaternion = values.slice(3);
    if (!TRANSFORM.test(key) || Math.abs(Math.hypot(...quaternion) - 1) > QUATERNION_TOLERANCE) return false;
    const names = named(key, worldFrames(key) ?? context);
    const order = this.#signs.order;
    const rotation = ofFour(quaternion, order === undefined ? {} : { order }, key, this.#warnings);
    this.#add(this.#motion(rotation, values.slice(0, 3), names, context.unit));
    return true;
  }

  /** Adds the motion of a list of twelve numbers: three rows of four, or a rotation and a translation. */
  #twelve(values: Numbers, key: string, context: Context): boolean {
    const names = named(key, worldFrames(key) ?? context);
    const [block, shift] = parted(values);
    if (isRotation(block)) this.#add(this.#motion(block, shift, names, context.unit));
    else if (isRotation(values.slice(0, 9))) {
      // This is the layout of librealsense's extrinsics.
      const rotation = transposed(values.slice(0, 9), 3);
      this.#open.set(this.#add(this.#motion(rotation, values.slice(9), names, context.unit)), "columns");
    } else return false;
    return true;
  }

  /** Resolves what depends on the whole file: the order of rotations, the frames, and the warnings. */
  finish(cameras: readonly NamedCamera[], own: readonly NamedPose[]): void {
    this.#dropReference(cameras);
    // If several cameras have one pose each, these are poses in the world.
    const each = own.filter((pose) => this.poses.includes(pose));
    if (each.length > 1)
      for (const pose of each)
        if (pose.from === undefined && pose.to === undefined) Object.assign(pose, { from: "world", to: "camera" });
    for (const pose of this.#open.keys()) this.#checkOrder(pose);
    for (const [pose, order] of this.#open) this.#warnings.push(orderWarning(pose.name ?? "", order));
    for (const pose of this.poses) {
      this.#nameExtrinsic(pose);
      lookForward(pose, `${this.#parents.get(pose) ?? ""} ${pose.name ?? ""}`, this.#warnings);
      this.#checkDirection(pose);
    }
    // ARKit's transforms are poses of the camera in the world.
    if (this.#signs.isARKit) this.placeInWorld(0);
    // All poses in the world lead into it, so that they are not mistaken for extrinsics.
    for (const pose of this.poses)
      if (pose.from === "world" && pose.to !== undefined && !this.#defined.has(pose))
        Object.assign(pose, { from: pose.to, to: "world", pose: inverseOf(pose.pose) });
    const ofWorld = this.poses.filter((pose) => isOfWorld(pose) && !this.#defined.has(pose));
    const [first] = ofWorld;
    if (first !== undefined)
      this.#warnings.push(
        warning(
          "camera-to-world",
          `"${first.name ?? "its pose"}"${ofWorld.length > 1 ? ` and ${ofWorld.length - 1} more are poses` : " is a pose"} of the camera in the world (camera to world), which ${ofWorld.length > 1 ? "were" : "was"} not used as extrinsics between two cameras.`,
          { poses: ofWorld.length },
        ),
      );
    for (const pose of this.#unitless) if (!isOfWorld(pose)) checkLength(pose, this.#warnings);
    this.#rankEstimates();
    this.#countUnnamed();
    for (const key of [...new Set(this.#unused)].slice(0, FEW))
      this.#warnings.push(warning("pose-left-out", `"${key}" looks like a pose and was not used.`, { name: key }));
  }

  /** Of several poses without frames, only one could be the pose between the cameras. */
  #countUnnamed(): void {
    const unnamed = this.poses.filter(({ from, to }) => from === undefined && to === undefined);
    if (unnamed.length < 2) return;
    const names = unnamed.slice(0, FEW).map(({ name = "" }) => `"${name}"`);
    this.#warnings.push(
      warning(
        "pose-assumed",
        `The file has ${unnamed.length} poses without the names of their frames (${names.join(", ")}). Each was read as leading from the depth camera or the LiDAR to the colour camera; keep the one that does, and name it depth_to_color or lidar_to_camera.`,
        { poses: unnamed.length },
      ),
    );
  }

  /** If there are several poses between the same frames, first estimates come last; each is also named after the object around it. */
  #rankEstimates(): void {
    const calledOf = (pose: NamedPose) => `${this.#parents.get(pose) ?? ""} ${pose.name ?? ""}`.trim();
    const hasOther = (pose: NamedPose) =>
      this.poses.some((other) => other !== pose && other.from === pose.from && other.to === pose.to);
    const several = this.poses.filter((pose) => pose.from !== undefined && !isOfWorld(pose) && hasOther(pose));
    const names = new Map(several.map((pose) => [pose, calledOf(pose)]));
    const alike = several.filter((pose) => several.some((other) => other !== pose && other.name === pose.name));
    for (const pose of alike) pose.name = names.get(pose) ?? "";
    const isFirst = (pose: NamedPose) => isFirstEstimate(names.get(pose) ?? "");
    const [some, all] = [several.some(isFirst), several.every(isFirst)];
    if (!some || all) return;
    this.poses.sort((a, b) => Number(isFirst(a)) - Number(isFirst(b)));
    const left = several.filter(isFirst).map(({ name = "" }) => `"${name}"`);
    this.#warnings.push(
      warning(
        "pose-assumed",
        `The file has several poses between the same frames; ${left.slice(0, FEW).join(", ")} ${left.length > 1 ? "have the names of first estimates and come" : "has the name of a first estimate and comes"} after the others.`,
      ),
    );
  }

  /** Turns poses without frames into poses of the camera in the world, starting at this index. */
  placeInWorld(first: number): void {
    for (const pose of this.poses.slice(first))
      if (pose.from === undefined && pose.to === undefined) Object.assign(pose, { from: "camera", to: "world" });
  }

  /** Drops the identity under a camera's name, which only marks that camera as the reference of the others. */
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

  /** Warns if a name mentions two frames and the direction of the pose is not clear. */
  #checkDirection({ name = "", from, to }: NamedPose): void {
    if (from !== undefined || to !== undefined || !mentionsTwo(name)) return;
    this.#warnings.push(
      warning(
        "pose-assumed",
        `"${name}" names two frames, but its direction is not clear. It was read as leading to the colour camera; name it depth_to_color, lidar_to_camera or the like.`,
        { name },
      ),
    );
  }

  /** Decides between rows and columns if the file has the inverse motion as well. */
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

  /** Names the frames of FAST-LIO's "extrinsic_R" (LiDAR to inertial unit) and of VINS's "extrinsicRotation" (camera to inertial unit). */
  #nameExtrinsic(pose: NamedPose): void {
    if (pose.from !== undefined || pose.to !== undefined || !this.#signs.hasImu) return;
    if (!/^extrinsic|^extrin/i.test(pose.name ?? "")) return;
    Object.assign(pose, { from: this.#signs.hasLidar ? "lidar" : "camera", to: "imu" });
  }
}

const agrees = ({ rotation, translation }: NamedPose["pose"]): boolean =>
  degreesOf(rotation) < AGREES.degrees && Math.hypot(...translation) < AGREES.metres;
