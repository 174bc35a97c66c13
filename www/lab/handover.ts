/** Hands a file over, and says so below the buttons. */

import { byId } from "../dom";
import { saveBlob } from "../save";
import type { Made } from "./takeaway";

const say = (words: string): void => void (byId("taken", HTMLElement).textContent = words);

export function hand({ name, blob, says }: Made): void {
  saveBlob(name, blob);
  say(says ? `Saved ${name}: ${says}.` : `Saved ${name}.`);
}

export function refuse(error: unknown): void {
  say(`Nothing saved: ${error instanceof Error ? error.message : String(error)}`);
}
