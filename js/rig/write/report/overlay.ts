/** A frame's depth edges on its image, with the calibration in question and with the best fit, side by side. */
import { fault } from "../built.js";
import type { Overlay } from "./contents.js";
import { type Markup, html } from "./markup.js";
import { isPicture } from "./parts.js";

/** Columns of the grid on which edges are drawn; finer ones would not be visible on a printed page. */
const COLUMNS = 640;
/** Largest number of points that are drawn; a picture of 12 megapixels has fewer. */
const MOST_POINTS = 1_000_000;

/** Draws points as runs along the rows of a grid. */
function runs(edges: ArrayLike<number>, cell: number, columns: number, rows: number): string {
  const cells = new Set<number>();
  for (let i = 0; i + 1 < Math.min(edges.length, 2 * MOST_POINTS); i += 2) {
    const [x, y] = [Math.round((edges[i] ?? NaN) / cell), Math.round((edges[i + 1] ?? NaN) / cell)];
    if (x >= 0 && x < columns && y >= 0 && y < rows) cells.add(y * columns + x);
  }
  let path = "";
  for (const first of cells) {
    if (first % columns > 0 && cells.has(first - 1)) continue;
    let length = 0;
    while ((first + length + 1) % columns > 0 && cells.has(first + length + 1)) length++;
    path += `M${first % columns} ${Math.floor(first / columns)}h${length}`;
  }
  return path;
}

/**
 * The overlays of one frame before and after, that is with the calibration in question and with the best fit. The second overlay refers to
 * the picture of the first, so that the file holds it once.
 */
export function overlayPair({ frame, width, height, picture, before, after }: Overlay, index: number): Markup {
  const field = `options.overlays[${index}]`;
  if (!isPicture(picture))
    throw fault("type", `${field}.picture`, "must be a data URL of a PNG, JPEG, WebP, AVIF or GIF");
  if (![width, height].every((length) => Number.isFinite(length) && length >= 1))
    throw fault("size", field, "needs a width and a height in pixels");
  for (const [name, edges] of Object.entries({ before, after }).filter(
    ([name, edges]) => name === "after" || edges !== undefined,
  ))
    if (typeof Object(edges).length !== "number") throw fault("type", `${field}.${name}`, "must be a list of numbers");
  const cell = Math.max(1, width / COLUMNS);
  const [columns, rows] = [Math.ceil(width / cell), Math.ceil(height / cell)];
  const sides = [
    { words: "Before, with the calibration in question", edges: before },
    { words: "After, with the best fit", edges: after },
  ].filter(({ edges }) => edges !== undefined);
  const figures = sides.map(
    ({ words, edges = [] }, side) =>
      html`<figure><svg viewBox="0 0 ${columns} ${rows}" role="img" aria-label="Depth edges on the image. ${words}: ${frame}">${
        side === 0
          ? html`<image id="frame-${index}" href="${picture}" width="${columns}" height="${rows}"/>`
          : html`<use href="#frame-${index}"/>`
      }<path class="edge" d="${runs(edges, cell, columns, rows)}"/></svg><figcaption class="clamp">${words}: ${frame}</figcaption></figure>`,
  );
  return html`<div class="overlay">${figures}</div>`;
}
