/** Draws one view: the module draws its layers, the page everything else. The result leaves the worker as a bitmap. */

import type { DrawOptions, Estimator, Layer } from "../../pkg/index.js";
import type { Painted, Surface } from "./protocol";
import { gridOf, type Cut } from "./rasters";

export function contextOf(width: number, height: number): OffscreenCanvasRenderingContext2D {
  // The canvas is written and read pixel by pixel, which is slow on a graphics card.
  const context = new OffscreenCanvas(width, height).getContext("2d", { willReadFrequently: true });
  if (!context) throw new Error("This browser cannot draw in a worker.");
  return context;
}

export class ViewCanvas {
  readonly #frame: Omit<Painted, "bitmap">;
  /** The drawn part, and the whole view, for the module to draw into. */
  readonly #part: OffscreenCanvasRenderingContext2D;
  #whole: OffscreenCanvasRenderingContext2D | undefined;

  constructor(cut: Cut) {
    const { fullWidth, fullHeight } = cut;
    this.#frame = { ...gridOf(cut), full: { width: fullWidth, height: fullHeight } };
    this.#part = contextOf(this.#frame.width, this.#frame.height);
    // Each drawn pixel is a pixel of the view, not a mean of several.
    this.#part.imageSmoothingEnabled = false;
  }

  /** A layer of the module. */
  layer(estimator: Estimator, layer: Layer, options: DrawOptions = {}): this {
    const { left, top, width, height, stride, full } = this.#frame;
    this.#whole ??= contextOf(full.width, full.height);
    estimator.draw(this.#whole, layer, options);
    // The view's pixel is the middle of each block, which must be the first pixel of a stride.
    const before = (stride - 1) / 2;
    this.#part.drawImage(
      this.#whole.canvas,
      left - before,
      top - before,
      width * stride,
      height * stride,
      0,
      0,
      width,
      height,
    );
    return this;
  }

  picture(pixels: ImageData): this {
    this.#part.putImageData(pixels, 0, 0);
    return this;
  }

  /** RGB of the canvas at a surface's points; transparent pixels count as grey. */
  colours({ width, height, stride }: Omit<Surface, "colours">): Uint8Array | null {
    if (width === 0) return null;
    const step = stride / this.#frame.stride;
    const { data } = this.#part.getImageData(0, 0, this.#frame.width, this.#frame.height);
    const colours = new Uint8Array(3 * width * height).fill(128);
    for (let to = 0; to < width * height; to++) {
      const from = 4 * step * (Math.floor(to / width) * this.#frame.width + (to % width));
      if (data[from + 3]) colours.set(data.subarray(from, from + 3), 3 * to);
    }
    return colours;
  }

  /** Removes the bitmap; the canvas is then empty. */
  take(): Painted {
    return { ...this.#frame, bitmap: this.#part.canvas.transferToImageBitmap() };
  }
}
