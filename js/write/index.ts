/** Writes the results of a run to files. A separate module, loaded when something is saved. */
export { BimodalError } from "../errors.js";
export { type Cloud, writeClouds } from "../rig/write/clouds.js";
export { type NpyData, writeNpy } from "./npy.js";
export { type PngInput, writePng } from "./png.js";
export { type Entry, type Picture, type ReportInput, type RunReport, runReportHtml } from "./report.js";
export {
  type DepthPng,
  type Extent,
  type FloatRaster,
  type PoseStanding,
  type Unit,
  depthPng,
  lightCsv,
  matrixText,
  normalsPng,
  poseJson,
} from "./results.js";
