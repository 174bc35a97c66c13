/** Small files of a pair of pictures, and the way a hand drops them. */

import type { Page } from "@playwright/test";
import { encode } from "fast-png";

export interface Upload {
  name: string;
  mimeType: string;
  buffer: Buffer;
}

export const SIDE = 48;
const middle = (SIDE - 1) / 2;
const radius = (i: number) => Math.hypot((i % SIDE) - middle, Math.floor(i / SIDE) - middle);
const png = (name: string, channels: 1 | 3, depth: 8 | 16, data: Uint8Array | Uint16Array): Upload => ({
  ...{ name, mimeType: "image/png", buffer: Buffer.from(encode({ width: SIDE, height: SIDE, channels, depth, data })) },
});

/** A lit ball before black; another `tint` is another picture. */
export const colourPng = (name = "a.png", tint = 0): Upload =>
  png(name, 3, 8, Uint8Array.from({ length: 3 * SIDE * SIDE }, (_, i) => (radius(Math.floor(i / 3)) < 20 ? 90 + (((i % 3) * (40 + tint) + Math.floor(i / 3)) % 150) : 0)));

/** A ball in tenths of a pixel, holes around it; column by column in a .npy as numpy writes a transposed array. */
const depthAt = (i: number) => (radius(i) < 20 ? Math.round(300 - 10 * Math.sqrt(400 - radius(i) ** 2)) : 0);
export const depthPng = (name = "b.png"): Upload => png(name, 1, 16, Uint16Array.from({ length: SIDE * SIDE }, (_, i) => depthAt(i)));
export const maskPng = (name = "c.png"): Upload => png(name, 1, 8, Uint8Array.from({ length: SIDE * SIDE }, (_, i) => (radius(i) < 20 ? 255 : 0)));

export function columnNpy(name = "d.npy"): Upload {
  const said = `{'descr': '<u2', 'fortran_order': True, 'shape': (${SIDE}, ${SIDE}), }`;
  const head = Buffer.from(`\x93NUMPY\x01\x00\x76\x00${said.padEnd(117, " ")}\n`, "latin1");
  const data = Uint16Array.from({ length: SIDE * SIDE }, (_, i) => depthAt((i % SIDE) * SIDE + Math.floor(i / SIDE)));
  return { name, mimeType: "application/octet-stream", buffer: Buffer.concat([head, Buffer.from(data.buffer)]) };
}

export const cameraJson = (name = "camera.json", side = SIDE): Upload => ({
  ...{ name, mimeType: "application/json", buffer: Buffer.from(JSON.stringify({ width: side, height: side, fx: 61, fy: 62, cx: 23.5, cy: 23.25 })) },
});

/** Drops files onto whatever the selector finds. */
export async function drop(page: Page, selector: string, files: readonly Upload[]): Promise<void> {
  const carried = await page.evaluateHandle((all) => {
    const transfer = new DataTransfer();
    for (const { name, type, bytes } of all) transfer.items.add(new File([new Uint8Array(bytes)], name, { type }));
    return transfer;
  }, files.map(({ name, mimeType, buffer }) => ({ name, type: mimeType, bytes: [...buffer] })));
  await page.locator(selector).dispatchEvent("drop", { dataTransfer: carried });
}
