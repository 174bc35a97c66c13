/** Options for loading, running, restoring and drawing an estimator, and its warnings. */
import type { EstimatorWarningCode } from "./codes.js";
import type { StepReport } from "./report.js";

/**
 * The argument of `init`: the address of the .wasm, or the .wasm itself. `bimodal_stereo_scalar_bg.wasm` works without SIMD. Node also
 * takes `file:` addresses.
 */
export type WasmSource = string | URL | Request | Response | BufferSource | WebAssembly.Module;

/** Options of `Estimator.run`. */
export interface RunOptions {
  /** The largest number of steps in this call, counting slices of the search; `Options.maxIterations` counts iterations. */
  maxIterations?: number;
  /** Ends the run between two steps; the promise is rejected with its reason. */
  signal?: AbortSignal;
  /** Called with the report of each step. */
  onStep?: (report: StepReport) => void;
}

/** Options of `Estimator.restoreAsync`. */
export interface RestoreOptions {
  /** Stops the repetition; the promise is rejected with the signal's reason. */
  signal?: AbortSignal;
}

/** A warning that the environment lacks a feature; the estimator works without it. */
export interface EstimatorWarning {
  /** Stable, for programs. */
  code: EstimatorWarningCode;
  /** The warning as a sentence. */
  message: string;
  /** The input that the warning is about, as a path in the contract. */
  field?: string;
}

/** The layers that `Estimator.draw` can show: normals, depth and residual of the image view, and the refinement of the depth view. */
export type Layer = "normals" | "depth" | "residual" | "refined" | "refinedNormals";

/** How `Estimator.draw` maps numbers to colours. Normals have a fixed mapping. */
export interface DrawOptions {
  /** The numbers at the ends of the map. Default: the range of the layer without its lowest and its highest percent. */
  range?: readonly [number, number];
  /** Default "viridis". */
  map?: "viridis" | "magma";
}
