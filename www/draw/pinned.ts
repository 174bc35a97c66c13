/** The picture of the pinned run on top of the present one; the style sheet cuts it at the position of the wipe. */

import { make } from "../dom";
import type { Painted } from "../engine/protocol";

type Place = Omit<Painted, "bitmap">;

export class Pinned {
  readonly #shown: HTMLCanvasElement;
  #kept: { canvas: HTMLCanvasElement; place: Place } | undefined;

  constructor(shown: HTMLCanvasElement) {
    this.#shown = shown;
  }

  keep({ bitmap: _, ...place }: Painted): void {
    this.drop();
    const { width, height } = this.#shown;
    const canvas = make("canvas", { width, height });
    canvas.getContext("2d")?.drawImage(this.#shown, 0, 0);
    this.#shown.after(make("div", { class: "pinned", "aria-hidden": "true" }, canvas));
    this.#kept = { canvas, place };
    this.place(place);
  }

  drop(): void {
    this.#kept?.canvas.parentElement?.remove();
    this.#kept = undefined;
  }

  /** Aligns the picture with the visible pixels. Both are parts of a view, given as shares of its sides. */
  place(now: Place): void {
    if (!this.#kept) return;
    const { canvas, place } = this.#kept;
    for (const [edge, side, first] of [
      ["left", "width", "left"],
      ["top", "height", "top"],
    ] as const) {
      const share = (value: number, { full }: Place) => value / full[side];
      const span = share(now[side] * now.stride, now);
      canvas.style[edge] = `${(100 * (share(place[first], place) - share(now[first], now))) / span}%`;
      canvas.style[side] = `${(100 * share(place[side] * place.stride, place)) / span}%`;
    }
  }
}
