/** Everything but `init`, which differs between browsers and Node. */
export { checkCalibration } from "./calibration.js";
export { BimodalError } from "./errors.js";
export { Estimator } from "./estimator.js";
export { sample, sampleBound, sampleLights, sampleSurfaces } from "./samples.js";
export type * from "./types.js";
export { wasmUrl } from "./wasm.js";
