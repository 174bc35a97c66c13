/** One picture, many shapes: a bas-relief, or a surface turned inside out, under its own lamp and with its own albedo. */

import { basRelief, shadeLamp } from "../../../pkg/index.js";
import type { Drawing, Values } from "../protocol";
import { stretchOf } from "../stretch";
import { alongRow, plot } from "./draw";
import { rms } from "./measure";
import { SIDE, degreesOf, grey, intensities, shaded, shapeNamed } from "./lamp";
import { isOn, numberOf } from "./scenes";

const LAMP = [0.45, -0.35, -0.82] as const;
/** The row of the cross-section as a share of the height: through the nose. */
const ROW = 0.5;

/** Heights of the new surface along a row, from its middle, pixels. */
function section(depth: Float32Array, stretch: number, slope: number): number[] {
  const heights = depth.map((value, index) => -(stretch * value + slope * ((index % SIDE) - SIDE / 2)));
  const row = Math.round(ROW * SIDE);
  const all = alongRow(heights, { width: SIDE, height: SIDE }, row);
  const known = all.filter((value, i) => i % 2 === 1 && Number.isFinite(value));
  const middle = known.reduce((sum, value) => sum + value, 0) / known.length;
  return all.map((value, i) => (i % 2 === 1 ? value - middle : value));
}

const product = (a: Float32Array, b: Float32Array): Float32Array => a.map((value, index) => value * (b[index] ?? NaN));
const most = (values: Float32Array): number => values.reduce((best, value) => (value > best ? value : best), 0);
const least = (values: Float32Array): number => values.reduce((best, value) => (value < best ? value : best), Infinity);

export function* relief(values: Values): Generator<Drawing> {
  const shape = shapeNamed("bust");
  const length = Math.hypot(...LAMP);
  const lamp = LAMP.map((part) => part / length);
  const [stretch, slope] = [stretchOf(numberOf(values, "stretch")), numberOf(values, "slope")];
  const other = basRelief(shape.normals, lamp, stretch, slope);
  const [isMoved, isPainted] = [isOn(values, "lamp"), isOn(values, "paint")];
  const first = intensities(lamp, shape);
  // A lamp left in place keeps its strength as well.
  const now = isMoved ? other.lamp : lamp;
  const plain = shadeLamp(now, other.normals);
  const second = isPainted ? product(plain, other.albedo) : plain;
  const strength = Math.hypot(...now);
  const [darkest, brightest] = [least(other.albedo), most(other.albedo)];
  yield {
    panels: [
      shaded(
        { key: "first", title: "The bust, seen from the front", alt: "A bust under one lamp from the upper right." },
        shape,
        first,
      ),
      shaded(
        {
          key: "second",
          title: "Another surface, from the front",
          alt: "A surface with another depth under its own lamp, seen from the same side.",
        },
        shape,
        second,
      ),
      shaded(
        {
          key: "albedo",
          title: "Albedo of the other surface",
          alt: "The albedo of the other surface; that of the bust is the same everywhere.",
          legend: "white: reflects most",
        },
        shape,
        isPainted ? other.albedo.map((value) => value / brightest) : other.albedo.map((value) => (value > 0 ? 1 : NaN)),
      ),
      plot(
        { key: "section", title: "Both, cut through the nose", alt: "Heights of both surfaces along one row." },
        "column, px",
        "height, px",
        [
          { name: "the bust", ink: "truth", points: section(shape.depth, 1, 0) },
          { name: "the other surface", ink: "normal", points: section(shape.depth, stretch, slope) },
        ],
      ),
    ],
    numbers: {
      difference: 100 * rms(grey(second), grey(first)),
      lamp: degreesOf(lamp.reduce((sum, part, axis) => sum + (part * (now[axis] ?? NaN)) / strength, 0)),
      paint: isPainted ? brightest / darkest : 1,
    },
  };
}
