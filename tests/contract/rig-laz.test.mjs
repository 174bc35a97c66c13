// LAZ, as laspy with lazrs compresses it (scripts/reference/laz.py): every point format that laz-perf supports, and damaged files.
import assert from "node:assert/strict";
import { describe, test } from "node:test";
import { inTime } from "./malformed.mjs";
import { close, codes, fixture, read, refusedFile } from "./rig-support.mjs";

const [LASERS, COLUMNS] = [8, 72];
const COUNT = LASERS * COLUMNS;
const place = (format) => ([1, 6].includes(format) ? `scan-${format}.laz` : `laz/scan-${format}.laz`);

/** x, y and z of each point, in the order of the file. */
const POINTS = Array.from({ length: COUNT }, (_, at) => {
  const azimuth = (2 * Math.PI * (at % COLUMNS)) / COLUMNS;
  const elevation = ((4 * Math.floor(at / COLUMNS) - 14) * Math.PI) / 180;
  const radius = 5 + Math.sin(3 * azimuth) / 2;
  return [radius * Math.cos(azimuth), radius * Math.sin(azimuth), radius * Math.tan(elevation)];
}).flat();

describe("LAZ", () => {
  for (const format of [0, 1, 2, 3, 6, 7, 8])
    test(`point format ${format}: points, intensities and times`, async () => {
      const found = await read("scan.laz", fixture(place(format)));
      assert.equal(found.kind, "depth");
      assert.match(found.says, /576 points \(LAZ\), sorted into \d+x8/);
      const { points, intensity, times } = found.scan;
      // Coordinates are stored to the millimetre.
      close([...points], POINTS, 5.01e-4);
      assert.deepEqual(
        [...intensity],
        POINTS.slice(0, COUNT).map((_, at) => (7 * Math.floor(at / COLUMNS) + (at % COLUMNS)) % 256),
      );
      const isTimed = format !== 0 && format !== 2;
      assert.equal(codes(found).includes("point-times"), isTimed);
      if (isTimed) close([times[0], times[COUNT - 1]], [100, 100 + 1e-5 * (COUNT - 1)], 1e-9);
      assert.ok(!codes(found).includes("unit-guessed"));
    });

  for (const format of [4, 10])
    test(`point format ${format} has wave packets, and the way out is named`, () =>
      refusedFile(read("a.laz", fixture(place(format))), "a.laz", /wave packets .*pdal translate/));

  test("damage inside the compressed points is seen by the header's box", async () => {
    const bytes = fixture("scan-6.laz");
    const view = new DataView(bytes.buffer);
    // The changed byte is within the layers of the first chunk, after its uncompressed point.
    for (let at = view.getUint32(96, true) + 200; at < view.getUint32(96, true) + 230; at++) bytes[at] ^= 0x5a;
    await refusedFile(read("a.laz", bytes), "a.laz", /damaged/);
  });

  test("a file that is cut off anywhere is refused in time", async () => {
    const bytes = fixture("scan-1.laz");
    for (let length = 4; length < bytes.length; length += 97)
      await inTime(`${length} bytes`, () =>
        refusedFile(read("a.laz", bytes.slice(0, length)), "a.laz", /cut off|damaged|format is not known/),
      );
  });

  test("more points than its bytes can hold", async () => {
    const bytes = fixture("scan-1.laz");
    new DataView(bytes.buffer).setUint32(107, 4_000_000, true);
    await refusedFile(read("a.laz", bytes), "a.laz", /cut off: \d+ bytes cannot hold the 4000000 points/);
  });
});
