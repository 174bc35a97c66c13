/** The orders of the image model as balls that add up, and curves that show why nine numbers are enough. */

import { shadeNormals } from "../../../pkg/index.js";
import { ballNormals } from "../../engine/ball";
import { LARGEST_CONSTANT, type Drawing, type Mark, type Values } from "../protocol";
import { curveNumbers, plotOfDegrees, plotOfLamp } from "./cosine";
import { brightest, onDisc, pictureOf } from "./draw";
import { rms } from "./measure";
import { lightNamed, normalAt, numberOf, ofOrder } from "./scenes";

const SIDE = 192;
const GRID = { width: SIDE, height: SIDE };
const normals = ballNormals(SIDE);
const TITLES = ["Order 0", "Order 1", "Order 2"] as const;

/**
 * log S of one order; order 0 gives a constant to the squares of order 2, which add up to 1.
 */
function part(light: Float64Array, order: 0 | 1 | 2, constant: number, of: Float32Array): Float32Array {
  const values = shadeNormals(ofOrder(light, order), of);
  if (order === 1) return values;
  return values.map((value, at) => {
    const from = 3 * Math.floor(at / 3);
    const square = (of[from] ?? NaN) ** 2 + (of[from + 1] ?? NaN) ** 2 + (of[from + 2] ?? NaN) ** 2;
    return order === 0 ? value - constant : value + constant * square;
  });
}

const total = (parts: readonly Float32Array[]): Float32Array =>
  (parts[0] ?? new Float32Array()).map((value, at) => value + (parts[1]?.[at] ?? NaN) + (parts[2]?.[at] ?? NaN));

const ALT = ["the same everywhere", "bright on one side", "the same on the hidden back, mirrored"] as const;

export function* orders(values: Values): Generator<Drawing> {
  const light = lightNamed(String(values.light));
  const constant = numberOf(values, "constant");
  const one = normalAt(numberOf(values, "nx"), numberOf(values, "ny"));
  const at = (order: 0 | 1 | 2, of: Float32Array) => part(light, order, constant, of);
  const parts = ([0, 1, 2] as const).map((order) => at(order, normals));
  const [o0 = NaN, o1 = NaN, o2 = NaN] = ([0, 1, 2] as const).map((order) => at(order, Float32Array.from(one))[1]);
  const ring: Mark[] = [{ ink: "normal", shape: "ring", points: onDisc(one), size: 4 }];
  const whole = total(parts);
  const ball = (key: string, title: string, alt: string, log: Float32Array, legend: string, white?: number) =>
    pictureOf({ key, title, alt, legend }, GRID, log.map(Math.exp), ring, white);
  // Whatever constant is moved, a ball keeps its white, so that the balls of order 0 and 2 show it.
  const whiteOf = (order: 0 | 1 | 2) =>
    brightest(part(light, order, 0, normals).map(Math.exp)) * (order === 1 ? 1 : Math.exp(LARGEST_CONSTANT));
  const around = numberOf(values, "around");
  yield {
    panels: [
      ...([0, 1, 2] as const).map((order) =>
        ball(`order${order}`, TITLES[order], `A ball, ${ALT[order]}.`, at(order, normals), ALT[order], whiteOf(order)),
      ),
      ball(
        "whole",
        "All together",
        "A ball whose log intensity is the sum of the three.",
        whole,
        "the sum of the three logarithms",
      ),
      String(values.curves) === "degrees" ? plotOfDegrees() : plotOfLamp(around),
    ],
    numbers: {
      order0: o0,
      order1: o1,
      order2: o2,
      whole: o0 + o1 + o2,
      change: rms(whole, shadeNormals(light, normals)),
      ...curveNumbers(around),
    },
  };
}
