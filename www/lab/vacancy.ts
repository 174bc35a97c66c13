/** A placeholder for the surfaces while those of another pair are awaited. It says what to add or what is being done. */

import { byId } from "../dom";
import type { Source } from "../engine/protocol";
import { sentence } from "./verdict";

const lab = (): HTMLElement => byId("lab", HTMLElement);

/** Nothing of the previous pair stays visible. */
export function vacate(): void {
  byId("iteration", HTMLElement).textContent = "0";
  lab().toggleAttribute("data-vacant", true);
}

export function fill(): void {
  lab().removeAttribute("data-vacant");
}

const BOTH = "Drop a colour image and a depth map of one object anywhere on this page.";

/** `wanted` is the requested input, or what it lacks; `notice` is the status message. Files that are present are not requested. */
export function sayVacant(wanted: Source | string, notice: { state: string; words: string } | undefined): void {
  const lacking = typeof wanted === "string" ? /^waiting for (a .+)$/.exec(wanted)?.[1] : undefined;
  const { state = "", words = "" } = notice ?? {};
  const isThere = typeof wanted !== "string" || state === "loading" || wanted.includes("camera:");
  const drop = lacking ? `Drop ${lacking} of the same object anywhere on this page.` : BOTH;
  const says = isThere && words ? sentence(words) : drop;
  const hero = byId("hero", HTMLElement);
  // This is checked in every frame.
  if (hero.dataset.says !== says) hero.dataset.says = says;
}
