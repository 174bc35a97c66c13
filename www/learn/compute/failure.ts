/** When the method fails: symmetry, little overlap, texture, a quarter turn; and what the program then reports. */

import type { Relief, Sample } from "../../../pkg/index.js";
import { LARGEST_TURN, LEAST_OVERLAP, type Drawing, type Values } from "../protocol";
import { cloudsOf } from "./clouds";
import { pictureOf, scalarOf } from "./draw";
import { chosenPixels, degreesBetween, meanOf } from "./measure";
import { numberOf, scene, watched } from "./scenes";
import { wordsOf } from "./status";

const SIZE = 64;
/** Side of the scenes whose sigma is followed as they become harder, and their noise: at 64 pixels, errors of sampling exceed it. */
const [FINE, FINE_NOISE] = [96, 0.03];
/** Depths from the middle that have different colours, as a share of a scene's side. */
const DEEP = 14 / 64;
/** Side of the disc's grid of heights. */
const DISC = 128;
/** Share of the depth map's columns in the turned view. */
const NARROW = 0.2;

/** A disc of rings, round except for a nose. */
function disc(nose: number): Relief {
  const heights = new Float32Array(DISC * DISC);
  for (let index = 0; index < heights.length; index++) {
    const [x, y] = [(index % DISC) / (DISC / 2) - 1, Math.floor(index / DISC) / (DISC / 2) - 1];
    const distance = Math.hypot(x, y);
    const bump = Math.exp(-((x - 0.35) ** 2 + (y + 0.2) ** 2) / 0.02);
    heights[index] =
      distance > 0.9
        ? 0
        : 20 + 30 * Math.sqrt(Math.max(0, 1 - distance ** 2)) + 4 * Math.cos(9 * distance) + 10 * nose * bump;
  }
  return { width: DISC, height: DISC, heights };
}

/** Each case, with its difficulty from 0 to 100 percent. */
function sceneOf(what: string, amount: number): { made: Sample; pair: Pick<Sample, "image" | "depth"> } {
  const base = { surface: "bust", light: "colourful", size: SIZE, noise: 0.01, angles: { beta: 20 } };
  const fine = { ...base, size: FINE, noise: FINE_NOISE };
  const share = amount / 100;
  switch (what) {
    case "symmetry": {
      const made = scene({ ...base, surface: disc(1 - share), angles: { beta: 15, gamma: 30 } }, `disc ${share}`);
      return { made, pair: made };
    }
    case "overlap": {
      const made = scene({ ...fine, angles: { beta: 40 }, overlap: 1 - (1 - LEAST_OVERLAP) * share });
      return { made, pair: made };
    }
    case "texture": {
      const made = scene({ ...base, light: "window" });
      return { made, pair: textured(made, share) };
    }
    default: {
      const made = scene({ ...fine, angles: { beta: LARGEST_TURN * share }, overlap: NARROW });
      return { made, pair: made };
    }
  }
}

/** Print that changes from pixel to pixel, independently in each colour. */
function textured(made: Sample, strength: number): Pick<Sample, "image" | "depth"> {
  const { width, height } = made.image;
  const every = new Uint8Array(width * height).fill(1);
  const dark = [7, 8, 9].map((seed) => chosenPixels(every, 0.5, seed));
  const data = (made.image.data as Float32Array).map(
    (value, at) => value * (dark[at % 3]?.[Math.floor(at / 3)] ? Math.exp(-2 * strength) : 1),
  );
  return { image: { ...made.image, data }, depth: made.depth };
}

export function* failure(values: Values): Generator<Drawing> {
  const { made, pair } = sceneOf(String(values.case), numberOf(values, "amount"));
  const grid = made.image;
  const given = made.depth.data as Float32Array;
  const isGiven = (index: number) => (given[index] ?? 0) > 0 && Boolean(made.depth.mask?.[index]);
  const middle = meanOf(given, isGiven);
  const depth = given.map((value, index) => (isGiven(index) ? value - middle : NaN));
  for (const { estimator, status, done } of watched(pair, { scale: 1, start: "search" })) {
    const { report } = estimator;
    yield {
      panels: [
        pictureOf(
          { key: "picture", title: "The picture", alt: "The colour image." },
          grid,
          pair.image.data as Float32Array,
        ),
        scalarOf(
          {
            key: "depth",
            title: "The depth map",
            alt: "The depth map from the other viewpoint.",
            legend: "dark near, bright far; hatched: no depth",
          },
          made.depth,
          depth,
          { min: -DEEP * grid.width, max: DEEP * grid.width },
        ),
        cloudsOf(estimator),
        scalarOf(
          {
            key: "residual",
            title: "Unexplained colour",
            alt: "Residual of every pixel.",
            legend: "dark: explained; bright: off by 0.5 and more",
          },
          grid,
          estimator.residual(),
          { min: 0, max: 0.5 },
          "magma",
        ),
      ],
      numbers: {
        error: done ? degreesBetween(report.pose.rotation, made.pose.rotation) : NaN,
        sigma: done && report.uncertainty ? Math.max(...report.uncertainty.rotationDegrees) : NaN,
        rivals: done ? (report.rivals?.length ?? 0) : NaN,
        residual: done ? report.residual : NaN,
      },
      ...wordsOf(status),
    };
  }
}
