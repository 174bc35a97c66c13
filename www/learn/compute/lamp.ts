/** What the lessons with one lamp share: its direction, matte surfaces under it, lines of equal intensity. */

import { shadeLamp, type Relief } from "../../../pkg/index.js";
import { contour } from "../../draw/contours";
import { ballNormals } from "../../engine/ball";
import type { ImagePanel, Mark, Values } from "../protocol";
import { pictureOf } from "./draw";
import { normalAt, numberOf, scene } from "./scenes";

/** Side of the pictures of these lessons, px. */
export const SIDE = 256;

export interface Shape {
  width: number;
  height: number;
  mask: Uint8Array;
  normals: Float32Array;
  depth: Float32Array;
}

/** A built-in surface seen from the front by its true normals and depths, or a ball. */
export function shapeNamed(name: string, side = SIDE): Shape {
  return name === "ball" ? ball(side) : shapeOf(name, side);
}

export function shapeOf(surface: string | Relief, side = SIDE, key = ""): Shape {
  const { truth } = scene({ surface, light: "overcast", size: side, angles: { beta: 0 } }, key);
  const normals = truth.imageNormals;
  return { width: side, height: side, normals, depth: truth.imageDepth, mask: maskOf(normals) };
}

const maskOf = (normals: Float32Array): Uint8Array =>
  Uint8Array.from({ length: normals.length / 3 }, (_, index) => (Number.isFinite(normals[3 * index]) ? 1 : 0));

/** Radius of the ball as a share of half the picture. */
export const BALL = 0.92;

/** A ball whose radius is this share of half the picture. */
export function ball(side: number, share = BALL): Shape {
  const normals = ballNormals(side, share);
  const radius = (share * side) / 2;
  const depth = Float32Array.from({ length: side * side }, (_, index) => radius * (normals[3 * index + 2] ?? NaN));
  return { width: side, height: side, normals, depth, mask: maskOf(normals) };
}

/** The unit vector to the lamp, whose sliders are its parts to the right and down. */
export const lampOf = (values: Values): [number, number, number] =>
  normalAt(numberOf(values, "lx"), numberOf(values, "ly"));

export const intensities = (lamp: ArrayLike<number>, { normals }: Shape): Float32Array => shadeLamp(lamp, normals);

/** Grey as a picture of three equal colours. */
export const grey = (values: Float32Array): Float32Array =>
  Float32Array.from({ length: 3 * values.length }, (_, at) => values[Math.floor(at / 3)] ?? NaN);

/** A grey picture in which an intensity of 1 is white. */
export const shaded = (
  words: Parameters<typeof pictureOf>[0],
  shape: Shape,
  values: Float32Array,
  marks: Mark[] = [],
): ImagePanel => pictureOf(words, shape, grey(values), marks, 1);

/** Lines of equal intensity, and one of them in the colour of intensities. */
export function isophotes(values: Float32Array, { width, height }: Shape, levels: number[], chosen?: number): Mark[] {
  const line = (level: number) => contour(values, width, height, level);
  return [
    { ink: "isophote", shape: "line", points: levels.flatMap(line), isFine: true },
    ...(chosen === undefined ? [] : [{ ink: "intensity", shape: "line", points: line(chosen) } as const]),
  ];
}

/** A place of the ball's picture, as shares of its sides, for a direction. */
export const onBall = (direction: ArrayLike<number>): [number, number] => [
  (1 + BALL * (direction[0] ?? 0)) / 2,
  (1 + BALL * (direction[1] ?? 0)) / 2,
];

/** The angle, in degrees, whose cosine this is. */
export const degreesOf = (cosine: number): number => (180 / Math.PI) * Math.acos(Math.min(1, Math.max(-1, cosine)));
