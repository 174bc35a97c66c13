/**
 * The options, one row for each member of `Options` and of `SampleRequest`: type, range, default, unit, and the page's words. The checks of
 * this facade, its plain copies and the page's fields are all made from these rows, in their order. Defaults and ranges are those of
 * `src/options.rs` and `src/scenes/sample.rs`, which check what native callers give; `tests/contract/options.test.mjs` checks that both
 * agree.
 */
import type { NumberRow, RowsOf } from "./rows.js";
import type { Options, Pose, SampleRequest } from "./types/index.js";

export { paths, type PageField, type Row, type Rows, type ShownRow } from "./rows.js";

/** A larger angle is a mistake rather than a rotation; at very large angles a sine has no accuracy. */
const FULL_TURN = 360;
const angle: NumberRow & { default: number } = {
  kind: "number",
  min: -FULL_TURN,
  max: FULL_TURN,
  unit: "deg",
  default: 0,
};
/** A term with a million times the weight of the colours would leave only their rounding errors. */
const weight = { kind: "number", min: 0, max: 1e6 } as const;
/** The largest integer that JavaScript's numbers represent without gaps; a random generator accepts all of them. */
const seed = { kind: "whole", min: 0, max: Number.MAX_SAFE_INTEGER, default: 1 } as const;
const side = { kind: "side", min: 16, max: 1024, unit: "px" } as const;

/** A pose without its matrix, which is converted to the other members before any check. */
type PlainPose = Partial<Omit<Pose, "matrix">>;
/** Options whose pose has been converted to members. */
export type PlainOptions = Omit<Options, "start"> & { start?: "search" | "identity" | PlainPose };

export const POSE: RowsOf<PlainPose> = {
  scale: { kind: "number", above: 0 },
  rotation: { kind: "list", length: 9 },
  translation: { kind: "list", length: 3 },
  angles: { kind: "object", noun: "angles", members: { alpha: angle, beta: angle, gamma: angle } },
};

export const OPTIONS: RowsOf<PlainOptions> = {
  /** Nine coefficients for each of three channels. */
  light: { kind: "list", length: 27, words: { estimate: "estimate" }, default: "estimate" },
  prior: {
    kind: "object",
    noun: "a Gaussian over lights",
    members: { mean: { kind: "list", length: 27 }, covariance: { kind: "matrix", side: 27 } },
    required: ["mean", "covariance"],
  },
  start: {
    kind: "object",
    noun: "a pose",
    members: POSE,
    words: { search: "search", identity: "identity" },
    default: "search",
  },
  startTolerance: {
    kind: "object",
    noun: "a tolerance",
    members: {
      degrees: { kind: "number", above: 0, unit: "deg", default: 30 },
      distance: { kind: "number", above: 0 },
    },
  },
  registration: {
    kind: "word",
    words: { joint: "joint", icp: "ICP", fixed: "keep start" },
    default: "joint",
    page: {
      group: "method",
      label: "Registration",
      hint: "Joint: pose and light from the image residuals. ICP and RANSAC: as in the paper. Or keep the initial pose.",
    },
  },
  shading: {
    kind: "word",
    words: { surface: "surface", pixel: "pixel" },
    default: "surface",
    page: {
      group: "method",
      label: "Shading",
      hint: "The surface as a whole, or independent pixels as in the paper.",
    },
  },
  scale: {
    kind: "number",
    above: 0,
    words: { free: "free" },
    default: "free",
    page: { group: "method", label: "Scale", hint: "Enter a number to fix the scale." },
  },
  trim: {
    kind: "flag",
    default: true,
    page: { group: "method", label: "Trim", hint: "Leave out flying pixels and background inside the mask." },
  },
  annealing: { kind: "flag", default: true },
  lambda: {
    kind: "object",
    noun: "weights",
    members: {
      prior: {
        ...weight,
        default: 0.05,
        page: {
          group: "weights",
          label: "λ shape prior",
          hint: "Weight of the other view's normal as a prior.",
          slider: { min: -4, max: 2, step: 0.1, log: true },
        },
      },
      unit: { ...weight, default: 1, page: { group: "weights", label: "λ unit length", link: "unitLength" } },
      light: {
        ...weight,
        default: 1e-6,
        page: {
          group: "weights",
          label: "λ light",
          link: "lightPrior",
          hint: "Weight of the prior over natural lights.",
          slider: { min: -8, max: 0, step: 0.2, log: true },
        },
      },
      refinement: {
        ...weight,
        default: 0.01,
        page: { group: "weights", label: "λ refinement", slider: { min: -4, max: 1, step: 0.1, log: true } },
      },
    },
  },
  stopDegrees: {
    kind: "number",
    above: 0,
    unit: "deg",
    default: 0.01,
    page: {
      group: "loop",
      label: "Stop below",
      link: "stop",
      hint: "The loop converges once the rotation changes by less than this.",
    },
  },
  tolerance: {
    kind: "number",
    above: 0,
    unit: "deg",
    default: 1.5,
    page: {
      group: "loop",
      label: "Tolerance",
      hint: "A run whose rotation is less certain than this (one sigma) ends as ambiguous.",
    },
  },
  /** More iterations are probably a typing error. */
  maxIterations: {
    kind: "whole",
    min: 1,
    max: 100_000,
    default: 60,
    page: { group: "loop", label: "Iterations", link: "iterations", hint: "Maximum number of iterations." },
  },
  correspondenceDistance: {
    kind: "number",
    above: 0,
    unit: "px",
    page: {
      group: "loop",
      label: "Match within",
      link: "distance",
      hint: "Accepted distance of a correspondence.",
      empty: "auto",
    },
  },
  seed: { ...seed, page: { group: "loop", label: "Seed" } },
  /** More threads would wait for one another. */
  workers: { kind: "whole", min: 1, max: 16, default: 1 },
};

/** The rows of all members except `surface` and `light`, whose names only the built module knows. */
export const SAMPLE: RowsOf<Omit<SampleRequest, "surface" | "light">> = {
  size: { ...side, default: 64 },
  height: side,
  protocol: {
    kind: "word",
    words: { rendered: "rendered", grid: "bare grid" },
    default: "rendered",
    page: {
      group: "sample",
      label: "Protocol",
      hint: "Rendered: as cameras see the surface. Bare grid: every eighth sample of it, with the same points in both views, as the paper may have done.",
    },
  },
  angles: {
    kind: "object",
    noun: "angles",
    members: {
      // A missing angle is zero. If all angles are missing, beta has the page's default.
      beta: {
        ...angle,
        page: {
          group: "sample",
          label: "Rotation β",
          hint: "The true rotation about the vertical axis.",
          initial: 20,
          slider: { min: -90, max: 90, step: 1 },
        },
      },
      alpha: { ...angle, page: { group: "sample", label: "Rotation α" } },
      gamma: { ...angle, page: { group: "sample", label: "Rotation γ" } },
    },
  },
  scale: {
    kind: "number",
    above: 0,
    default: 1,
    page: {
      group: "sample",
      label: "True scale",
      link: "trueScale",
      hint: "Scale to be found: the depth view is smaller by this factor.",
    },
  },
  noise: {
    kind: "number",
    min: 0,
    default: 0,
    page: {
      group: "sample",
      label: "Colour noise",
      hint: "Gaussian, on the logarithm of the intensity.",
      slider: { min: 0, max: 0.2, step: 0.005 },
    },
  },
  overlap: {
    kind: "number",
    above: 0,
    max: 1,
    default: 1,
    page: {
      group: "sample",
      label: "Overlap",
      hint: "Share of the depth map's columns that is kept.",
      slider: { min: 0.1, max: 1, step: 0.05 },
    },
  },
  depthNoise: { kind: "number", min: 0, unit: "px", default: 0, page: { group: "sample", label: "Depth noise" } },
  holes: {
    kind: "number",
    min: 0,
    below: 1,
    default: 0,
    page: { group: "sample", label: "Holes", hint: "Share of the depth pixels that is lost." },
  },
  seed: {
    ...seed,
    page: {
      group: "sample",
      label: "Noise seed",
      link: "draw",
      hint: "A different number gives different noise and holes.",
    },
  },
};

/** Members that the grid protocol would silently ignore. */
export const RENDERED_ALONE: readonly string[] = ["size", "height", "scale", "noise", "depthNoise", "holes", "seed"];
