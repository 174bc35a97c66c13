/**
 * Entry for the Python package in Pyodide (python/pyodide/_native.py), whose calls cannot wait: everything is loaded at once, and nothing runs
 * in slices. Names and types are those of the package; inputs are checked as for every other caller.
 */
import {
  CalibrationCheck,
  initSync as startCheck,
  overlay,
} from "../target/check/wasm-bindgen/bimodal_stereo_check.js";
import {
  Segmentation,
  initSync as startRigs,
  samplePair as pair,
  sampleRig as rig,
} from "../target/rigs/wasm-bindgen/bimodal_stereo_rigs.js";
import { across } from "./border.js";
import { checkCheckOptions, checkedCandidates, checkedFrames, checkedPose, twelve } from "./calibration/check.js";
import { loadNow } from "./engine.js";
import { BimodalError } from "./errors.js";
import type {
  CheckFrame,
  CheckFrameInput,
  CheckReport,
  FrameOverlay,
  MaskSuggestion,
  PairKind,
  PairSample,
  PoseInput,
  RigRequest,
  RigSample,
} from "./types/index.js";

export { Estimator } from "./estimator.js";
export {
  basRelief,
  characteristicStrips,
  integrateNormals,
  pixelLandscape,
  secondOrder,
  shadeLamp,
} from "./lessons.js";
export { sample, sampleBound, sampleLights, sampleSurfaces, shadeNormals, turnLight } from "./samples.js";

/** Compiles and starts the three modules, whose bytes are given. */
export function start(method: BufferSource, check: BufferSource, rigs: BufferSource): void {
  loadNow(new WebAssembly.Module(method));
  startCheck({ module: new WebAssembly.Module(check) });
  startRigs({ module: new WebAssembly.Module(rigs) });
}

export function checkCalibration(
  frames: CheckFrameInput[],
  candidates: Record<string, PoseInput>,
  cues: string[] | undefined,
  onProgress: (share: number, message: string) => void,
): CheckReport {
  const views = checkedFrames(frames);
  const known = checkedCandidates(candidates);
  checkCheckOptions({ cues });
  const names = known.map(([name]) => name);
  const poses = Float64Array.from(known.flatMap(([, pose]) => twelve(pose)));
  const run = across(() => new CalibrationCheck(views, names, poses, cues ?? []));
  try {
    for (let done = false; !done; ) {
      done = across(() => run.step());
      onProgress(run.share(), run.message());
    }
    const report = run.report();
    if (!report) throw new BimodalError("internal", "checkCalibration: ended without a report", "checkCalibration");
    const ordered = Object.fromEntries(names.map((name) => [name, report.candidates[name]]));
    return { ...report, candidates: ordered as CheckReport["candidates"] };
  } finally {
    run.free();
  }
}

export function projectFrame(frame: CheckFrameInput, pose: PoseInput): FrameOverlay {
  const [view] = checkedFrames([frame]) as [CheckFrame];
  return across(() => overlay(view, Float64Array.from(twelve(checkedPose(pose))))) as FrameOverlay;
}

export function sampleRig({ kind, seed = 0, frame = 0, noise, motion }: RigRequest): RigSample {
  // Python passes null if there is no motion.
  const moved = motion ? Float64Array.from(twelve(checkedPose(motion, "motion"))) : undefined;
  return across(() => rig(kind, seed, frame, noise, moved));
}

export const samplePair = (kind: PairKind): PairSample => across(() => pair(kind));

export function suggestMask(data: Uint8Array, marks: Uint8Array, width: number, height: number): MaskSuggestion {
  const found = across(() => new Segmentation(width, height, data, marks));
  try {
    for (;;) {
      const [round = 0, changed = 0, share = 0, isLast] = across(() => found.step());
      if (isLast) return { mask: across(() => found.mask()), share, rounds: round, changed };
    }
  } finally {
    found.free();
  }
}

/** Plain objects for Python as text, because JSON knows neither NaN nor typed arrays. */
export const text = (value: unknown): string =>
  JSON.stringify(value, (_, each) => (ArrayBuffer.isView(each) ? Array.from(each as unknown as number[]) : each));
