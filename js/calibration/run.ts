/** Runs the check: its module, its inputs' names and types, its slices. */
import start, { CalibrationCheck, overlay } from "../../target/check/wasm-bindgen/bimodal_stereo_check.js";
import { checkCheckOptions, checkedCandidates, checkedFrames, checkedPose, twelve } from "./check.js";
import { across, compile, lazily } from "../border.js";
import { BimodalError } from "../errors.js";
import { breathe } from "../breathe.js";
import type {
  CheckFrame,
  CheckFrameInput,
  CheckOptions,
  CheckReport,
  FrameOverlay,
  PoseInput,
} from "../types/index.js";

/** Milliseconds between two pauses for events. The page stays responsive, and the pauses take a hundredth of the time. */
const SLICE = 30;

// Written as one expression, because bundlers look for exactly this form to include the file.
const load = lazily("checkCalibration", async () =>
  start({ module_or_path: await compile(() => new URL("./bimodal_stereo_check_bg.wasm", import.meta.url)) }),
);

export async function check(
  frames: CheckFrameInput[],
  candidates: Record<string, PoseInput>,
  options: CheckOptions,
): Promise<CheckReport> {
  const views = checkedFrames(frames);
  const known = checkedCandidates(candidates);
  checkCheckOptions(options);
  const { cues, signal, onProgress } = options;
  signal?.throwIfAborted();
  await load();
  const names = known.map(([name]) => name);
  const poses = Float64Array.from(known.flatMap(([, pose]) => twelve(pose)));
  onProgress?.(0, "reading the frames");
  await breathe();
  const run = across(() => new CalibrationCheck(views, names, poses, cues ?? []));
  try {
    let last = performance.now();
    for (let done = false; !done; ) {
      done = across(() => run.step());
      if (performance.now() - last < SLICE && !done) continue;
      onProgress?.(run.share(), run.message());
      await breathe();
      signal?.throwIfAborted();
      last = performance.now();
    }
    const report = run.report();
    if (!report) throw new BimodalError("internal", "checkCalibration: ended without a report", "checkCalibration");
    // wasm returns maps in alphabetical order of their names; here the candidate being checked comes first.
    return {
      ...report,
      candidates: Object.fromEntries(names.map((name) => [name, report.candidates[name]])) as CheckReport["candidates"],
    };
  } finally {
    run.free();
  }
}

export async function project(frame: CheckFrameInput, pose: PoseInput): Promise<FrameOverlay> {
  const [view] = checkedFrames([frame]) as [CheckFrame];
  const known = checkedPose(pose);
  await load();
  return across(() => overlay(view, Float64Array.from(twelve(known)))) as FrameOverlay;
}
