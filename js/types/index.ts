/** The public contract: what goes in and what comes out. No value is hidden behind `any`. */
export type * from "./cameras.js";
export type * from "./images.js";
export type * from "./poses.js";
export type * from "./options.js";
export type * from "./codes.js";
export type * from "./report.js";
export type * from "./estimator.js";
export type * from "./check.js";
export type * from "./samples.js";
export type * from "./lessons.js";
