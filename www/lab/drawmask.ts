/** Draws a mask of a picture of the pair with the tool of "Check a rig". Loaded on demand. */

import { MaskTool } from "../rig/masktool";
import type { Paint } from "../rig/paint";
import { depthPicture, depthWithin, lookAt, pictureOf, suggested } from "./look";
import { writePng } from "./write";

/** Largest width of the picture on which the mask is drawn: finer than a pointer, and small enough to draw without delay. */
const WIDEST = 1600;

let tool: MaskTool | undefined;

async function maskFile(image: File, width: number, height: number, data: Uint8Array): Promise<File> {
  const png = await writePng({ width, height, channels: 1, data });
  return new File([png as Uint8Array<ArrayBuffer>], `mask of ${image.name.replace(/\.[^.]*$/, "")}.png`, {
    type: "image/png",
  });
}

/** Scales the mask to the size of its image. */
async function fileOf({ width, height, data }: Paint, image: File): Promise<File> {
  const { width: columns = width, height: rows = height } = await lookAt(image);
  const full = new Uint8Array(columns * rows);
  for (let row = 0; row < rows; row++) {
    const from = width * Math.floor((row * height) / rows);
    for (let column = 0; column < columns; column++)
      full[row * columns + column] = data?.[from + Math.floor((column * width) / columns)] ?? 255;
  }
  return maskFile(image, columns, rows, full);
}

/** The pixels of a bitmap. */
function pixelsOf(bitmap: ImageBitmap): ImageData {
  const canvas = new OffscreenCanvas(bitmap.width, bitmap.height);
  const context = canvas.getContext("2d");
  if (!context) throw new Error("This browser provides no canvas for the picture.");
  context.drawImage(bitmap, 0, 0);
  return context.getImageData(0, 0, bitmap.width, bitmap.height);
}

/** Finds silhouettes on the picture that `open` has shown last. */
function silhouettes(): { shown(bitmap: ImageBitmap): ImageBitmap; suggest(marks: Uint8Array): Promise<Uint8Array> } {
  let pixels: ImageData | undefined;
  return {
    shown(bitmap) {
      pixels = pixelsOf(bitmap);
      return bitmap;
    },
    suggest(marks) {
      if (!pixels) throw new Error("There is no picture yet.");
      const { width, height, data } = pixels;
      return suggested({ width, height, data, marks });
    },
  };
}

/** Opens the tool; `take` receives the mask, or undefined if the whole image is used. */
export async function drawMask(image: File, take: (mask: File | undefined) => void): Promise<void> {
  tool ??= new MaskTool();
  const { shown, suggest } = silhouettes();
  await tool.open({
    title: `The object in ${image.name}`,
    advice: "Draw over the object. What stays dark is background and is left out.",
    picture: async () => shown(await pictureOf(image, WIDEST)),
    suggest,
    done: (paint) => {
      if (paint.data) void fileOf(paint, image).then(take);
      else take(undefined);
    },
  });
}

/** Opens the tool for a depth map, of which a range of depths can be used. */
export async function drawDepthMask(depth: File, take: (mask: File | undefined) => void): Promise<void> {
  tool ??= new MaskTool();
  const { shown, suggest } = silhouettes();
  await tool.open({
    title: `The object in ${depth.name}`,
    advice: "Restrict the depths to those of the object, or draw over it. What stays dark or grey is left out.",
    picture: async () => shown(await depthPicture(depth, undefined, WIDEST)),
    depth: (range) => depthPicture(depth, range, WIDEST),
    suggest,
    done({ width, height, data }, range) {
      if (!data && !range) return take(undefined);
      const paint = data ? { paint: { width, height, data } } : {};
      void depthWithin(depth, { ...paint, ...(range ? { range } : {}) })
        .then((mask) => maskFile(depth, mask.width, mask.height, mask.data))
        .then(take);
    },
  });
}
