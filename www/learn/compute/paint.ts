/** Shadows, albedo, and how the model handles them. */

import type { Sample } from "../../../pkg/index.js";
import type { Drawing, Values } from "../protocol";
import { brightest, pictureOf, scalarOf } from "./draw";
import { correlation, meanOf, normalDegrees } from "./measure";
import { numberOf, running, scene } from "./scenes";
import { statusIn, wordsOf } from "./status";

const SIZE = 96;
/** Log albedos of the pattern at full strength, and the side of a square of it, pixels. */
const PAINTS = [
  [0, -0.7, -0.9],
  [-0.8, -0.2, -0.1],
  [-0.1, -0.1, -0.8],
] as const;
const SQUARE = 16;
/** The albedo, relative to its mean, that is drawn white if nothing is brighter. */
const WHITE = 1.6;
/** The shadow falls on a slanting band. */
const BAND = [0.42, 0.58] as const;

interface Painted {
  pair: Pick<Sample, "image" | "depth">;
  /** The true log albedo, less its mean, as the module defines it. */
  paint: Float32Array;
  shadow: Uint8Array;
}

function painted(made: Sample, strength: number, darkness: number): Painted {
  const { width, mask } = made.image;
  const colours = (made.image.data as Float32Array).slice();
  const paint = new Float32Array(colours.length).fill(NaN);
  const shadow = new Uint8Array(colours.length / 3);
  for (let index = 0; index < shadow.length; index++) {
    const [column, row] = [index % width, Math.floor(index / width)];
    const hue = PAINTS[(Math.floor(column / SQUARE) + Math.floor(row / SQUARE)) % PAINTS.length] ?? PAINTS[0];
    const along = (column + 0.5 * row) / (1.5 * width);
    shadow[index] = darkness > 0 && along > BAND[0] && along < BAND[1] ? 1 : 0;
    for (const [channel, offset] of hue.entries()) {
      if (mask?.[index]) paint[3 * index + channel] = strength * offset;
      const at = 3 * index + channel;
      colours[at] = (colours[at] ?? NaN) * Math.exp(strength * offset) * (shadow[index] ? 1 - darkness : 1);
    }
  }
  return { pair: { image: { ...made.image, data: colours }, depth: made.depth }, paint, shadow };
}

/** How much darker the estimated albedo is in the shadow, corrected for the true albedo, as a logarithm. */
function contrast(albedo: Float32Array, paint: Float32Array, isShadow: (index: number) => boolean): number {
  const less = albedo.map((value, at) => value - (paint[at] ?? NaN));
  const side = (wanted: boolean) => meanOf(less, (at) => isShadow(Math.floor(at / 3)) === wanted);
  return side(true) - side(false);
}

export function* paint(values: Values): Generator<Drawing> {
  const made = scene({ surface: "bust", light: String(values.light), size: SIZE, angles: { beta: 20 }, noise: 0.005 });
  const [strength, darkness] = [numberOf(values, "paint"), numberOf(values, "shadow")];
  const { pair, paint, shadow } = painted(made, strength, darkness);
  const grid = made.image;
  const exp = (log: Float32Array) => log.map(Math.exp);
  const isShadow = (index: number) => shadow[index] === 1;
  // The shadow's outermost pixels along each row with their neighbours in the light, and pixels near the silhouette.
  const isRim = (index: number) => shadow[index] !== shadow[index - 1] || shadow[index] !== shadow[index + 1];
  const isNearSilhouette = (index: number, within: number) =>
    [1, grid.width - 1, grid.width, grid.width + 1].some(
      (step) => !grid.mask?.[index - within * step] || !grid.mask?.[index + within * step],
    );
  for (const estimator of running(pair, { start: made.pose, scale: 1, registration: "fixed" }, 12)) {
    const { report } = estimator;
    const [albedo, shading, residual] = [estimator.albedo(), estimator.shading(), estimator.residual()];
    const hasPaint = albedo.some((value) => Number.isFinite(value) && value !== 0);
    yield {
      panels: [
        pictureOf(
          { key: "picture", title: "The picture", alt: "A painted bust with a cast shadow across it." },
          grid,
          pair.image.data as Float32Array,
        ),
        pictureOf(
          {
            key: "albedo",
            title: "Albedo, as estimated",
            alt: "The albedo that the program separates from the lighting.",
            legend: "relative to its mean",
          },
          grid,
          exp(albedo),
          [],
          Math.max(WHITE, brightest(exp(albedo))),
        ),
        pictureOf(
          {
            key: "shading",
            title: "Shading: the effect of the light",
            alt: "The picture with the albedo divided out.",
          },
          grid,
          exp(shading),
        ),
        scalarOf(
          {
            key: "residual",
            title: "Remainder",
            alt: "The part that neither albedo nor shading explains.",
            legend: "dark: explained; bright: off by 0.4 and more",
          },
          grid,
          residual,
          { min: 0, max: 0.4 },
          "magma",
        ),
      ],
      numbers: {
        likeness: strength > 0 && hasPaint ? correlation(albedo, paint) : NaN,
        lit: meanOf(residual, (index) => !isShadow(index)),
        shaded: darkness > 0 ? meanOf(residual, isShadow) : NaN,
        rim: darkness > 0 ? meanOf(residual, (index) => isRim(index) && !isNearSilhouette(index, 6)) : NaN,
        silhouette: darkness > 0 ? meanOf(residual, (index) => isShadow(index) && isNearSilhouette(index, 2)) : NaN,
        inside: darkness > 0 ? meanOf(residual, (index) => isShadow(index) && !isNearSilhouette(index, 6)) : NaN,
        taken: darkness > 0 ? (100 * contrast(albedo, paint, isShadow)) / Math.log(1 - darkness) : NaN,
        degrees: normalDegrees(estimator.imageNormals(), made.truth.imageNormals),
      },
      ...wordsOf(statusIn(report)),
    };
  }
}
