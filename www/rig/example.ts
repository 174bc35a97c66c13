/** The example: three frames of one rendered rig, whose calibration is known, and a calibration that is off by a known amount. */

import { sampleRig, type CheckFrame } from "../../pkg/index.js";
import type { NamedPose } from "./files";
import { fromEuler, poseOf, times } from "./poses";

export interface Example {
  frames: CheckFrame[];
  poses: NamedPose[];
}

/** Degrees about y, the axis from top to bottom, by which the example's calibration is off. */
const OFF = 2;
const FRAMES = 3;
const SEED = 1;

export async function loadExample(): Promise<Example> {
  const samples = [];
  for (let frame = 0; frame < FRAMES; frame++) samples.push(await sampleRig({ kind: "sheet", seed: SEED, frame }));
  const frames = samples.map(({ image, depth }, i) => ({ name: `frame ${i + 1}`, image, depth }));
  const [first] = samples;
  if (!first) return { frames, poses: [] };
  const { rotation, translation } = first.pose;
  const told = poseOf(times(fromEuler(0, OFF, 0, "xyz"), rotation), translation);
  const ends = { from: "depth", to: "colour" };
  return {
    frames,
    poses: [
      { ...ends, name: `${OFF}° off`, pose: told },
      { ...ends, name: "as rendered", pose: first.pose },
    ],
  };
}
