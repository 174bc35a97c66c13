/** The pixel that is being looked at, shared by all views of one camera. */

export interface Pixel {
  column: number;
  row: number;
}

export class Probe {
  #pixel: Pixel | null = null;
  #listeners: (() => void)[] = [];

  get pixel(): Pixel | null {
    return this.#pixel;
  }

  listen(listener: () => void): void {
    this.#listeners.push(listener);
  }

  point(pixel: Pixel | null): void {
    this.#pixel = pixel;
    for (const listener of this.#listeners) listener();
  }
}
