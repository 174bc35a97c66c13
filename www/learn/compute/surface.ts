/** From normals to a surface: integration, why it misses a step, and the effect of noise on slopes. */

import { integrateNormals, type Relief } from "../../../pkg/index.js";
import type { Drawing, Values } from "../protocol";
import { alongRow, normalsOf, plot, scalarOf } from "./draw";
import { depthRmse, meanOf, slopeOf } from "./measure";
import { after, isOn, numberOf, scene } from "./scenes";

const SIDE = 256;
const SIZE = 64;
const PIXELS = SIDE / SIZE;
const LEVEL = 120;
/** Where the step is, and the row of the section, as shares of the sides. */
const [WALL, ROW] = [0.625, 0.42];

/** A square plate with a dome on the left, and on the right a part that is raised by a step. */
function relief(step: number, through: boolean): Relief {
  const heights = new Float32Array(SIDE * SIDE);
  for (let index = 0; index < heights.length; index++) {
    const [x, y] = [(index % SIDE) / SIDE, Math.floor(index / SIDE) / SIDE];
    if (Math.min(x, y, 1 - x, 1 - y) < 0.08) continue;
    const dome = 0.12 - (x - 0.32) ** 2 - (y - 0.45) ** 2;
    // The wall is between two pixels, so that no pixel shows it.
    const right = x >= WALL;
    // Slopes bring the raised part back down on all other sides, unless the step goes through.
    const ramp = through ? 1 : Math.exp(-(((y - ROW) / 0.16) ** 2)) * Math.max(0, 1 - (x - WALL) / (0.9 - WALL));
    heights[index] = LEVEL + 220 * Math.max(0, dome - 0.07) * 4 + (right ? step * PIXELS * ramp : 0);
  }
  return { width: SIDE, height: SIDE, heights };
}

export function* surface(values: Values): Generator<Drawing> {
  const [step, noise, robust, through] = [
    numberOf(values, "step"),
    numberOf(values, "noise"),
    isOn(values, "robust"),
    isOn(values, "through"),
  ];
  const made = scene(
    { surface: relief(step, through), light: "colourful", size: SIZE, angles: { beta: 0 }, noise },
    `step ${step} ${through}`,
  );
  const grid = made.image;
  const pixels = after(
    made,
    { light: made.light, start: made.pose, registration: "fixed", shading: "pixel", lambda: { prior: 0 } },
    1,
    (estimator) => estimator.imageNormals(),
  );
  const found = integrateNormals(pixels, grid.width, grid.height, robust);
  const truth = made.truth.imageDepth;
  const centred = (depth: Float32Array): Float32Array => {
    const middle = meanOf(depth, (index) => Number.isFinite(found[index]) && Number.isFinite(truth[index]));
    return depth.map((value) => value - middle);
  };
  const [foundDepth, trueDepth] = [centred(found), centred(truth)];
  const row = Math.round(ROW * grid.height);
  const column = Math.round(WALL * grid.width);
  const jump = (depth: Float32Array) =>
    (depth[row * grid.width + column - 3] ?? NaN) - (depth[row * grid.width + column + 3] ?? NaN);
  const left = (depth: Float32Array) => depth.filter((_, index) => index % grid.width < column - 2);
  const least = Math.min(...trueDepth.filter(Number.isFinite));
  const most = Math.max(...trueDepth.filter(Number.isFinite));
  yield {
    panels: [
      normalsOf(
        {
          key: "normals",
          title: "Normals of the pixels",
          alt: "Normals estimated from the colours: nearly the same on both sides of the step.",
        },
        grid,
        pixels,
      ),
      scalarOf(
        {
          key: "depth",
          title: "Depth after integration",
          alt: "The depth obtained by integrating the normals.",
          legend: "dark near, bright far",
        },
        grid,
        foundDepth,
        { min: least, max: most },
      ),
      scalarOf(
        {
          key: "truth",
          title: "True depth",
          alt: "The true depth: a dome, and a part raised by the step.",
          legend: "dark near, bright far",
        },
        grid,
        trueDepth,
        { min: least, max: most },
      ),
      plot(
        { key: "profile", title: "A section through dome and step", alt: "Heights along one row: true and estimated." },
        "column, px",
        "height, px",
        [
          { name: "true", ink: "truth", points: alongRow(trueDepth, grid, row, -1) },
          { name: "found", ink: "normal", points: alongRow(foundDepth, grid, row, -1) },
        ],
      ),
    ],
    numbers: {
      error: depthRmse(found, truth),
      jump: jump(foundDepth),
      kept: 100 * slopeOf(left(foundDepth), left(trueDepth)),
    },
  };
}
