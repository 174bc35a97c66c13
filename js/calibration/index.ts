/** The check of a calibration and the rigs that it is tested on: a separate .wasm file for each, loaded with the first call. */
import type {
  CheckFrameInput,
  CheckOptions,
  CheckReport,
  FrameOverlay,
  PoseInput,
  RigRequest,
  RigSample,
} from "../types/index.js";

/**
 * Checks whether the frames agree with candidates for the extrinsics of a rig, P_colour = R P_depth + t in metres; the first candidate is
 * the one being checked. Does not need `init()`. Runs in slices, so that events and drawing continue; it can also run in a worker.
 */
export async function checkCalibration(
  frames: CheckFrameInput[],
  candidates: Record<string, PoseInput>,
  options: CheckOptions = {},
): Promise<CheckReport> {
  const { check } = await import("./run.js");
  return check(frames, candidates, options);
}

/** Projects the depth points and depth edges of a frame into its image with a pose. */
export async function projectFrame(frame: CheckFrameInput, pose: PoseInput): Promise<FrameOverlay> {
  const { project } = await import("./run.js");
  return project(frame, pose);
}

/** One frame of a rendered rig whose extrinsics are known. */
export async function sampleRig(request: RigRequest): Promise<RigSample> {
  const { render } = await import("./rigs.js");
  return render(request);
}
