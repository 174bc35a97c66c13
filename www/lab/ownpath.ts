/** Connects the short path for own files with the Lab. Loaded with its first opening. */

import { byId } from "../dom";
import { FirstRun } from "./firstrun";
import type { OwnFiles } from "./ownfiles";
import type { Slot } from "./storage";
import type { Store } from "./store";

const SLOTS: readonly Slot[] = ["colour", "depth", "colourMask"];

let path: FirstRun | undefined;

/** Copies the preview of a slot; the last step shows the picture again. */
function thumbnail(own: OwnFiles, step: number, canvas: HTMLCanvasElement): void {
  const { colourMask, depthMask } = own.intake.files;
  const slot = step === 2 && !colourMask && depthMask ? "depthMask" : SLOTS[step];
  const source = slot && own.intake.placeOf(slot)?.querySelector<HTMLCanvasElement>("canvas.thumb");
  const isThere = source instanceof HTMLCanvasElement && !source.hidden && source.width > 1;
  canvas.hidden = !isThere;
  if (!isThere) return;
  canvas.width = source.width;
  canvas.height = source.height;
  canvas.getContext("2d")?.drawImage(source, 0, 0);
}

/** The Lab's message about a pair that it cannot run. */
function trouble(): string {
  const isWrong = byId("status", HTMLElement).dataset.state === "error";
  return isWrong ? byId("verdict", HTMLElement).textContent : "";
}

export function openPath(own: OwnFiles, store: Store, { play }: { play(): void }): void {
  const listeners: (() => void)[] = [];
  const tell = () => listeners.forEach((listen) => listen());
  if (!path) {
    const { intake } = own;
    const first = new FirstRun({
      files: () => intake.files,
      settings: () => store.settings,
      listen: (onChange) => listeners.push(onChange),
      placeOf: (slot) => intake.placeOf(slot),
      notes: () => intake.notes,
      drop: (files) => void own.drop(files),
      replace: (files) => intake.replaceAll(files),
      draw: (side) => void (side === "colour" ? own.drawMask() : own.drawDepthMask()),
      trouble,
      run: play,
      thumbnail: (step, canvas) => thumbnail(own, step, canvas),
    });
    path = first;
    own.onFiles = () => {
      first.filesChanged();
      tell();
    };
    store.listen(tell);
    // The Lab opens the pair meanwhile, and says what is wrong with it.
    new MutationObserver(() => first.filesChanged()).observe(byId("status", HTMLElement), { attributes: true });
  }
  path.open();
}
