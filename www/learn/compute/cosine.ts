/** Intensity against the angle to one lamp: by nine numbers or by nine for its logarithm, and a clamped cosine by its degrees. */

import { secondOrder, shadeLamp } from "../../../pkg/index.js";
import type { Ink, PlotPanel } from "../protocol";
import { plot } from "./draw";
import { meanOf, rms } from "./measure";

/** Number of intervals of the curve. They divide the component of the direction toward the lamp. */
const STEPS = 400;
const FRONT = [0, 0, -1];
const components = Array.from({ length: STEPS }, (_, i) => (2 * (i + 0.5)) / STEPS - 1);
const directions = Float32Array.from(components.flatMap((c) => [Math.sqrt(1 - c * c), 0, -c]));

/** One lamp, and light from all around: the true intensity, and both approximations with nine numbers. */
function approximations(around: number) {
  const intensity = shadeLamp(FRONT, directions).map((value) => value + around);
  return { intensity, direct: secondOrder(intensity), byLog: secondOrder(intensity.map(Math.log)).map(Math.exp) };
}

/** The parts of degree 0 to 3 of a clamped cosine: odd functions have only odd degrees, and even ones only even degrees. */
function degreesOf({ intensity, direct }: ReturnType<typeof approximations>): Float32Array[] {
  const odd = (of: Float32Array) => of.map((value, i) => (value - (of[STEPS - 1 - i] ?? NaN)) / 2);
  const minus = (of: Float32Array, ...parts: Float32Array[]) =>
    of.map((value, i) => parts.reduce((rest, part) => rest - (part[i] ?? NaN), value));
  const zeroth = new Float32Array(STEPS).fill(meanOf(intensity));
  const first = odd(direct);
  // Of the odd part, degrees 3, 5, 7 and so on are left.
  return [zeroth, first, minus(direct, zeroth, first), minus(odd(intensity), first)];
}

const curve = (of: Float32Array): number[] =>
  components.flatMap((c, i) => [(180 / Math.PI) * Math.acos(c), of[i] ?? NaN]).filter((_, i) => i % 8 < 2);

export function plotOfLamp(around: number): PlotPanel {
  const { intensity, direct, byLog } = approximations(around);
  return plot(
    {
      key: "fit",
      title: "One lamp by nine numbers",
      alt: "Intensity against the angle to the lamp: true, by nine numbers, and by nine numbers for its logarithm.",
    },
    "angle, °",
    "intensity",
    [
      { name: "true", ink: "truth", points: curve(intensity) },
      { name: "nine for the intensity", ink: "intensity", points: curve(direct) },
      { name: "nine for its logarithm", ink: "light", points: curve(byLog) },
    ],
    { range: [-0.1, 1.2], hasAngles: true },
  );
}

const INKS: readonly Ink[] = ["light", "green", "normal", "error"];

export function plotOfDegrees(): PlotPanel {
  const cosine = approximations(0);
  return plot(
    {
      key: "degrees",
      title: "A clamped cosine by degree",
      alt: "A clamped cosine and its parts of degree 0 to 3 against the angle to the lamp; that of degree 3 is zero.",
    },
    "angle, °",
    "intensity",
    [
      { name: "clamped cosine", ink: "truth", points: curve(cosine.intensity) },
      { name: "0 to 2 together", ink: "intensity", points: curve(cosine.direct) },
      ...degreesOf(cosine).map((part, degree) => ({
        name: `degree ${degree}`,
        ink: INKS[degree] ?? "truth",
        points: curve(part),
      })),
    ],
    { range: [-0.5, 1], hasAngles: true },
  );
}

/** Errors of the approximations in percent of the lamp's intensity, and the sizes of the degrees (rms). */
export function curveNumbers(around: number): Record<string, number> {
  const { intensity, direct, byLog } = approximations(around);
  const cosine = approximations(0);
  const size = (part: Float32Array) => rms(part, new Float32Array(STEPS));
  return {
    least: Math.min(...direct),
    leastLog: Math.min(...byLog),
    direct: 100 * rms(direct, intensity),
    byLog: 100 * rms(byLog, intensity),
    byDegree: 100 * rms(cosine.direct, cosine.intensity),
    ...Object.fromEntries(degreesOf(cosine).map((part, degree) => [`degree${degree}`, size(part)])),
  };
}
