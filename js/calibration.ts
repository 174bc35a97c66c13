import { unsupported } from "./check.js";
import type { CheckFrame, CheckOptions, CheckReport, Pose } from "./types.js";

/** Which of some candidate calibrations the frames agree with. */
export async function checkCalibration(
  _frames: CheckFrame[],
  _candidates: Record<string, Pose>,
  _options?: CheckOptions,
): Promise<CheckReport> {
  throw unsupported("checkCalibration", "checking a calibration");
}
