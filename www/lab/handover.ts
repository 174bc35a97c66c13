/** Saves a file and reports it below the buttons. */

import { byId } from "../dom";
import { EngineError, type Engine } from "../engine/engine";
import type { Source } from "../engine/protocol";
import { saveBlob } from "../save";
import type { Kind } from "./kinds";
import { linkTo } from "./share";
import { originOf } from "./source";
import type { Made, Run } from "./takeaway";

const say = (words: string): void => void (byId("taken", HTMLElement).textContent = words);

function hand({ name, blob, says }: Made): void {
  saveBlob(name, blob);
  say(says ? `Saved ${name}: ${says}.` : `Saved ${name}.`);
}

function refuse(error: unknown): void {
  say(`Nothing saved: ${error instanceof Error ? error.message : String(error)}`);
}

/** A run as the Lab holds it. */
type Held = Omit<Run, "taken" | "origin" | "link"> & { source: Source };

/** One of the results at full resolution. Failures of the worker are thrown, except a cancellation by a later request. */
export async function handOver(kind: Kind, engine: Engine, { source, ...run }: Held): Promise<void> {
  try {
    const { fileOfKind, fileOfRun } = await import("./takeaway");
    if (kind === "run") return hand(fileOfRun(await engine.call("save", {})));
    const where = { origin: originOf(source), link: linkTo(run.settings) };
    hand(await fileOfKind(kind, { ...run, ...where, taken: await engine.call("take", {}) }));
  } catch (error) {
    if (!(error instanceof EngineError)) refuse(error);
    else if (error.code !== "interrupted") throw error;
  }
}
