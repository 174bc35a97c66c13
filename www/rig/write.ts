/** The package's writers, with the package's declared types. Loaded when something is saved. */

import * as write from "../../pkg/rig-write.js";
import type * as Write from "../../pkg/rig/write/index.js";

export const writePose = write.writePose as typeof Write.writePose;
export const writeClouds = write.writeClouds as typeof Write.writeClouds;
