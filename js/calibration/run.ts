/** Runs the check: its module, its inputs' names and types, its slices. */
import start, { CalibrationCheck, overlay } from "../../target/check/wasm-bindgen/bimodal_stereo_check.js";
import { checkCandidates, checkCheckOptions, checkFrames, checkPose } from "./check.js";
import { across, compile, lazily } from "../border.js";
import { BimodalError } from "../errors.js";
import { breathe } from "../breathe.js";
import type { CheckFrame, CheckOptions, CheckReport, FrameOverlay, Pose } from "../types.js";

/** Milliseconds between two breaths: a page stays responsive, and a message costs a hundredth of it. */
const SLICE = 30;

// In one piece: bundlers look for exactly this to carry the file along.
const load = lazily("checkCalibration", async () =>
  start({ module_or_path: await compile(() => new URL("./bimodal_stereo_check_bg.wasm", import.meta.url)) }),
);

const twelve = ({ rotation, translation }: Pose): number[] => [...rotation, ...translation];

export async function check(
  frames: CheckFrame[],
  candidates: Record<string, Pose>,
  options: CheckOptions,
): Promise<CheckReport> {
  checkFrames(frames);
  checkCandidates(candidates);
  checkCheckOptions(options);
  const { cues, signal, onProgress } = options;
  signal?.throwIfAborted();
  await load();
  const names = Object.keys(candidates);
  const poses = Float64Array.from(names.flatMap((name) => twelve(candidates[name] as Pose)));
  onProgress?.(0, "reading the frames");
  await breathe();
  const run = across(() => new CalibrationCheck(frames, names, poses, cues ?? []));
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
    // Maps of names come out in alphabetical order; the first candidate is the one in question.
    return {
      ...report,
      candidates: Object.fromEntries(names.map((name) => [name, report.candidates[name]])) as CheckReport["candidates"],
    };
  } finally {
    run.free();
  }
}

export async function project(frame: CheckFrame, pose: Pose): Promise<FrameOverlay> {
  checkFrames([frame]);
  checkPose(pose);
  await load();
  return across(() => overlay(frame, Float64Array.from(twelve(pose)))) as FrameOverlay;
}
