/** Repeats a run in another worker, up to the report that is on the screen. */

import type { StepReport } from "../../pkg/index.js";
import type { Engine } from "../engine/engine";
import type { Frame, Source } from "../engine/protocol";
import type { Gallery } from "./gallery";
import { runOptions, type Settings } from "./settings";
import { belongings, originOf, readable } from "./source";

const isThere = (now: StepReport, reached: StepReport): boolean =>
  now.status !== "running" ||
  now.iteration > reached.iteration ||
  (now.iteration === reached.iteration && now.stage === reached.stage && now.reason?.code === reached.reason?.code);

/** The frame at this report; undefined once the run is no longer wanted. */
export async function repeated(
  { source, settings }: { source: Source; settings: Settings },
  reached: StepReport,
  engine: Engine,
  gallery: Gallery,
  isWanted: () => boolean,
): Promise<Frame | undefined> {
  const input = await readable(source, () => {});
  if (!isWanted()) return undefined;
  const options = runOptions(settings, originOf(source));
  let { frame } = await engine.call("open", { source: input, options, look: gallery.look }, belongings(input));
  while (isWanted()) {
    const now = frame.reports.at(-1);
    if (!now || isThere(now, reached)) return frame;
    const by = now.iteration < reached.iteration ? "step" : "stage";
    frame = await engine.call("advance", { by, milliseconds: 0, look: gallery.look });
  }
  return undefined;
}
