/**
 * PNG of 8 or 16 bits, grey or colour, with or without alpha. A canvas would write only 8 bits. The platform's deflate compresses the data,
 * so that no second one has to be downloaded; rows are stored as differences from the row above, which suits smooth depths and normals.
 */
import { crc32 } from "../crc.js";
import { isObject, wrong } from "../check.js";
import { BimodalError, refused } from "../errors.js";
import type { Raster } from "../npy.js";
import { checkRaster, text } from "./check.js";

const SIGNATURE = [0x89, 0x50, 0x4e, 0x47, 0x0d, 0x0a, 0x1a, 0x0a];
/** The filter that stores rows as differences from the row above. */
const UP = 2;
/** Colour types by the number of channels: grey, grey with alpha, RGB, RGBA. */
const TYPES: Readonly<Record<number, number>> = { 1: 0, 2: 4, 3: 2, 4: 6 };

type Samples = Uint8Array | Uint8ClampedArray | Uint16Array;

/** Pixels to be written; without `channels` their number follows from the length of the data, so that a `ColorImage` can be passed. */
export type PngInput = Omit<Raster<Samples>, "channels"> & {
  /** Number of channels: 1 grey, 2 grey and alpha, 3 RGB, 4 RGBA. */
  channels?: number;
};

function chunk(type: string, body: Uint8Array): Uint8Array<ArrayBuffer> {
  const part = new Uint8Array(body.length + 12);
  const view = new DataView(part.buffer);
  view.setUint32(0, body.length);
  for (let i = 0; i < 4; i++) part[4 + i] = type.charCodeAt(i);
  part.set(body, 8);
  view.setUint32(8 + body.length, crc32(part.subarray(4, 8 + body.length)));
  return part;
}

/** High bytes first, each row after its filter. */
function filtered({ width, height, channels, data }: Raster<Samples>): Uint8Array<ArrayBuffer> {
  const [samples, bytes] = [width * channels, data.BYTES_PER_ELEMENT];
  const stride = 1 + samples * bytes;
  const out = new Uint8Array(height * stride);
  for (let row = 0, from = 0; row < height; row++) {
    let to = row * stride;
    out[to++] = UP;
    for (let i = 0; i < samples; i++) {
      const value = data[from++] ?? 0;
      if (bytes === 2) out[to++] = value >> 8;
      out[to++] = value;
    }
  }
  // The rows are filtered from the last to the first, so that the row above is still unchanged.
  for (let row = height - 1; row > 0; row--) {
    for (let at = row * stride + 1; at < (row + 1) * stride; at++) out[at] = (out[at] ?? 0) - (out[at - stride] ?? 0);
  }
  return out;
}

async function deflated(bytes: Uint8Array<ArrayBuffer>): Promise<Uint8Array> {
  const stream = new Blob([bytes]).stream().pipeThrough(new CompressionStream("deflate"));
  return new Uint8Array(await new Response(stream).arrayBuffer());
}

/** Largest number of characters of a remark's name in PNG. */
const LONGEST_NAME = 79;

function checkTexts(texts: unknown): void {
  if (!isObject(texts)) throw wrong("texts", "an object", texts);
  for (const [name, words] of Object.entries(texts)) {
    text(words, `texts.${name}`);
    if (name.length < 1 || name.length > LONGEST_NAME) {
      throw new BimodalError(
        "range",
        `texts: a name has 1 to ${LONGEST_NAME} characters, not ${name.length}`,
        "texts",
        refused(name.length),
      );
    }
  }
}

/**
 * A PNG of 8 or 16 bits, as the data have. `texts` are remarks in English, such as the unit, which readers return by their names
 * ("Description", "Unit").
 */
export async function writePng(
  input: PngInput,
  texts: Readonly<Record<string, string>> = {},
): Promise<Uint8Array<ArrayBuffer>> {
  if (!isObject(input)) throw wrong("raster", "an object", input);
  const { width, height, data, channels = Object(data).length / (width * height) } = input;
  const raster = { width, height, channels, data };
  checkRaster(raster, "raster", Uint8Array, Uint8ClampedArray, Uint16Array);
  checkTexts(texts);
  const type = TYPES[channels];
  if (type === undefined)
    throw new BimodalError(
      "unsupported",
      `raster.channels: 1 to 4 are written, not ${channels}`,
      "raster.channels",
      refused(channels),
    );
  const head = new Uint8Array(13);
  const view = new DataView(head.buffer);
  view.setUint32(0, width);
  view.setUint32(4, height);
  head.set([8 * data.BYTES_PER_ELEMENT, type], 8);
  // Text in Latin-1, with a zero only after the name. Any other character becomes a question mark.
  const remarks = Object.entries(texts).map(([name, words]) => {
    const plain = (text: string) => text.replace(/[^\x20-\x7e]/g, "?");
    return chunk("tEXt", new TextEncoder().encode(`${plain(name)}\0${plain(words)}`));
  });
  const parts = [
    new Uint8Array(SIGNATURE),
    chunk("IHDR", head),
    ...remarks,
    chunk("IDAT", await deflated(filtered(raster))),
    chunk("IEND", new Uint8Array()),
  ];
  const file = new Uint8Array(parts.reduce((sum, { length }) => sum + length, 0));
  let at = 0;
  for (const part of parts) {
    file.set(part, at);
    at += part.length;
  }
  return file;
}
