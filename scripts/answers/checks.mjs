// Differences between two reports of a calibration check.
import { degreesBetween } from "../../protocols/rotations.mjs";
import { LIMITS, codeOf, differ, largest, listsApart, relative } from "./compare.mjs";

/** Unknowns of a pose. */
const POSE = 6;
const DEGREE = 180 / Math.PI;

/** Sigmas in degrees and millimetres, and correlations, because the entries of a covariance are too small for a comparison. */
function spreadOf(covariance) {
  const sigmas = Array.from({ length: POSE }, (_, k) => Math.sqrt(covariance[(POSE + 1) * k]));
  const correlations = covariance.map((value, at) => value / (sigmas[Math.floor(at / POSE)] * sigmas[at % POSE]));
  return [...sigmas.map((sigma, k) => sigma * (k < 3 ? DEGREE : 1000)), ...correlations];
}

/** All numbers of a report except poses. */
function numbersOf({ middle, covariance, focal = [], health, candidates, cues, frames, sensitivity, next }) {
  const named = (object) =>
    Object.keys(object)
      .sort()
      .map((name) => object[name]);
  return [
    ...middle,
    ...spreadOf(covariance),
    ...focal,
    health.pixels,
    ...health.interval,
    ...named(candidates).flatMap(({ offMillimetres, pixels, interval, probability }) => [
      offMillimetres,
      pixels,
      ...interval,
      probability,
    ]),
    ...named(cues).flatMap(({ share, sharpness }) => [share, sharpness]),
    ...frames.map(({ share }) => share),
    ...sensitivity.flatMap(({ offsets, values }) => [...offsets, ...values]),
    ...(next ? [next.sigma, next.expected] : []),
  ];
}

const turnsOf = ({ candidates }) =>
  Object.keys(candidates)
    .sort()
    .map((name) => candidates[name].offDegrees);

/** Members that must be equal: verdicts, number and kind of warnings, notes. */
function disagreements(before, after) {
  const [a, b] = [before.report, after.report];
  const pairs = [
    ["verdict", a.verdict, b.verdict],
    ["reason", codeOf(a), codeOf(b)],
    ["warnings", a.warnings.length, b.warnings.length],
    ["notes", ...[a, b].map(({ frames }) => frames.filter(({ note }) => note !== undefined).length)],
    ...a.warnings.map(({ code }, index) => [`warning ${index}`, code, b.warnings[index]?.code]),
    ...Object.keys(a.candidates).map((name) => [name, a.candidates[name].verdict, b.candidates[name]?.verdict]),
    ["next frame", ...[a, b].map(({ next }) => next && `${next.axis} ${next.motion}`)],
    ["the rig itself", before.input, after.input],
  ];
  return pairs.filter(([, x, y]) => differ(x, y)).map(([what, x, y]) => `${what}: ${x} -> ${y}`);
}

export function compareChecks(before, after) {
  const [a, b] = [before.report, after.report];
  const columns = {
    degrees: largest([
      degreesBetween(a.estimate.rotation, b.estimate.rotation),
      ...turnsOf(a).map((degrees, index) => Math.abs(degrees - turnsOf(b)[index])),
    ]),
    translation: listsApart(a.estimate.translation, b.estimate.translation) / before.pixel,
    report: listsApart(numbersOf(a), numbersOf(b), relative),
  };
  return {
    columns: Object.fromEntries(Object.keys(LIMITS).map((name) => [name, columns[name] ?? 0])),
    disagreements: disagreements(before, after),
  };
}
