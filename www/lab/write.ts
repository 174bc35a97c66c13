/** The package's writers of a run, with the package's declared types. Loaded when something is saved. */

import * as write from "../../pkg/write.js";
import type * as Write from "../../pkg/write/index.js";

export type { Entry, Picture, ReportInput, RunReport, Unit } from "../../pkg/write/index.js";

export const writeClouds = write.writeClouds as typeof Write.writeClouds;
export const writeNpy = write.writeNpy as typeof Write.writeNpy;
export const depthPng = write.depthPng as typeof Write.depthPng;
export const normalsPng = write.normalsPng as typeof Write.normalsPng;
export const poseJson = write.poseJson as typeof Write.poseJson;
export const matrixText = write.matrixText as typeof Write.matrixText;
export const lightCsv = write.lightCsv as typeof Write.lightCsv;
export const runReportHtml = write.runReportHtml as typeof Write.runReportHtml;
export const writePng = write.writePng as typeof Write.writePng;
