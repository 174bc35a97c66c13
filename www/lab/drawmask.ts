/** Draws a mask of the colour image with the tool of "Check a rig". Loaded on demand. */

import { MaskTool } from "../rig/masktool";
import type { Paint } from "../rig/paint";
import { lookAt, pictureOf } from "./look";
import { writePng } from "./write";

/** Largest width of the picture on which the mask is drawn: finer than a pointer, and small enough to draw without delay. */
const WIDEST = 1600;

let tool: MaskTool | undefined;

/** The mask at the size of its image. */
async function fileOf({ width, height, data }: Paint, image: File): Promise<File> {
  const { width: columns = width, height: rows = height } = await lookAt(image);
  const full = new Uint8Array(columns * rows);
  for (let row = 0; row < rows; row++) {
    const from = width * Math.floor((row * height) / rows);
    for (let column = 0; column < columns; column++)
      full[row * columns + column] = data?.[from + Math.floor((column * width) / columns)] ?? 255;
  }
  const png = await writePng({ width: columns, height: rows, channels: 1, data: full });
  return new File([png as Uint8Array<ArrayBuffer>], `mask of ${image.name.replace(/\.[^.]*$/, "")}.png`, {
    type: "image/png",
  });
}

/** Opens the tool; `take` receives the mask, or undefined if the whole image is used. */
export async function drawMask(image: File, take: (mask: File | undefined) => void): Promise<void> {
  tool ??= new MaskTool();
  await tool.open({
    title: `The object in ${image.name}`,
    advice: "Draw over the object. What stays dark is background and is left out.",
    picture: () => pictureOf(image, WIDEST),
    done: (paint) => {
      if (paint.data) void fileOf(paint, image).then(take);
      else take(undefined);
    },
  });
}
