/** Refining the sensor: the shading in the image removes the noise from the depth map. */

import type { Drawing, Values } from "../protocol";
import { alongRow, normalsOf, plot } from "./draw";
import { meanOf, normalDegrees, rms } from "./measure";
import { Estimator, type Sample } from "../../../pkg/index.js";
import { numberOf, running, scene } from "./scenes";
import { statusOf, wordsOf } from "./status";

const SIZE = 64;
const STEPS = 6;

const options = (made: Sample) => ({ light: made.light, start: made.pose, scale: 1, registration: "fixed" }) as const;

/** Normals of the sensor's depth before the refinement. */
function rawNormals(made: Sample): Float32Array {
  const estimator = new Estimator(made.image, made.depth, options(made));
  try {
    return estimator.depthNormals();
  } finally {
    estimator.free();
  }
}

export function* sensor(values: Values): Generator<Drawing> {
  const [noise, holes] = [numberOf(values, "noise"), numberOf(values, "holes")];
  const made = scene({
    surface: "bust",
    light: String(values.light),
    size: SIZE,
    angles: { beta: 15 },
    noise: numberOf(values, "picture"),
    depthNoise: noise,
    holes: holes / 100,
    seed: 3,
  });
  const grid = made.depth;
  const measured = made.depth.data as Float32Array;
  const inside = (depth: ArrayLike<number>) =>
    Array.from(depth, (value, index) => (made.depth.mask?.[index] ? value : NaN));
  const raw = rawNormals(made);
  const middle = meanOf(made.truth.depth);
  const row = Math.round(0.45 * grid.height);
  const holesAt = (index: number) => Boolean(made.depth.mask?.[index]) && !Number.isFinite(measured[index]);
  for (const estimator of running(made, options(made), STEPS)) {
    const refined = estimator.refinedDepth();
    const normals = estimator.depthNormals();
    const measuredOnly = refined.map((value, index) => (Number.isFinite(measured[index]) ? value : NaN));
    const filled = refined.filter((value, index) => holesAt(index) && Number.isFinite(value)).length;
    const all = measured.filter((_, index) => holesAt(index)).length;
    const known = measured.filter(Number.isFinite).length;
    const off = (depth: ArrayLike<number>) =>
      alongRow(
        Array.from(depth, (value) => value - middle),
        grid,
        row,
        -1,
      );
    yield {
      panels: [
        normalsOf(
          { key: "raw", title: "Sensor: normals as measured", alt: "Normals of the noisy depth map." },
          grid,
          raw,
        ),
        normalsOf(
          { key: "refined", title: "Sensor: normals refined", alt: "Normals of the depth map after refinement." },
          grid,
          normals,
        ),
        normalsOf(
          { key: "truth", title: "True normals", alt: "True normals in the depth view." },
          grid,
          made.truth.depthNormals,
        ),
        plot(
          {
            key: "profile",
            title: "A cross-section of the face",
            alt: "Heights along one row: measured, refined and true.",
          },
          "column, px",
          "height, px",
          [
            { name: "measured", ink: "error", points: off(inside(measured)) },
            { name: "true", ink: "truth", points: off(made.truth.depth) },
            { name: "refined", ink: "sensor", points: off(refined) },
          ],
        ),
      ],
      numbers: {
        before: rms(measured, made.truth.depth),
        after: rms(measuredOnly, made.truth.depth),
        normalsBefore: normalDegrees(raw, made.truth.depthNormals),
        normalsAfter: normalDegrees(normals, made.truth.depthNormals),
        kept: (100 * measuredOnly.filter(Number.isFinite).length) / known,
        filled: all === 0 ? NaN : (100 * filled) / all,
      },
      ...wordsOf(statusOf("iteration", { iteration: estimator.report.iteration })),
    };
  }
}
