/** How an estimator is loaded, run, restored and drawn, and what it warns of. */
import type { EstimatorWarningCode } from "./codes.js";
import type { StepReport } from "./report.js";

/** What `init` takes: where the .wasm is, or the .wasm itself; `bimodal_stereo_scalar_bg.wasm` needs no SIMD. Node also takes `file:` addresses. */
export type WasmSource = string | URL | Request | Response | BufferSource | WebAssembly.Module;

/** How `Estimator.run` runs. */
export interface RunOptions {
  /** At most so many steps in this call, slices of the search included; `Options.maxIterations` counts iterations. */
  maxIterations?: number;
  /** Ends the run between two steps; the promise is rejected with its reason. */
  signal?: AbortSignal;
  /** Called with the report of each step. */
  onStep?: (report: StepReport) => void;
}

/** How `Estimator.restoreAsync` restores. */
export interface RestoreOptions {
  /** Breaks the repetition off; the promise is rejected with its reason. */
  signal?: AbortSignal;
}

/** What the place where an estimator runs lacks, and what the estimator does without. */
export interface EstimatorWarning {
  /** Stable, for programs. */
  code: EstimatorWarningCode;
  /** The same in a sentence. */
  message: string;
  /** The input that it is about, as a path in the contract. */
  field?: string;
}

/** What `Estimator.draw` can show: of the image view its normals, depth and residual, of the depth view what was refined. */
export type Layer = "normals" | "depth" | "residual" | "refined" | "refinedNormals";

/** How `Estimator.draw` turns numbers into colours; normals have theirs. */
export interface DrawOptions {
  /** The numbers at the map's ends; default: all of the layer's but a hundredth at either end. */
  range?: readonly [number, number];
  /** Default "viridis". */
  map?: "viridis" | "magma";
}
