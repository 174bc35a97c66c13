/**
 * What a reader of a product's calibration has found so far.
 *
 * A file with several cameras often has one whose lens is not known here. It costs that camera and not the file: it is named in a warning,
 * and only a file of which nothing is left is refused, with the reason of the first.
 */
import { BimodalError, badFile } from "../../errors.js";
import type { NamedCamera, NamedPose } from "../types.js";
import { type ReaderCode, type ReaderWarning, warning } from "../warnings.js";
import { type RawCamera, cameraOf } from "./cameras.js";
import { type Numbers, isNode } from "./numbers.js";
import { chained, inverseOf, poseOf, rotationOf } from "./poses.js";
import type { Calibration } from "./tree.js";

/** Cameras and poses of a file, as for the walk over its objects. */
const MOST_FOUND = 5000;

type Names = Omit<NamedPose, "pose">;
type Takes = NonNullable<NamedCamera["takes"]>;

export class Findings implements Calibration {
  readonly cameras: NamedCamera[] = [];
  readonly poses: NamedPose[] = [];
  readonly warnings: ReaderWarning[] = [];
  depthUnit?: number;
  #reason: unknown;

  warn(code: ReaderCode, message: string): void {
    this.warnings.push(warning(code, message));
  }

  /** What `read` finds; where it fails, a warning that names what was left out. */
  #attempt<T>(code: ReaderCode, what: string, read: () => T): T | undefined {
    if (this.cameras.length + this.poses.length > MOST_FOUND)
      throw badFile(`it holds more than ${MOST_FOUND} cameras and poses`);
    try {
      return read();
    } catch (error) {
      if (!(error instanceof BimodalError)) throw error;
      this.#reason ??= error;
      this.warn(code, `${what} was left out: ${error.message}.`);
      return undefined;
    }
  }

  /** Adds a camera, or a warning why it was left out. */
  camera(raw: RawCamera, takes?: Takes): NamedCamera | undefined {
    const found = this.#attempt("camera-left-out", `The camera "${raw.name ?? ""}"`, () =>
      cameraOf(raw, this.warnings),
    );
    if (found === undefined) return undefined;
    const camera = { ...found, ...(takes !== undefined && { takes }) };
    this.cameras.push(camera);
    return camera;
  }

  /** Adds the motion P_to = R P_from + t, in metres, or a warning why it was left out. */
  pose(rotation: Numbers, translation: Numbers, names: Names): NamedPose | undefined {
    const called = names.name ?? `from ${names.from} to ${names.to}`;
    const found = this.#attempt("pose-left-out", `The pose ${called}`, () => {
      if (translation.length !== 3 || !translation.every((value) => Number.isFinite(value) && Math.abs(value) < 1e9))
        throw badFile("a translation has three numbers");
      return { ...names, pose: poseOf(rotationOf(rotation, this.warnings), translation) };
    });
    if (found !== undefined) this.poses.push(found);
    return found;
  }

  /** Puts the way from one frame to another before all others, by a frame that both poses lead into. */
  relate(from: NamedPose | undefined, to: NamedPose | undefined): void {
    if (from?.from === undefined || to?.from === undefined) return;
    this.poses.unshift({
      ...{ name: `${to.from} from ${from.from}`, from: from.from, to: to.from },
      pose: chained(inverseOf(to.pose), from.pose),
    });
  }

  /** Itself, if it holds anything. */
  done(what: string): this {
    if (this.cameras.length + this.poses.length > 0) return this;
    if (this.#reason instanceof BimodalError) throw badFile(`it is ${what}, but ${this.#reason.message}`);
    throw badFile(`it is ${what}, but holds no camera and no pose`);
  }
}

/** Nine numbers of three rows, flat or in rows; nothing where there are not as many. */
export function flat(value: unknown, count: number): Numbers | undefined {
  if (!Array.isArray(value)) return undefined;
  const values = value.flat(2);
  return values.length === count && values.every((each) => typeof each === "number") ? values : undefined;
}

/** Three numbers of x, y and z, in a list or by name. */
export function vector(value: unknown): Numbers | undefined {
  if (isNode(value)) {
    const values = [value.x, value.y, value.z];
    return values.every((each) => typeof each === "number") ? (values as Numbers) : undefined;
  }
  return flat(value, 3);
}

/** A rotation's numbers and a shift of a matrix of 3x4 or 4x4, row by row. */
export const parted = (m: Numbers): [rotation: Numbers, translation: Numbers] => [
  [0, 1, 2, 4, 5, 6, 8, 9, 10].map((at) => m[at] ?? NaN),
  [3, 7, 11].map((at) => m[at] ?? NaN),
];

/** The rotation of a camera with the axes of OpenGL (y up, z backward) as one with ours (y down, z forward). */
export const ofOpenGL = (r: Numbers): Numbers => r.map((value, at) => (at % 3 === 0 ? value : -value));
