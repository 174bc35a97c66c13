/** From normals to a surface: integration, why it misses a step, and the effect of noise on slopes. */

import { integrateNormals, type Relief, type Sample } from "../../../pkg/index.js";
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
/** How far the step extends along the wall, and where the ramp behind it ends, as shares of the sides. */
const [REACH, FOOT] = [0.12, 0.9];
/** Pixels on either side of the wall between which the height of the step is read. */
const BESIDE = 3;

type Part = "both" | "near" | "far";

/**
 * A square plate with a dome on the left, and on the right a part that is raised by a step. One part alone continues smoothly across the
 * wall, so that its normals are those of that part up to the wall.
 */
function relief(step: number, through: boolean, part: Part): Relief {
  const heights = new Float32Array(SIDE * SIDE);
  for (let index = 0; index < heights.length; index++) {
    const [x, y] = [(index % SIDE) / SIDE, Math.floor(index / SIDE) / SIDE];
    if (Math.min(x, y, 1 - x, 1 - y) < 0.08) continue;
    const dome = 0.12 - (x - 0.32) ** 2 - (y - 0.45) ** 2;
    // The wall is between two pixels, so that no pixel shows it.
    const raised = part === "both" ? x >= WALL : part === "far";
    // Slopes bring the raised part back down on all other sides, unless the step goes through.
    const ramp = through ? 1 : Math.exp(-(((y - ROW) / REACH) ** 2)) * Math.max(0, 1 - (x - WALL) / (FOOT - WALL));
    heights[index] = LEVEL + 220 * Math.max(0, dome - 0.07) * 4 + (raised ? step * PIXELS * ramp : 0);
  }
  return { width: SIDE, height: SIDE, heights };
}

/**
 * The scene, with its colours taken from its two parts. In a rendering of the whole, the normals beside the wall would be computed across
 * it, so that the colours would reveal the step.
 */
function seamless(step: number, through: boolean, noise: number): Sample {
  const part = (name: Part): Sample => {
    const height = name === "near" ? 0 : step;
    const request = { light: "colourful", size: SIZE, angles: { beta: 0 }, noise };
    return scene({ ...request, surface: relief(height, through, name) }, `step ${height} ${through} ${name}`);
  };
  const [made, near, far] = [part("both"), part("near"), part("far")];
  const { width } = made.image;
  const wall = Math.round(WALL * width);
  const data = (near.image.data as Float32Array).map((value, at) =>
    Math.floor(at / 3) % width < wall ? value : (far.image.data[at] ?? NaN),
  );
  return { ...made, image: { ...made.image, data } };
}

export function* surface(values: Values): Generator<Drawing> {
  const [step, noise, robust, through] = [
    numberOf(values, "step"),
    numberOf(values, "noise"),
    isOn(values, "robust"),
    isOn(values, "through"),
  ];
  const made = seamless(step, through, noise);
  const grid = made.image;
  const pixels = after(
    made,
    { light: made.light, start: made.pose, registration: "fixed", shading: "pixel", lambda: { prior: 0 } },
    1,
    (estimator) => estimator.imageNormals(),
  );
  const found = integrateNormals(pixels, grid.width, grid.height, robust);
  const truth = made.truth.imageDepth;
  const row = Math.round(ROW * grid.height);
  const column = Math.round(WALL * grid.width);
  const isBoth = (index: number) => Number.isFinite(found[index]) && Number.isFinite(truth[index]);
  // The depths are compared on the side of the dome, so that a wrong height of the step does not make the dome look wrong.
  const centred = (depth: Float32Array): Float32Array => {
    const middle = meanOf(depth, (index) => isBoth(index) && index % grid.width < column);
    return depth.map((value) => value - middle);
  };
  const [foundDepth, trueDepth] = [centred(found), centred(truth)];
  const rise = (depth: Float32Array) =>
    (depth[row * grid.width + column - BESIDE] ?? NaN) - (depth[row * grid.width + column + BESIDE - 1] ?? NaN);
  const left = (depth: Float32Array) => depth.filter((_, index) => index % grid.width < column - 2);
  const least = Math.min(...trueDepth.filter(Number.isFinite));
  const most = Math.max(...trueDepth.filter(Number.isFinite));
  yield {
    panels: [
      normalsOf(
        {
          key: "normals",
          title: "Normals of the pixels",
          alt: "Normals estimated from the colours: continuous across the step.",
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
      // The true step and the error of its estimate: between the two pixels the surface slopes as well.
      jump: step + rise(foundDepth) - rise(trueDepth),
      kept: 100 * slopeOf(left(foundDepth), left(trueDepth)),
    },
  };
}
