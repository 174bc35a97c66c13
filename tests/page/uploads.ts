/** Small files of a pair of pictures, and how a user drops them. */

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

/** A lit ball in front of black; another `tint` is another picture. */
export const colourPng = (name = "a.png", tint = 0): Upload =>
  png(
    name,
    3,
    8,
    Uint8Array.from({ length: 3 * SIDE * SIDE }, (_, i) =>
      radius(Math.floor(i / 3)) < 20 ? 90 + (((i % 3) * (40 + tint) + Math.floor(i / 3)) % 150) : 0,
    ),
  );

/** The ball in front of a wall that is not black. */
export const roomPng = (name = "room.png"): Upload =>
  png(
    name,
    3,
    8,
    Uint8Array.from({ length: 3 * SIDE * SIDE }, (_, i) =>
      radius(Math.floor(i / 3)) < 20 ? 90 + (i % 150) : 140 + (i % 40),
    ),
  );

/** A ball in tenths of a pixel, surrounded by holes; the .npy is in column order, as numpy writes a transposed array. */
const depthAt = (i: number) => (radius(i) < 20 ? Math.round(300 - 10 * Math.sqrt(400 - radius(i) ** 2)) : 0);
export const depthPng = (name = "b.png"): Upload =>
  png(
    name,
    1,
    16,
    Uint16Array.from({ length: SIDE * SIDE }, (_, i) => depthAt(i)),
  );
export const maskPng = (name = "c.png"): Upload =>
  png(
    name,
    1,
    8,
    Uint8Array.from({ length: SIDE * SIDE }, (_, i) => (radius(i) < 20 ? 255 : 0)),
  );

export function columnNpy(name = "d.npy"): Upload {
  const said = `{'descr': '<u2', 'fortran_order': True, 'shape': (${SIDE}, ${SIDE}), }`;
  const head = Buffer.from(`\x93NUMPY\x01\x00\x76\x00${said.padEnd(117, " ")}\n`, "latin1");
  const data = Uint16Array.from({ length: SIDE * SIDE }, (_, i) => depthAt((i % SIDE) * SIDE + Math.floor(i / SIDE)));
  return { name, mimeType: "application/octet-stream", buffer: Buffer.concat([head, Buffer.from(data.buffer)]) };
}

const bytes = (name: string, ...parts: (string | Uint8Array)[]): Upload => ({
  ...{
    name,
    mimeType: "application/octet-stream",
    buffer: Buffer.concat(parts.map((part) => (typeof part === "string" ? Buffer.from(part, "latin1") : part))),
  },
});
const depths16 = (isLittle: boolean): Buffer => {
  const data = Buffer.alloc(2 * SIDE * SIDE);
  for (let i = 0; i < SIDE * SIDE; i++) data[isLittle ? "writeUInt16LE" : "writeUInt16BE"](depthAt(i), 2 * i);
  return data;
};

/** The depth map of `depthPng` as other programs save it. */
export const depthPgm = (name = "d.pgm"): Upload => bytes(name, `P5\n${SIDE} ${SIDE}\n65535\n`, depths16(false));
export function depthPfm(name = "d.pfm"): Upload {
  // The rows from the bottom up, with the low byte first.
  const rows = Float32Array.from({ length: SIDE * SIDE }, (_, i) =>
    depthAt((SIDE - 1 - Math.floor(i / SIDE)) * SIDE + (i % SIDE)),
  );
  return bytes(name, `Pf\n${SIDE} ${SIDE}\n-1.0\n`, new Uint8Array(rows.buffer));
}
/** One uncompressed strip of 16 bits, followed by its directory. */
export function depthTiff(name = "d.tif"): Upload {
  const strip = depths16(true);
  const tags = [
    [256, SIDE],
    [257, SIDE],
    [258, 16],
    [259, 1],
    [262, 1],
    [273, 8],
    [277, 1],
    [278, SIDE],
    [279, strip.length],
  ] as const;
  const head = Buffer.from([0x49, 0x49, 42, 0, 0, 0, 0, 0]);
  head.writeUInt32LE(8 + strip.length, 4);
  const directory = Buffer.alloc(2 + 12 * tags.length + 4);
  directory.writeUInt16LE(tags.length, 0);
  tags.forEach(([tag, value], i) => {
    directory.writeUInt16LE(tag, 2 + 12 * i);
    directory.writeUInt16LE(4, 4 + 12 * i);
    directory.writeUInt32LE(1, 6 + 12 * i);
    directory.writeUInt32LE(value, 10 + 12 * i);
  });
  return bytes(name, head, strip, directory);
}

/** The ball as points in rows and columns; missing depths have no point. */
export function cloudPly(name = "d.ply"): Upload {
  const points = Float32Array.from({ length: 3 * SIDE * SIDE }, (_, at) => {
    const i = Math.floor(at / 3);
    return depthAt(i) === 0 ? NaN : ([i % SIDE, Math.floor(i / SIDE), depthAt(i) / 10][at % 3] ?? NaN);
  });
  const head = [
    "ply",
    "format binary_little_endian 1.0",
    `obj_info num_cols ${SIDE}`,
    `obj_info num_rows ${SIDE}`,
    `element vertex ${SIDE * SIDE}`,
    ...["x", "y", "z"].map((axis) => `property float ${axis}`),
    "end_header",
    "",
  ];
  return bytes(name, head.join("\n"), new Uint8Array(points.buffer));
}

export const cameraJson = (name = "camera.json", side = SIDE): Upload => ({
  ...{
    name,
    mimeType: "application/json",
    buffer: Buffer.from(JSON.stringify({ width: side, height: side, fx: 61, fy: 62, cx: 23.5, cy: 23.25 })),
  },
});

/** Drops files onto the element that the selector matches. */
export async function drop(page: Page, selector: string, files: readonly Upload[]): Promise<void> {
  const carried = await page.evaluateHandle(
    (all) => {
      const transfer = new DataTransfer();
      for (const { name, type, bytes } of all) transfer.items.add(new File([new Uint8Array(bytes)], name, { type }));
      return transfer;
    },
    files.map(({ name, mimeType, buffer }) => ({ name, type: mimeType, bytes: [...buffer] })),
  );
  await page.locator(selector).dispatchEvent("drop", { dataTransfer: carried });
}
