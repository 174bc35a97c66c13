// One run of an estimator, and its report compared with the true pose.
import { degreesBetween, offBy, paperError } from "./rotations.mjs";

/** Limit of a run, ms: ten times that of the slowest real pair. A run that takes longer counts as hanging. */
const LONGEST_RUN = 600_000;

/** Options of a cell for this scene: a known light is the scene's, the initial pose may be the truth. */
export const optionsOf = ({ light, start, scale, ...rest }, made) => ({
  ...rest,
  light: light === "known" ? made.light : light,
  start: start === "truth" ? made.pose : start,
  ...(scale === "free" ? {} : { scale }),
});

/** Makes an estimator, runs it to its end and passes it on before freeing it. */
export async function withRun({ Estimator }, { image, depth }, options, look, onStart = () => {}) {
  const start = performance.now();
  const estimator = new Estimator(image, depth, options);
  try {
    onStart(estimator);
    const report = await estimator.run({ signal: AbortSignal.timeout(LONGEST_RUN) });
    return look(report, estimator, performance.now() - start);
  } finally {
    estimator.free();
  }
}

/** Compares a report with the true pose. */
export function judged(report, truth, milliseconds) {
  const { pose, status, uncertainty, rivals, message, iteration } = report;
  const degrees = degreesBetween(pose.rotation, truth.rotation);
  return {
    degrees,
    error: paperError(degrees),
    scale: pose.scale,
    ...pose.angles,
    iterations: iteration,
    status,
    milliseconds,
    rivals: rivals?.length ?? 0,
    rotation: pose.rotation,
    rotationOff: offBy(pose.rotation, truth.rotation),
    sigmas: uncertainty?.rotationDegrees ?? null,
    scaleOff: pose.scale - truth.scale,
    scaleSigma: uncertainty?.scale ?? null,
    ...(message === undefined ? {} : { message }),
  };
}
