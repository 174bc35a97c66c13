/** The normal of one pixel in the loop: the pose decides where its prior is, and the weight how much it counts. */

import type { Drawing, Values } from "../protocol";
import { atPixel, pictureOf } from "./draw";
import { landscapeOf } from "./landscape";
import { angleBetween, degreesBetween, turned } from "./measure";
import { held, passed, picture } from "./pose";
import { isOn, logAt, numberOf, pixelAt, vectorAt } from "./scenes";

export function* loop(values: Values): Generator<Drawing> {
  const made = picture(values);
  const grid = made.image;
  const [offset, passes] = [numberOf(values, "offset"), numberOf(values, "pass")];
  const { panel, rotation, correspondence, normals } = passes === 0 ? held(made, offset) : passed(made, offset, passes);
  const chosen = pixelAt(grid.mask, grid.width, grid.height, numberOf(values, "px"), numberOf(values, "py"));
  const truth = vectorAt(made.truth.imageNormals, chosen);
  const seen = correspondence[chosen] ?? -1;
  const prior = seen < 0 ? undefined : turned(rotation, vectorAt(normals, seen));
  const known = prior?.every(Number.isFinite) ? prior : undefined;
  const landscape = landscapeOf(
    {
      log: logAt(made, chosen),
      light: made.light,
      weight: known ? numberOf(values, "weight") : 0,
      robust: isOn(values, "robust"),
      start: known ?? [0, 0, -1],
      ...(known ? { prior: known } : {}),
    },
    { truth, hasSteps: true },
  );
  const ring = [{ ink: "pixel", shape: "ring", points: atPixel(chosen, grid), size: 3 } as const];
  yield {
    panels: [
      pictureOf(
        {
          key: "picture",
          title: "The picture",
          alt: "A bust; the ring marks the pixel of the cost map.",
          legend: "drag to choose a pixel",
        },
        grid,
        made.image.data as Float32Array,
        ring,
      ),
      panel,
      landscape.panel,
    ],
    numbers: {
      pose: degreesBetween(rotation, made.pose.rotation),
      minima: landscape.minima,
      off: known ? angleBetween(known, truth) : NaN,
      end: angleBetween(landscape.end, truth),
    },
  };
}
