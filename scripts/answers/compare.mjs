// Differences between two answers to one scene, and their limits.
import { degreesBetween } from "../../protocols/rotations.mjs";

/**
 * Largest differences allowed for a refactoring that only reorders sums. Lengths are in pixels: the unit of an orthographic view, or a
 * pixel's size at the middle of the surface for a view with a camera. At 128 pixels and more, one bit of a 32-bit depth is 1.5e-5.
 */
export const LIMITS = {
  /** Rotations of the pose and of its rivals. */
  degrees: 1e-6,
  /** Relative limit of the scale. It moves a point 80 pixels from the middle as far as a height may move. */
  scale: 1e-7,
  translation: 1e-5,
  /** `imageDepth` and `refinedDepth`. */
  heights: 1e-5,
  /** `imageNormals` and `depthNormals`. */
  normals: 1e-5,
  /** Limit of coefficients and of residuals of log S. */
  light: 1e-5,
  residual: 1e-5,
  /** `points` of both views. */
  points: 1e-5,
  /** Relative limit of objective terms, overlap, inliers, residual and sigmas. The last change of the rotation has the limit `degrees`. */
  report: 1e-5,
};
/** Factor on the limits of results with a given reason (reasons.mjs): 1e-3 degrees. */
export const EXCUSED = 1000;
/** Numbers of a report below this are compared absolutely. */
const LEAST_NUMBER = 1e-6;

/** The rasters to which each limit applies; lengths are in pixels. */
const RASTERS = {
  heights: ["imageDepth", "refinedDepth"],
  normals: ["imageNormals", "depthNormals"],
  residual: ["residual"],
  points: ["imagePoints", "depthPoints"],
};

const apart = (a, b) => (a === b ? 0 : Math.abs(a - b));
export const relative = (a, b) => apart(a, b) / Math.max(Math.abs(a), Math.abs(b), LEAST_NUMBER);
/** Largest of some differences; NaN counts as infinite. */
export const largest = (values) =>
  values.reduce((most, value) => (value <= most ? most : Number.isNaN(value) ? Infinity : value), 0);

/** Largest difference of two lists; `null` and a missing list equal only themselves. */
export function listsApart(a, b, measure = apart) {
  if (!a || !b || a.length !== b.length) return (a ?? null) === (b ?? null) ? 0 : Infinity;
  return largest(
    a.map((value, index) => ((value === null) !== (b[index] === null) ? Infinity : measure(value, b[index]))),
  );
}

/** All numbers of a report except poses and counts. */
function numbersOf({ energy, overlap, inliers, residual, uncertainty }) {
  const { rotationDegrees = [], translation = [], scale = null } = uncertainty ?? {};
  return [
    ...Object.keys(energy)
      .sort()
      .map((term) => energy[term]),
    overlap,
    inliers,
    residual,
    ...rotationDegrees,
    ...translation,
    scale,
  ];
}

/** The code of a reason; older packages have no codes. */
export const codeOf = ({ reason }) => reason?.code;
/** Whether both answers report a value and the values differ. */
export const differ = (a, b) => a !== undefined && b !== undefined && a !== b;

/** The numbers of a message; its wording may change. */
const numbersIn = (message = "") => message.match(/-?\d+(\.\d+)?(e-?\d+)?/g)?.join(" ") ?? "";

/** The members that have to be equal but are not, in words. */
function disagreements(before, after) {
  const [a, b] = [before.report, after.report];
  const list = ["status", "iteration", "stage"]
    .filter((key) => a[key] !== b[key])
    .map((key) => `${key}: ${a[key]} -> ${b[key]}`);
  const count = ({ rivals = [] }) => rivals.length;
  if (count(a) !== count(b)) list.push(`rivals: ${count(a)} -> ${count(b)}`);
  if (a.uncertainty?.weakest !== b.uncertainty?.weakest)
    list.push(`weakest: ${a.uncertainty?.weakest} -> ${b.uncertainty?.weakest}`);
  if (numbersIn(a.message) !== numbersIn(b.message)) list.push(`message: ${a.message} -> ${b.message}`);
  for (const [what, x, y] of [
    ["reason", codeOf(a), codeOf(b)],
    ["ended by", before.endedBy, after.endedBy],
  ]) {
    if (differ(x, y)) list.push(`${what}: ${x} -> ${y}`);
  }
  if (before.input !== after.input) list.push("the pair itself: `sample` renders other numbers");
  return list;
}

/**
 * Compares two answers, or two figures of answers. `rasterApart(a, b)` is the largest difference of two rasters, or Infinity if different
 * pixels have values. `pairsApart(a, b)` describes the differences of the correspondences, if there are any.
 */
export function compare(before, after, { rasterApart, pairsApart }) {
  const [a, b] = [before.report, after.report];
  const column = (rasters) => largest(rasters.map((name) => rasterApart(before.rasters[name], after.rasters[name])));
  const rivals = (a.rivals ?? []).map(({ rotation }, index) =>
    degreesBetween(rotation, b.rivals?.[index]?.rotation ?? rotation),
  );
  const columns = {
    degrees: largest([
      degreesBetween(a.pose.rotation, b.pose.rotation),
      apart(a.rotationChange, b.rotationChange),
      ...rivals,
    ]),
    scale: relative(a.pose.scale, b.pose.scale),
    translation: listsApart(a.pose.translation, b.pose.translation) / before.pixel,
    light: listsApart(before.light, after.light),
    report: listsApart(numbersOf(a), numbersOf(b), relative),
  };
  for (const [name, rasters] of Object.entries(RASTERS)) columns[name] = column(rasters);
  const pairs = pairsApart(before.correspondence, after.correspondence);
  return {
    columns: Object.fromEntries(Object.keys(LIMITS).map((name) => [name, columns[name]])),
    disagreements: [...disagreements(before, after), ...(pairs ? [`correspondence: ${pairs}`] : [])],
    reworded: a.message === b.message ? undefined : [a.message, b.message],
  };
}

/** Comparison of whole answers. */
export const WHOLE = {
  rasterApart(a, b) {
    if (a.length !== b.length) return Infinity;
    let most = 0;
    for (let index = 0; index < a.length; index++) {
      if (Number.isNaN(a[index]) !== Number.isNaN(b[index])) return Infinity;
      // The difference is NaN where no answer has a value, so the comparison is false.
      const difference = apart(a[index], b[index]);
      if (difference > most) most = difference;
    }
    return most;
  },
  pairsApart(a, b) {
    const differ = a.reduce(
      (count, depth, index) => count + (depth === b[index] ? 0 : 1),
      Math.abs(a.length - b.length),
    );
    return differ === 0 ? undefined : `${differ} of ${a.length} pixels have another correspondence`;
  },
};
