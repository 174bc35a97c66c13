/** The orders of the image model as balls that add up, and nine numbers for an intensity or for its logarithm. */

import { secondOrder, shadeLamp, shadeNormals } from "../../../pkg/index.js";
import { ballNormals } from "../../engine/ball";
import { LARGEST_CONSTANT, type Drawing, type Mark, type Values } from "../protocol";
import { brightest, onDisc, pictureOf, plot } from "./draw";
import { rms } from "./measure";
import { lightNamed, normalAt, numberOf, ofOrder } from "./scenes";

const SIDE = 192;
const GRID = { width: SIDE, height: SIDE };
const normals = ballNormals(SIDE);
const TITLES = ["Order 0", "Order 1", "Order 2"] as const;
/** Number of intervals of the curve. They divide the component of the direction toward the lamp. */
const STEPS = 400;
const FRONT = [0, 0, -1];

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

/** One lamp, and light from all around: the true intensity, and both approximations with nine numbers. */
function approximations(around: number) {
  const components = Array.from({ length: STEPS }, (_, i) => (2 * (i + 0.5)) / STEPS - 1);
  const directions = components.flatMap((c) => [Math.sqrt(1 - c * c), 0, -c]);
  const intensity = shadeLamp(FRONT, Float32Array.from(directions)).map((value) => value + around);
  const log = intensity.map(Math.log);
  return {
    components,
    intensity,
    direct: secondOrder(intensity),
    byLog: secondOrder(log).map(Math.exp),
  };
}

const ALT = ["the same everywhere", "bright on one side", "the same on opposite sides"] as const;

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
  const { components, intensity, direct, byLog } = approximations(numberOf(values, "around"));
  const curve = (of: Float32Array) =>
    components.flatMap((c, i) => [(180 / Math.PI) * Math.acos(c), of[i] ?? NaN]).filter((_, i) => i % 8 < 2);
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
      plot(
        {
          key: "fit",
          title: "One lamp by nine numbers",
          alt: "Intensity against the angle to the lamp: true, by nine numbers, and by nine numbers for its logarithm.",
        },
        "angle, °",
        "intensity",
        [
          { name: "true", ink: "truth", points: curve(intensity) },
          { name: "nine for the intensity", ink: "colour", points: curve(direct) },
          { name: "nine for its logarithm", ink: "light", points: curve(byLog) },
        ],
        { range: [-0.1, 1.2] },
      ),
    ],
    numbers: {
      order0: o0,
      order1: o1,
      order2: o2,
      whole: o0 + o1 + o2,
      change: rms(whole, shadeNormals(light, normals)),
      least: Math.min(...direct),
      leastLog: Math.min(...byLog),
      direct: 100 * rms(direct, intensity),
      byLog: 100 * rms(byLog, intensity),
    },
  };
}
