// PNG and .npy files, valid and invalid.
import assert from "node:assert/strict";
import { readFileSync } from "node:fs";
import { describe, test } from "node:test";
import { BimodalError as FilesError, decodeColour, decodeDepth, decodeMask } from "../../pkg/files.js";
import { FOLDER as RUN } from "../../scripts/reference/run-written.mjs";
import { inRoot } from "../../scripts/shell.mjs";
import { BimodalError, npy, png, refused } from "./support.mjs";

const GREY = 0,
  RGB = 2,
  PALETTE = 3,
  GREY_ALPHA = 4,
  RGBA = 6;

test("both modules throw the same class", () => assert.equal(FilesError, BimodalError));

describe("PNG", () => {
  const words = (...values) => values.flatMap((value) => [value >> 8, value & 255]);

  test("16-bit grey keeps all its bits", () => {
    const file = png({ width: 2, height: 2, depth: 16, colourType: GREY, rows: [words(1, 258), words(0, 65535)] });
    assert.deepEqual(decodeDepth(file), { width: 2, height: 2, data: new Uint16Array([1, 258, 0, 65535]) });
    assert.deepEqual(decodeDepth(file.buffer).data, new Uint16Array([1, 258, 0, 65535]));
  });

  test("16-bit RGB becomes RGBA", () => {
    const file = png({ width: 1, height: 1, depth: 16, colourType: RGB, rows: [words(100, 200, 40000)] });
    assert.deepEqual(decodeColour(file), { width: 1, height: 1, data: new Uint16Array([100, 200, 40000, 65535]) });
  });

  test("8-bit grey, RGB, RGBA and palette become RGBA", () => {
    const decoded = (colourType, row, more) => [
      ...decodeColour(png({ width: 1, height: 1, depth: 8, colourType, rows: [row], ...more })).data,
    ];
    assert.deepEqual(decoded(GREY, [9]), [9, 9, 9, 255]);
    assert.deepEqual(decoded(GREY_ALPHA, [9, 77]), [9, 9, 9, 77]);
    assert.deepEqual(decoded(RGB, [1, 2, 3]), [1, 2, 3, 255]);
    assert.deepEqual(decoded(RGBA, [1, 2, 3, 4]), [1, 2, 3, 4]);
    assert.deepEqual(decoded(PALETTE, [1], { palette: [0, 0, 0, 7, 8, 9] }), [7, 8, 9, 255]);
  });

  test("masks: any non-zero level, few bits and palettes included", () => {
    const grey = png({ width: 3, height: 1, depth: 8, colourType: GREY, rows: [[0, 1, 255]] });
    assert.deepEqual(decodeMask(grey), { width: 3, height: 1, data: new Uint8Array([0, 255, 255]) });
    const bits = png({
      width: 10,
      height: 2,
      depth: 1,
      colourType: GREY,
      rows: [
        [0b10000001, 0b01000000],
        [0, 0b10000000],
      ],
    });
    const expected = [1, 0, 0, 0, 0, 0, 0, 1, 0, 1, 0, 0, 0, 0, 0, 0, 0, 0, 1, 0].map((bit) => 255 * bit);
    assert.deepEqual([...decodeMask(bits).data], expected);
    const palette = png({
      width: 2,
      height: 1,
      depth: 8,
      colourType: PALETTE,
      rows: [[0, 1]],
      palette: [0, 0, 0, 128, 0, 0],
    });
    assert.deepEqual([...decodeMask(palette).data], [0, 255]);
    const clear = png({ width: 2, height: 1, depth: 8, colourType: RGBA, rows: [[9, 9, 9, 0, 9, 9, 9, 255]] });
    assert.deepEqual([...decodeMask(clear).data], [0, 255]);
  });

  test("cut off or damaged", () => {
    const file = png({
      width: 8,
      height: 8,
      depth: 16,
      colourType: GREY,
      rows: Array.from({ length: 8 }, () => words(1, 2, 3, 4, 5, 6, 7, 8)),
    });
    for (const length of [8, 20, 40, file.length - 20, file.length - 13]) {
      for (const decode of [decodeColour, decodeDepth, decodeMask]) {
        refused(() => decode(file.slice(0, length)), "file", "file");
      }
    }
    const damaged = file.slice();
    damaged[45] ^= 255;
    refused(() => decodeDepth(damaged), "file", "file");
  });

  test("grey RGB is depth, a rendering is not", () => {
    const grey = png({ width: 1, height: 1, depth: 8, colourType: RGB, rows: [[5, 5, 5]] });
    assert.deepEqual([...decodeDepth(grey).data], [5]);
    const coloured = png({ width: 1, height: 1, depth: 8, colourType: RGB, rows: [[5, 6, 5]] });
    refused(() => decodeDepth(coloured), "file", "file");
  });
});

describe(".npy", () => {
  test("depth of every kind", () => {
    const decoded = (descr, data, more) => decodeDepth(npy({ descr, shape: [1, 3], data, ...more })).data;
    assert.deepEqual(decoded("<f4", new Float32Array([1.5, NaN, 3])), new Float32Array([1.5, NaN, 3]));
    assert.deepEqual(decoded("<f8", new Float64Array([1.5, 2, 3])), new Float32Array([1.5, 2, 3]));
    assert.deepEqual(decoded("<i4", new Int32Array([1, -2, 3])), new Float32Array([1, -2, 3]));
    assert.deepEqual(decoded("<u2", new Uint16Array([1, 2, 65535])), new Uint16Array([1, 2, 65535]));
    assert.deepEqual(decoded("|u1", new Uint8Array([1, 2, 3])), new Uint16Array([1, 2, 3]));
    assert.deepEqual(
      decoded("<f4", new Float32Array([1, 2, 3]), { align: 1 }),
      new Float32Array([1, 2, 3]),
      "unaligned",
    );
  });

  test("from a part of one of Node's shared buffers", () => {
    const file = npy({ descr: "<f4", shape: [1, 3], data: new Float32Array([1, 2, 3]) });
    const shared = Buffer.concat([Buffer.alloc(64, 255), file]).subarray(64);
    assert.deepEqual(decodeDepth(shared).data, new Float32Array([1, 2, 3]));
  });

  test("a cloud, colours and masks", () => {
    const data = new Float32Array([1, 2, 3, 4, 5, 6]);
    assert.deepEqual(decodeDepth(npy({ descr: "<f4", shape: [1, 2, 3], data })), { width: 2, height: 1, points: data });
    assert.deepEqual(decodeColour(npy({ descr: "<f4", shape: [2, 1, 3], data })), { width: 1, height: 2, data });
    assert.deepEqual(
      [...decodeColour(npy({ descr: "|u1", shape: [1, 1, 3], data: new Uint8Array([1, 2, 3]) })).data],
      [1, 2, 3, 255],
    );
    assert.deepEqual(
      [...decodeMask(npy({ descr: "|b1", shape: [1, 2], data: new Uint8Array([0, 1]) })).data],
      [0, 255],
    );
  });

  test("column order as numpy writes it, of every kind, is read in row order", () => {
    const read = JSON.parse(readFileSync(inRoot(RUN, "read.json"), "utf8"));
    const file = (name) => new Uint8Array(readFileSync(inRoot(RUN, `columns-${name}.npy`)));
    const expected = (name) => read[`columns-${name}.npy`];
    for (const name of ["depth", "double", "levels"]) {
      const { width, height, data } = decodeDepth(file(name));
      assert.deepEqual([height, width], expected(name).shape);
      assert.deepEqual([...data], [...expected(name).values].map(name === "levels" ? Number : Math.fround));
    }
    const { width, height, points } = decodeDepth(file("cloud"));
    assert.deepEqual([height, width, 3], expected("cloud").shape);
    assert.deepEqual([...points], expected("cloud").values);
    const colour = decodeColour(file("colour"));
    assert.deepEqual(
      [...colour.data].filter((_, i) => i % 4 < 3),
      expected("colour").values,
    );
    const mask = decodeMask(file("mask"));
    assert.deepEqual([mask.height, mask.width], expected("mask").shape);
    assert.deepEqual(
      [...mask.data],
      expected("mask").values.map((value) => 255 * value),
    );
  });

  test("wrong ones are named", () => {
    const data = new Float32Array(6);
    const wrong = (changes) => () => decodeDepth(npy({ descr: "<f4", shape: [2, 3], data, ...changes }));
    for (const changes of [
      { descr: "<c8" },
      { descr: "<i8" },
      { shape: [6] },
      { shape: [2, 1, 1, 3] },
      { shape: [1, 3, 2] },
      { shape: [20, 3] },
      { shape: [-2, 3] },
      { shape: [2.5, 3] },
      { shape: ["x", 3] },
      { shape: ["0x2", 3] },
      { shape: [2, 3, 0] },
      { shape: [0, 3] },
      { shape: [1e300, 3] },
    ]) {
      refused(wrong(changes), "file", "file");
    }
    assert.throws(wrong({ descr: "<c8" }), /type "<c8"/);
    const told = npy({ descr: "<f4", shape: [2, 3], data });
    const untold = Uint8Array.from(
      Buffer.from(
        Buffer.from(told).toString("latin1").replace("'fortran_order': False", "'fortran_order': 0    "),
        "latin1",
      ),
    );
    assert.throws(() => decodeDepth(untold), /fortran_order/);
    const five = npy({ descr: "|u1", shape: [5, 1, 5], data: new Uint8Array(25) });
    for (const decode of [decodeColour, decodeDepth, decodeMask]) refused(() => decode(five), "file", "file");
    const whole = npy({ descr: "<f4", shape: [2, 3], data });
    for (const length of [6, 9, 20, whole.length - 1])
      refused(() => decodeDepth(whole.slice(0, length)), "file", "file");
  });
});

test("neither PNG nor .npy", () => {
  refused(() => decodeColour(new Uint8Array()), "file", "file");
  refused(() => decodeColour(new TextEncoder().encode("<html>")), "file", "file");
});
