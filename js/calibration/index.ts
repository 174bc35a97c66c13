/** The check of a calibration, rendered rigs and pairs, and suggested masks: a separate .wasm file for each, loaded with the first call. */
import type {
  CheckFrameInput,
  CheckOptions,
  CheckReport,
  FrameOverlay,
  ColorImage,
  MaskSuggestion,
  PairKind,
  PairSample,
  PoseInput,
  RigRequest,
  RigSample,
  SuggestOptions,
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

/** Projects the depth points and depth edges of a frame into its image under a pose. */
export async function projectFrame(frame: CheckFrameInput, pose: PoseInput): Promise<FrameOverlay> {
  const { project } = await import("./run.js");
  return project(frame, pose);
}

/** One frame of a rendered rig whose extrinsics are known. */
export async function sampleRig(request: RigRequest): Promise<RigSample> {
  const { render } = await import("./rigs.js");
  return render(request);
}

/** A pair of the gallery: an object rendered for a colour camera and a depth sensor, whose pose is known. */
export async function samplePair(kind: PairKind): Promise<PairSample> {
  const { pair } = await import("./rigs.js");
  return pair(kind);
}

/**
 * Suggests the mask of an object in an 8-bit RGBA image. `marks` has OpenCV's number for each pixel: 0 background, 1 object, 2 probably
 * background, 3 probably object. Does not need `init()`, and runs in slices.
 */
export async function suggestMask(
  image: Pick<ColorImage, "width" | "height" | "data">,
  marks: Uint8Array,
  options: SuggestOptions = {},
): Promise<MaskSuggestion> {
  const { suggest } = await import("./rigs.js");
  return suggest(image, marks, options);
}
