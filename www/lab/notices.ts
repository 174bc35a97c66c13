/** Activities and failures of the page outside the loop; the status shows them until the next frame is on the screen. */

import { wayOut } from "./source";
import type { Notice } from "./status";
import { sentence } from "./verdict";

export class Notices {
  #now: { state: Notice; words: string; cause: string } | undefined;
  readonly #onChange: () => void;

  constructor(onChange: () => void) {
    this.#onChange = onChange;
  }

  get now(): { state: Notice; words: string; cause: string } | undefined {
    return this.#now;
  }

  announce(state: Notice, words: string, cause = ""): void {
    this.#now = { state, words, cause };
    this.#onChange();
  }

  /** An error, which may be shown beside a field. */
  fail(placed: { field: string; words: string } | undefined): void {
    if (!placed) return this.announce("error", "see the message");
    this.announce("error", `${placed.field}: invalid value`, `${sentence(placed.words)} The field is marked.`);
  }

  /** Says what an input lacks, or that files are being read which may supply it. */
  lack(lacking: string, names = ""): void {
    this.announce(names ? "loading" : "waiting", names ? "looking at the files" : lacking, names || wayOut(lacking));
  }

  /** Adds what is loading to the notice. */
  detail(words: string): void {
    if (this.#now?.state === "loading") this.announce("loading", this.#now.words, words);
  }

  /** Reports that something loads, and restores the previous status afterwards. */
  async loading(words: string, load: () => Promise<void>): Promise<void> {
    const before = this.#now;
    this.announce("loading", words);
    await load();
    if (before && this.#now?.state === "loading") this.announce(before.state, before.words, before.cause);
  }

  /** A new frame is on the screen, so the loop's status is shown again. */
  settle(): void {
    this.#now = undefined;
    this.#onChange();
  }
}
