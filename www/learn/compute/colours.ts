/** Three colours: each selects a curve on the hemisphere, and the remaining normals are where the curves meet. */

import type { Drawing, Values } from "../protocol";
import { curvesOf, degreesApart, degreesToCurves } from "./curves";
import { atPixel, normalsOf, pictureOf } from "./draw";
import { landscapeOf } from "./landscape";
import { normalDegrees } from "./measure";
import { after, lightNamed, logAt, numberOf, pixelAt, saturated, scene, vectorAt } from "./scenes";

const SIZE = 64;

export function* colours(values: Values): Generator<Drawing> {
  const light = saturated(lightNamed(String(values.light)), numberOf(values, "colour"));
  const made = scene({ surface: "bust", light, size: SIZE, angles: { beta: 0 }, noise: numberOf(values, "noise") });
  const grid = made.image;
  const chosen = pixelAt(grid.mask, grid.width, grid.height, numberOf(values, "px"), numberOf(values, "py"));
  const truth = vectorAt(made.truth.imageNormals, chosen);
  const log = logAt(made, chosen);
  const curves = curvesOf(log, light);
  const landscape = landscapeOf({ log, light }, { truth, curves });
  const found = after(
    made,
    { light, start: made.pose, registration: "fixed", shading: "pixel", lambda: { prior: 0 } },
    1,
    (estimator) => estimator.imageNormals(),
  );
  const ring = [{ ink: "pixel", shape: "ring", points: atPixel(chosen, grid), size: 3 } as const];
  yield {
    panels: [
      pictureOf(
        {
          key: "picture",
          title: "The picture",
          alt: "A bust under the light set by the slider.",
          legend: "drag to choose a pixel",
        },
        grid,
        made.image.data as Float32Array,
        ring,
      ),
      landscape.panel,
      normalsOf(
        {
          key: "found",
          title: "Normals, pixel by pixel",
          alt: "Normals estimated from single pixels, without a prior.",
        },
        grid,
        found,
        ring,
      ),
      normalsOf(
        { key: "truth", title: "True normals", alt: "The true normals of the bust." },
        grid,
        made.truth.imageNormals,
        ring,
      ),
    ],
    numbers: {
      explained: landscape.explained,
      good: landscape.good,
      off: landscape.off,
      // How far the curves are from each other, and the lowest minimum from all of them.
      apart: degreesApart(curves),
      meeting: degreesToCurves(landscape.lowest, curves),
      degrees: normalDegrees(found, made.truth.imageNormals),
    },
  };
}
