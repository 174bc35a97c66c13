/** Files whose names and contents are markup that would run if the page inserted it as HTML. */

import { deflateSync, crc32 } from "node:zlib";
import { expect, type Page } from "@playwright/test";
import { colourPng, depthPng, type Upload } from "./uploads";

/** Markup without slashes, which file names cannot contain. */
export const EVIL = `<img src=x onerror="window.owned=1"><svg onload=owned=1>`;
export const EVIL_TEXT = `</style></title></script><script>window.owned=1</script>"'>${EVIL}`;

function chunk(type: string, data: Buffer): Buffer {
  const body = Buffer.concat([Buffer.from(type, "latin1"), data]);
  const [length, sum] = [Buffer.alloc(4), Buffer.alloc(4)];
  length.writeUInt32BE(data.length);
  sum.writeUInt32BE(crc32(body));
  return Buffer.concat([length, body, sum]);
}

/** An EXIF block with a description and a maker, as cameras write them. */
function exif(): Buffer {
  const words = Buffer.from(`${EVIL_TEXT}\0`, "latin1");
  const head = Buffer.alloc(8 + 2 + 2 * 12 + 4);
  head.write("II*\0", "latin1");
  head.writeUInt32LE(8, 4);
  head.writeUInt16LE(2, 8);
  for (const [index, tag] of [0x010e, 0x010f].entries()) {
    const at = 10 + 12 * index;
    head.writeUInt16LE(tag, at);
    head.writeUInt16LE(2, at + 2);
    head.writeUInt32LE(words.length, at + 4);
    head.writeUInt32LE(head.length, at + 8);
  }
  return Buffer.concat([head, words]);
}

/** A PNG with texts of all three kinds, and with EXIF. */
export function withTexts({ buffer, ...file }: Upload): Upload {
  const texts = [
    chunk("tEXt", Buffer.from(`Title\0${EVIL_TEXT}`, "latin1")),
    chunk("zTXt", Buffer.concat([Buffer.from("Comment\0\0", "latin1"), deflateSync(EVIL_TEXT)])),
    chunk("iTXt", Buffer.from(`Author\0\0\0\0\0${EVIL_TEXT}`, "latin1")),
    chunk("eXIf", exif()),
  ];
  // The position after the signature and the header.
  return { ...file, buffer: Buffer.concat([buffer.subarray(0, 33), ...texts, buffer.subarray(33)]) };
}

const text = (name: string, words: string): Upload => ({
  name: `${EVIL}${name}`,
  mimeType: "text/plain",
  buffer: Buffer.from(words),
});

/** Cameras and poses whose names, models and frames are markup, and texts whose refusals quote them. */
export const texts = (): Upload[] => [
  text(
    ".json",
    JSON.stringify({
      camera_name: EVIL_TEXT,
      width: 48,
      height: 48,
      fx: 61,
      fy: 62,
      cx: 23.5,
      cy: 23.25,
      [EVIL_TEXT]: EVIL_TEXT,
    }),
  ),
  text("k.yaml", `"${EVIL}":\n  camera_model: "${EVIL.replaceAll('"', "")}"\n  intrinsics: [1, 2, 3, 4]\n`),
  text(
    "pose.json",
    JSON.stringify({
      parent_frame: EVIL_TEXT,
      child_frame: EVIL_TEXT,
      name: EVIL_TEXT,
      R: [
        [1, 0, 0],
        [0, 1, 0],
        [0, 0, 1],
      ],
      t: [0.05, 0, 0],
    }),
  ),
  text(
    "tf.yaml",
    `header: {frame_id: '${EVIL.replaceAll("'", "")}'}\nchild_frame_id: '${EVIL}'\ntransform:\n  translation: {x: 0.05, y: 0, z: 0}\n  rotation: {x: 0, y: 0, z: 0, w: 1}\n`,
  ),
  text("a.xml", `<opencv_storage><${"b".repeat(9)} type_id="${EVIL.replaceAll('"', "")}">1</c></opencv_storage>`),
  text("a.txt", EVIL_TEXT),
];

export const pictures = (): Upload[] => [
  withTexts(colourPng(`${EVIL}colour.png`)),
  withTexts(depthPng(`${EVIL}depth.png`)),
];

/** Checks that no markup has become an element or has run. */
export async function expectHarmless(page: Page): Promise<void> {
  expect(await page.evaluate(() => (window as unknown as { owned?: number }).owned)).toBeUndefined();
  expect(await page.locator(`[onerror], [onload], img[src="x"], script:not([src])`).count()).toBe(0);
}
