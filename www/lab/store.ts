/** The settings and their history: every change can be undone, also a reset to the defaults. */

import { defaults, type Settings, type Value } from "./settings";

/** `live` is a change by a control that is still being moved or has just been released, or a change that is undone or redone. */
export type Listener = (settings: Settings, changed: readonly string[], live: boolean) => void;

const differing = (a: Settings, b: Settings): string[] => Object.keys(a).filter((key) => a[key] !== b[key]);

export class Store {
  #now: Settings;
  #past: Settings[] = [];
  #undone: Settings[] = [];
  #listeners: Listener[] = [];
  /** The gesture of the newest change, if it may continue. */
  #gesture: object | undefined;

  constructor(initial: Settings) {
    this.#now = initial;
  }

  get settings(): Settings {
    return this.#now;
  }

  get canUndo(): boolean {
    return this.#past.length > 0;
  }

  get canRedo(): boolean {
    return this.#undone.length > 0;
  }

  listen(listener: Listener): void {
    this.#listeners.push(listener);
  }

  /** All changes of one `gesture`, such as a drag with pauses, are one step of undo. */
  change(patch: Record<string, Value>, live = false, gesture?: object): void {
    const next = { ...this.#now, ...patch };
    if (differing(next, this.#now).length === 0) return;
    if (gesture === undefined || gesture !== this.#gesture) this.#past.push(this.#now);
    this.#gesture = gesture;
    this.#undone = [];
    this.#become(next, live);
  }

  /** Shows the settings of an existing run, without running anything. */
  adopt(patch: Settings): void {
    const next = { ...this.#now, ...patch };
    if (differing(next, this.#now).length === 0) return;
    this.#past.push(this.#now);
    this.#undone = [];
    this.#gesture = undefined;
    this.#now = next;
    for (const listener of this.#listeners) listener(next, [], false);
  }

  /** Fills in values, such as guesses, that are not a step of undo and do not start a run. */
  complete(patch: Settings): void {
    const isNew = Object.entries(patch).some(([key, value]) => value !== (this.#now[key] ?? null));
    // A change would overwrite what the visitor is typing.
    if (!isNew) return;
    const next = { ...this.#now, ...patch };
    this.#now = next;
    for (const listener of this.#listeners) listener(next, [], false);
  }

  resetToDefaults(): void {
    this.change(defaults);
  }

  undo(): void {
    const before = this.#past.pop();
    if (!before) return;
    this.#gesture = undefined;
    this.#undone.push(this.#now);
    this.#become(before, true);
  }

  redo(): void {
    const after = this.#undone.pop();
    if (!after) return;
    this.#gesture = undefined;
    this.#past.push(this.#now);
    this.#become(after, true);
  }

  #become(next: Settings, live: boolean): void {
    const changed = differing(next, this.#now);
    this.#now = next;
    for (const listener of this.#listeners) listener(next, changed, live);
  }
}
