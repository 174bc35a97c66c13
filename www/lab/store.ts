/** The settings and what they were before: every change can be undone, a reset to the defaults too. */

import { defaults, type Settings, type Value } from "./settings";

export type Listener = (settings: Settings, changed: readonly string[]) => void;

const differing = (a: Settings, b: Settings): string[] => Object.keys(a).filter((key) => a[key] !== b[key]);

export class Store {
  #now: Settings;
  #past: Settings[] = [];
  #listeners: Listener[] = [];

  constructor(initial: Settings) {
    this.#now = initial;
  }

  get settings(): Settings {
    return this.#now;
  }

  get canUndo(): boolean {
    return this.#past.length > 0;
  }

  listen(listener: Listener): void {
    this.#listeners.push(listener);
  }

  change(patch: Record<string, Value>): void {
    const next = { ...this.#now, ...patch };
    if (differing(next, this.#now).length === 0) return;
    this.#past.push(this.#now);
    this.#become(next);
  }

  resetToDefaults(): void {
    this.change(defaults);
  }

  undo(): void {
    const before = this.#past.pop();
    if (before) this.#become(before);
  }

  #become(next: Settings): void {
    const changed = differing(next, this.#now);
    this.#now = next;
    for (const listener of this.#listeners) listener(next, changed);
  }
}
