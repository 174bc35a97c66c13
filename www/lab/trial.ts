/** Previews the effect of a control while it is being moved: one preview at a time, and of later requests only the newest. */

import type { Engine } from "../engine/engine";
import type { Gallery } from "./gallery";
import type { Panels } from "./panels";
import type { Settings } from "./settings";
import { sampleOf } from "./source";
import type { Store } from "./store";

class Trial {
  /** The next preview: its changes of the settings. */
  #next: Settings | undefined;
  #isLooking = false;
  readonly #look: (patch: Settings) => Promise<void>;

  constructor(look: (patch: Settings) => Promise<void>) {
    this.#look = look;
  }

  async show(patch: Settings): Promise<void> {
    this.#next = patch;
    if (this.#isLooking) return;
    this.#isLooking = true;
    while (this.#next) {
      const next: Settings = this.#next;
      this.#next = undefined;
      await this.#look(next);
    }
    this.#isLooking = false;
  }

  /** The control is at rest, so the preview ends. */
  end(): void {
    this.#next = undefined;
  }
}

/** The context of a light that is being moved. */
export interface Lit {
  store: Store;
  engine: Engine;
  gallery: Gallery;
  panels: Panels;
  /** Counts the Lab's runs; undefined if the light is not a sample's. */
  turn: () => number | undefined;
}

/** The picture follows the light while it is moved; a run follows once it rests. */
export class LightTrial {
  readonly #trial = new Trial((patch) => this.#preview(patch));
  readonly #lit: Lit;

  constructor(lit: Lit) {
    this.#lit = lit;
  }

  change(patch: Settings, done: boolean, gesture: object): void {
    const { store, panels } = this.#lit;
    if (!done) {
      panels.date(true);
      void this.#trial.show(patch);
      return;
    }
    this.#trial.end();
    const before = store.settings;
    store.change(patch, true, gesture);
    // The light is back where it was, so the results still belong to it.
    if (store.settings === before) panels.date(false);
  }

  async #preview(patch: Settings): Promise<void> {
    const { store, engine, gallery, panels, turn } = this.#lit;
    const before = turn();
    if (before === undefined) return;
    const source = sampleOf({ ...store.settings, ...patch });
    const seen = await engine.call("preview", { source }).catch(() => undefined);
    if (!seen || turn() !== before) return;
    gallery.preview(seen.picture);
    panels.light.showTruth(seen.trueLight);
  }
}
