/**
 * The cameras and poses that a reader of a product's calibration has found so far.
 *
 * A camera with an unsupported lens is left out with a warning, and the others of the file are kept. Only a file without any camera or pose
 * is refused, for the reason of the first that was left out.
 */
import { BimodalError, badFile } from "../../errors.js";
import type { NamedCamera, NamedPose } from "../types.js";
import { type ReaderCode, type ReaderWarning, warning } from "../warnings.js";
import { type RawCamera, cameraOf } from "./cameras.js";
import { MOST_FOUND } from "./limits.js";
import { type Numbers, isNode } from "./numbers.js";
import { chained, inverseOf, poseOf, rotationOf } from "./poses.js";
import type { Calibration } from "./tree.js";

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

  /** The result of `read`; if it throws, adds a warning that `what` was left out. */
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

  /** Adds a camera; one that cannot be read is left out with a warning. */
  camera(raw: RawCamera, takes?: Takes): NamedCamera | undefined {
    const found = this.#attempt("camera-left-out", `The camera "${raw.name ?? ""}"`, () =>
      cameraOf(raw, this.warnings),
    );
    if (found === undefined) return undefined;
    const camera = { ...found, ...(takes !== undefined && { takes }) };
    this.cameras.push(camera);
    return camera;
  }

  /** Adds the motion P_to = R P_from + t, in metres; one that cannot be read is left out with a warning. */
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

  /** Adds a pose in front of the others: the one between the origins of two poses, both of which lead into the same frame. */
  relate(from: NamedPose | undefined, to: NamedPose | undefined): void {
    if (from?.from === undefined || to?.from === undefined) return;
    this.poses.unshift({
      ...{ name: `${to.from} from ${from.from}`, from: from.from, to: to.from },
      pose: chained(inverseOf(to.pose), from.pose),
    });
  }

  /** The findings, if there is a camera or a pose; `what` names the format in the error. */
  done(what: string): this {
    if (this.cameras.length + this.poses.length > 0) return this;
    if (this.#reason instanceof BimodalError) throw badFile(`it is ${what}, but ${this.#reason.message}`);
    throw badFile(`it is ${what}, but holds no camera and no pose`);
  }
}

/** This many numbers, flat or in rows; undefined if the value has another count. */
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

/** A camera's rotation from OpenGL's axes (y up, z backward) to those of OpenCV (y down, z forward). */
export const ofOpenGL = (r: Numbers): Numbers => r.map((value, at) => (at % 3 === 0 ? value : -value));
