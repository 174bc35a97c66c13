/** The check of a calibration and the rigs that it is tested on: a .wasm file of its own for each, loaded with the first call. */
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
 * Whether the frames agree with some candidates for the extrinsics of a rig, P_colour = R P_depth + t in metres; the first
 * candidate is the one in question. Needs no `init()`. Runs in slices, so that events and drawing go on, or call it in a worker.
 */
export async function checkCalibration(
  frames: CheckFrameInput[],
  candidates: Record<string, PoseInput>,
  options: CheckOptions = {},
): Promise<CheckReport> {
  const { check } = await import("./run.js");
  return check(frames, candidates, options);
}

/** Where a pose puts the depth points and depth edges of a frame on its image. */
export async function projectFrame(frame: CheckFrameInput, pose: PoseInput): Promise<FrameOverlay> {
  const { project } = await import("./run.js");
  return project(frame, pose);
}

/** One frame of a rendered rig whose extrinsics are known. */
export async function sampleRig(request: RigRequest): Promise<RigSample> {
  const { render } = await import("./rigs.js");
  return render(request);
}
