import { unsupported } from "./check.js";
import type { CalibrationPair, CheckOptions, CheckReport, Pose } from "./types.js";

/** Which of some candidate calibrations the pairs agree with. */
export async function checkCalibration(
  _pairs: CalibrationPair[],
  _candidates: Record<string, Pose>,
  _options?: CheckOptions,
): Promise<CheckReport> {
  throw unsupported("checkCalibration", "checking a calibration");
}
