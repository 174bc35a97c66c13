/** The package's readers of recordings, with the package's declared types. */

import * as recordings from "../../pkg/rig-recordings.js";
import type * as Recordings from "../../pkg/rig/recordings/index.js";

export type { Recording, Robot, Topic } from "../../pkg/rig/recordings/index.js";

export const connectRobot = recordings.connectRobot as typeof Recordings.connectRobot;
export const openRecording = recordings.openRecording as typeof Recordings.openRecording;
