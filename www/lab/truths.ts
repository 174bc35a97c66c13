/** True poses of rendered pairs, by their files, for as long as the page is open. */

import type { Pose } from "../../pkg/index.js";

const known = new WeakMap<File, { colour: File; pose: Pose }>();

export function keepTruth({ colour, depth }: { colour: File; depth: File }, pose: Pose): void {
  known.set(depth, { colour, pose });
}

/** The true pose between two files, unless one of them is of another pair. */
export function truthOf(colour: File, depth: File): Pose | undefined {
  const truth = known.get(depth);
  return truth?.colour === colour ? truth.pose : undefined;
}
