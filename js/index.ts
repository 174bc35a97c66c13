/** Entry for browsers, bundlers and Node. */
import { load } from "./engine.js";
import type { WasmSource } from "./types/index.js";
import { wasmUrl } from "./wasm.js";

export { checkCalibration, projectFrame, samplePair, sampleRig, suggestMask } from "./calibration/index.js";
export { BimodalError, type ErrorCode, type ErrorDetails } from "./errors.js";
export { Estimator, type Given } from "./estimator.js";
export {
  basRelief,
  characteristicStrips,
  integrateNormals,
  pixelLandscape,
  secondOrder,
  shadeLamp,
} from "./lessons.js";
export { sample, sampleBound, sampleLights, sampleSurfaces, shadeNormals, turnLight } from "./samples.js";
export type * from "./types/index.js";
export { wasmUrl } from "./wasm.js";

/** Loads the numerics. Without an argument the .wasm file beside this module is loaded, as named by `wasmUrl`; in Node it is read from disk. */
export default function init(wasm?: WasmSource): Promise<void> {
  return load(() => wasm ?? wasmUrl());
}
