/** One grey light is not enough: a bump and a dent make the same picture, and a pixel fits a curve of normals. */

import { turnLight, type Relief, type Sample } from "../../../pkg/index.js";
import type { Drawing, Values } from "../protocol";
import { alongRow, atPixel, brightest, pictureOf, plot } from "./draw";
import { landscapeOf } from "./landscape";
import { rms } from "./measure";
import { lightNamed, logAt, numberOf, pixelAt, saturated, scene, vectorAt } from "./scenes";

const SIDE = 96;
const SIZE = 160;
/** Heights of the plate's middle and of the bump, pixels of the relief. */
const PLATE = 40;
const BUMP = 22;

/** A round plate with a round bump in it; a negative height makes a dent. */
function bump(height: number): Relief {
  const heights = new Float32Array(SIDE * SIDE);
  for (let index = 0; index < heights.length; index++) {
    const [x, y] = [(index % SIDE) - (SIDE - 1) / 2, Math.floor(index / SIDE) - (SIDE - 1) / 2];
    const distance = Math.hypot(x, y) / (SIDE / 2);
    heights[index] = distance > 0.95 ? 0 : PLATE + height * BUMP * Math.exp(-((distance / 0.38) ** 2));
  }
  return { width: SIDE, height: SIDE, heights };
}

function plate(height: number, light: Float64Array): Sample {
  return scene({ surface: bump(height), light, size: SIZE, angles: { beta: 0 } }, `bump ${height}`);
}

/** The lamp of this lesson stands on the left and a little above; its light is grey. */
const lamp = (): Float64Array => saturated(lightNamed("window"), 0);

/** Heights above the edge of the plate, which both surfaces share. */
function level({ truth, image }: Sample): Float32Array {
  const row = Math.floor(image.height / 2) * image.width;
  const rim = truth.imageDepth.subarray(row, row + image.width).find(Number.isFinite) ?? 0;
  return truth.imageDepth.map((depth) => rim - depth);
}

export function* grey(values: Values): Generator<Drawing> {
  const height = numberOf(values, "height");
  const light = lamp();
  const turned = turnLight(light, { gamma: numberOf(values, "turn") });
  const [hill, dent] = [plate(height, light), plate(-height, turned)];
  const grid = hill.image;
  const chosen = pixelAt(hill.image.mask, grid.width, grid.height, numberOf(values, "px"), numberOf(values, "py"));
  const [log, normal] = [logAt(hill, chosen), vectorAt(hill.truth.imageNormals, chosen)];
  const landscape = landscapeOf({ log, light, start: [0, 0, -1] }, { truth: normal });
  const colours = [hill, dent].map(({ image }) => image.data as Float32Array) as [Float32Array, Float32Array];
  const difference = rms(colours[0].map(Math.log), colours[1].map(Math.log));
  const row = Math.floor(grid.height / 2);
  const ring = [{ ink: "pixel", shape: "ring", points: atPixel(chosen, grid), size: 3 } as const];
  const white = Math.max(...colours.map(brightest));
  yield {
    panels: [
      pictureOf(
        {
          key: "hill",
          title: "A bump, lamp on the left",
          alt: "A round bump on a plate, lit from the left.",
          legend: "drag to choose a pixel",
        },
        grid,
        colours[0],
        ring,
        white,
      ),
      pictureOf(
        {
          key: "dent",
          title: "A dent, lamp turned",
          alt: "A round dent in a plate, the lamp turned by {turn} degrees about the line of sight.",
          details: { turn: numberOf(values, "turn") },
        },
        grid,
        colours[1],
        [],
        white,
      ),
      plot(
        {
          key: "profile",
          title: "Cross-sections",
          alt: "Cross-sections of bump and dent: one goes up where the other goes down.",
        },
        "column, px",
        "height, px",
        [
          { name: "bump", ink: "normal", points: alongRow(level(hill), grid, row) },
          { name: "dent", ink: "light", points: alongRow(level(dent), grid, row) },
        ],
      ),
      landscape.panel,
    ],
    numbers: { difference, explained: landscape.explained, minima: landscape.minima },
  };
}
