/** The selected pixel and its counterpart in the other view. Shared by all pictures and the surfaces. */

import type { Pixel, Probed, Side } from "../engine/protocol";

export interface Asked {
  side: Side;
  pixel: Pixel;
}

/** Returns the values at the pixel, or nothing if they are not available. */
type Ask = (asked: Asked) => Promise<Probed | undefined>;

const isSame = (a: Asked | null, b: Asked | null): boolean =>
  a === b || (a?.side === b?.side && a?.pixel.column === b?.pixel.column && a?.pixel.row === b?.pixel.row);

export class Probe {
  #asked: Asked | null = null;
  #answer: Probed | null = null;
  #isBusy = false;
  #isStale = false;
  readonly #ask: Ask;
  readonly #listeners: (() => void)[] = [];

  constructor(ask: Ask) {
    this.#ask = ask;
  }

  /** While the next answer is under way, the present one may be out of date. */
  get answer(): Probed | null {
    return this.#answer;
  }

  /** The position of the probe in a view. The selecting view shows it immediately, the other one once the answer has come. */
  at(side: Side): Pixel | null {
    if (!this.#asked) return null;
    return this.#asked.side === side ? this.#asked.pixel : (this.#answer?.pixels[side] ?? null);
  }

  listen(listener: () => void): void {
    this.#listeners.push(listener);
  }

  point(asked: Asked | null): void {
    if (isSame(asked, this.#asked)) return;
    this.#asked = asked;
    if (!asked) this.#answer = null;
    this.#tell();
    if (asked) void this.#follow();
  }

  /** Asks again for the same pixel, whose numbers have changed. */
  refresh(): void {
    if (this.#asked) void this.#follow();
  }

  /** Only one request runs at a time; if more arrive, only the last one counts. */
  async #follow(): Promise<void> {
    this.#isStale = true;
    if (this.#isBusy) return;
    this.#isBusy = true;
    while (this.#isStale && this.#asked) {
      this.#isStale = false;
      const answer = await this.#ask(this.#asked);
      if (!this.#asked) break;
      this.#answer = answer ?? null;
      this.#tell();
    }
    this.#isBusy = false;
  }

  #tell(): void {
    for (const listener of this.#listeners) listener();
  }
}
