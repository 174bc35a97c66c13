/**
 * Clouds in a robot's axes (x forward, z up). A camera's axes are x right, y down, z forward, and depth is along z. If the cloud's sensor
 * and the colour camera look in the same direction, the transform between them shows which axis is which; the points are then rotated by
 * it, and the transform is rotated back.
 */
import { determinant } from "../../matrices.js";
import { chained, inverseOf, poseOf } from "../formats/poses.js";
import type { NamedPose } from "../types.js";

/** A rotation by right angles: nine numbers, of which three are 1 or -1. */
export type Turn = readonly number[];

const IDENTITY = [1, 0, 0, 0, 1, 0, 0, 0, 1];

/** The rotation by right angles nearest to a rotation; undefined if that is the identity, or if the rotation lies between two. */
export function turnOf(rotation: readonly number[]): Turn | undefined {
  const turn = new Array<number>(9).fill(0);
  for (let row = 0; row < 3; row++) {
    const values = [0, 1, 2].map((column) => rotation[3 * row + column] ?? 0);
    const largest = values.reduce((best, value, at) => (Math.abs(value) > Math.abs(values[best] ?? 0) ? at : best), 0);
    turn[3 * row + largest] = Math.sign(values[largest] ?? 0);
  }
  const isWhole = Math.abs(determinant(turn) - 1) < 1e-9;
  return isWhole && turn.some((value, at) => value !== IDENTITY[at]) ? turn : undefined;
}

/** The points in the turned axes. */
export function turned(points: Float32Array, turn: Turn): Float32Array {
  const found = new Float32Array(points.length);
  for (let row = 0; row < 3; row++) {
    // Each coordinate comes from a single column, so that a missing one does not spread through a factor of zero.
    const column = [0, 1, 2].findIndex((each) => turn[3 * row + each] !== 0);
    const sign = turn[3 * row + column] ?? 0;
    for (let at = 0; at < points.length; at += 3) found[at + row] = sign * (points[at + column] ?? NaN);
  }
  return found;
}

/** The motion for points that were turned. */
export const ofTurned = ({ pose, ...names }: NamedPose, turn: Turn): NamedPose => ({
  ...names,
  pose: chained(pose, inverseOf(poseOf([...turn], [0, 0, 0]))),
});
