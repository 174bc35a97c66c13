// Condenses an answer into figures small enough to be committed: the pose in full, rasters by sums and samples.
import { createHash } from "node:crypto";

/**
 * Number of values that are kept of each raster, evenly spread over the pixels that have one. Points are not kept, because they follow from
 * depths and pose.
 */
const SAMPLES = {
  ...{ imageDepth: 24, refinedDepth: 24, imageNormals: 18, depthNormals: 18 },
  ...{ residual: 6, imagePoints: 0, depthPoints: 0 },
};
/** Decimals of rasters (pixels, components of a unit normal) and of the light. */
const DECIMALS = 6;
/** Significant digits of numbers in a report, and of poses, whose limits are tighter. */
const DIGITS = 7;
const POSE_DIGITS = 12;

const fixed = (value) => Number(value.toFixed(DECIMALS));
const hash = ({ buffer, byteOffset, byteLength }) =>
  createHash("sha256")
    .update(new Uint8Array(buffer, byteOffset, byteLength))
    .digest("hex")
    .slice(0, 8);

/** The pixels that have values, with their number, mean, spread and samples. */
function rasterFigure(values, count) {
  const there = values.filter((value) => !Number.isNaN(value));
  const pattern = hash(Uint8Array.from(values, (value) => (Number.isNaN(value) ? 0 : 1)));
  if (there.length === 0) return { pattern, count: 0, values: [] };
  const mean = there.reduce((sum, value) => sum + value, 0) / there.length;
  const spread = Math.sqrt(there.reduce((sum, value) => sum + (value - mean) ** 2, 0) / there.length);
  const samples = Array.from(
    { length: count },
    (_, index) => there[Math.floor(((index + 0.5) / count) * there.length)],
  );
  return { pattern, count: there.length, values: [mean, spread, ...samples].map(fixed) };
}

/** Every number of a report, rounded; angles are left out, since they follow from the rotation. */
function rounded(value, digits = DIGITS) {
  if (typeof value === "number") return Number(value.toPrecision(digits));
  if (Array.isArray(value)) return value.map((item) => rounded(item, digits));
  if (typeof value !== "object" || value === null) return value;
  const precise = "rotation" in value;
  const entries = Object.entries(value).filter(([key, item]) => key !== "angles" && item !== undefined);
  return Object.fromEntries(entries.map(([key, item]) => [key, rounded(item, precise ? POSE_DIGITS : digits)]));
}

/** The minimum and the mean of a curve of the log likelihood. */
function curveFigure({ values, ...curve }) {
  const mean = values.reduce((sum, value) => sum + value, 0) / values.length;
  return { ...curve, offsets: [], values: [Math.min(...values), mean] };
}

export const figureOfCheck = ({ input, report, pixel }) => ({
  input,
  report: rounded({ ...report, sensitivity: report.sensitivity.map(curveFigure) }),
  pixel: rounded(pixel),
});

export const figureOf = ({ input, report, endedBy, light, pixel, correspondence, rasters }) => ({
  input,
  report: rounded(report),
  endedBy,
  light: light.map(fixed),
  pixel: rounded(pixel),
  correspondence: { pattern: hash(correspondence), count: correspondence.filter((depth) => depth >= 0).length },
  rasters: Object.fromEntries(
    Object.entries(SAMPLES).map(([name, count]) => [name, rasterFigure(rasters[name], count)]),
  ),
});

/** Comparison of the figures that condense answers. */
export const SAMPLED = {
  rasterApart(a, b) {
    if (a.pattern !== b.pattern || a.values.length !== b.values.length) return Infinity;
    return a.values.reduce((most, value, index) => Math.max(most, Math.abs(value - b.values[index])), 0);
  },
  pairsApart: (a, b) =>
    a.pattern === b.pattern ? undefined : `${a.count} -> ${b.count} pixels, or other correspondences`,
};
