// Builds the pair of a run from the visitor's files (js/pair): sizes, cameras, units and masks. The page reads them through `pkg/pair.js`.
import assert from "node:assert/strict";
import { describe, test } from "node:test";
import { camerasFor, pairOf, readPart } from "../../pkg/pair.js";
import { close } from "./rig-support.mjs";
import { png, refused } from "./support.mjs";

const image = (width, height, pixel, more = {}) => ({
  kind: "colour",
  name: "c.png",
  says: "",
  warnings: [],
  image: {
    width,
    height,
    data: Uint8Array.from({ length: 4 * width * height }, (_, at) =>
      at % 4 === 3 ? 255 : pixel((at >> 2) % width, Math.floor((at >> 2) / width), at % 4),
    ),
    ...more,
  },
});
const guessed = (unit) => ({
  code: "unit-guessed",
  message:
    "The file does not state its unit. It was guessed to be millimetres, so depths are 0.50 to 0.90 m; give the unit if that is wrong.",
  isDoubt: true,
  unit,
});
const map = (width, height, { unit = 0.001, warnings = [guessed(0.001)], ...more } = {}) => ({
  kind: "depth",
  name: "d.png",
  says: "",
  warnings,
  guessed: warnings.length > 0 ? ["unit"] : [],
  depth: { width, height, unit, data: new Uint16Array(width * height).fill(700), ...more },
});
const camera = (width, height, focal) => ({
  fx: focal,
  fy: focal,
  cx: (width - 1) / 2,
  cy: (height - 1) / 2,
});
const black = () => 0;
const nothing = () => {};

describe("the unit", () => {
  const colour = image(8, 8, black);
  const depthCamera = camera(8, 8, 10);

  test("is that of the reader where there is a camera, and says that it was guessed", () => {
    const { depth, notes, unit } = pairOf({ colour, depth: map(8, 8), depthCamera }, nothing);
    assert.deepEqual([depth.unit, unit], [0.001, 0.001]);
    assert.match(
      notes["depth.unit"],
      /^The file does not state its unit\. It was guessed to be millimetres, .* 0\.90 m; give the unit/,
    );
    // A unit that a file states is not guessed.
    const stated = pairOf({ colour, depth: map(8, 8, { unit: 1 / 256, warnings: [] }), depthCamera }, nothing);
    assert.deepEqual([stated.depth.unit, stated.unit, stated.notes["depth.unit"]], [1 / 256, 1 / 256, undefined]);
  });

  test("stays as it was given", () => {
    const { depth, notes, unit } = pairOf({ colour, depth: map(8, 8), depthCamera, unit: 0.002 }, nothing);
    assert.deepEqual([depth.unit, unit, notes["depth.unit"]], [0.002, undefined, undefined]);
    assert.ok(pairOf({ colour, depth: map(8, 8), depthCamera, unit: 0.001 }, nothing).notes["depth.unit"]);
  });

  test("is the pixel without a camera, and that is said", () => {
    const { depth, notes, unit } = pairOf({ colour, depth: map(8, 8) }, nothing);
    assert.deepEqual([depth.unit, unit], [undefined, undefined]);
    assert.match(notes["depth.unit"], /look like millimetres, but without a depth camera each counts as one pixel/);
  });
});

describe("a large image beside a coarse depth map", () => {
  // Pixels of each 20x20 block alternate between two levels, so that a mean of codes differs from a mean of intensities.
  const [WIDTH, HEIGHT] = [1280, 960];
  const striped = (x, _y, channel) => (x % 2 === 0 ? 60 : 180) + 10 * channel;
  const linear = (level) => (level / 255 <= 0.04045 ? level / 255 / 12.92 : ((level / 255 + 0.055) / 1.055) ** 2.4);

  test("is made smaller by the whole part of the ratio, by means of linear intensity", () => {
    const said = [];
    const { image: small, notes } = pairOf({ colour: image(WIDTH, HEIGHT, striped), depth: map(64, 48) }, (words) =>
      said.push(words),
    );
    assert.deepEqual([small.width, small.height, small.data.constructor], [64, 48, Uint16Array]);
    assert.equal(small.transfer, "srgb");
    for (let c = 0; c < 3; c++) {
      const expected = (linear(60 + 10 * c) + linear(180 + 10 * c)) / 2;
      const code = expected <= 0.0031308 ? 12.92 * expected : 1.055 * expected ** (1 / 2.4) - 0.055;
      // The errors are half a level of 16 bits and the single precision of the table.
      close([small.data[4 * 700 + c]], [65535 * code], 1);
    }
    assert.equal(
      notes.image,
      "1280 × 960 px is 20.0 times as fine as the depth map; scaled down by 20; pixels are those of the smaller picture",
    );
    assert.deepEqual(said, [`c.png: ${notes.image}.`]);
  });

  test("by its cameras' focal lengths where both are known, with its camera", () => {
    const colourCamera = camera(WIDTH, HEIGHT, 900);
    const parts = { colour: image(WIDTH, HEIGHT, striped), depth: map(64, 48), colourCamera };
    const { image: small } = pairOf({ ...parts, depthCamera: camera(64, 48, 100) }, nothing);
    assert.deepEqual([small.width, small.height], [Math.floor(WIDTH / 9), Math.floor(HEIGHT / 9)]);
    const { fx, fy, cx, cy } = small.camera;
    // The first pixel's centre is the mean of the centres of its nine columns.
    close([fx, fy, cx, cy], [100, 100, (colourCamera.cx - 4) / 9, (colourCamera.cy - 4) / 9], 1e-12);
  });

  test("leaves black and saturated blocks what they are, and the mask's outside out of every mean", () => {
    const level = (x) => (x < 640 ? 2 : x < 1000 ? 255 : 100);
    const inside = (x) => x < 1000 || x % 2 === 0;
    const mask = Uint8Array.from({ length: WIDTH * HEIGHT }, (_, at) => (inside(at % WIDTH) ? 255 : 0));
    const bright = image(WIDTH, HEIGHT, (x) => (inside(x) ? level(x) : 200));
    const colourMask = { width: WIDTH, height: HEIGHT, data: mask };
    const parts = { colour: bright, depth: map(64, 48), colourMask };
    const { image: small } = pairOf(parts, nothing);
    const factor = Math.round(WIDTH / small.width);
    const at = (x) => small.data[4 * (small.width * 3 + Math.floor(x / factor))];
    assert.deepEqual([at(100), at(800)], [0, 65535]);
    close([at(1200)], [257 * 100], 1);
    assert.equal(small.mask.length, small.width * small.height);
    assert.ok(small.mask.every((value) => value === 255));
  });

  test("stays as it is where it is small, or no finer than the depth map", () => {
    const small = image(640, 480, striped);
    assert.equal(pairOf({ colour: small, depth: map(64, 48) }, nothing).image.data, small.image.data);
    const equal = image(WIDTH, HEIGHT, striped);
    assert.equal(pairOf({ colour: equal, depth: map(WIDTH, HEIGHT) }, nothing).image.data, equal.image.data);
  });
});

test("more pixels than the library takes are scaled down, whatever the depth map's size", () => {
  const {
    image: small,
    depth,
    notes,
  } = pairOf(
    { colour: image(4104, 16, () => 90), depth: map(8200, 16), unit: 1, depthCamera: camera(8200, 16, 3000) },
    nothing,
  );
  assert.deepEqual([small.width, small.height, depth.width, depth.height], [2052, 8, 2733, 5]);
  assert.match(notes.image, /exceeds the library's limit; scaled down by 2/);
  assert.match(notes.depth, /one pixel in 3 is used/);
  close([depth.camera.fx, depth.camera.cx], [1000, (4099.5 - 1) / 3], 1e-9);
});

test("a mask has the size of its picture, and one that is missing before a visible background is said", () => {
  const parts = { colour: image(8, 8, () => 90), depth: map(8, 8) };
  assert.match(pairOf(parts, nothing).notes["image.mask"], /no mask, and its background is not black/);
  assert.equal(pairOf({ ...parts, colour: image(8, 8, black) }, nothing).notes["image.mask"], undefined);
  const colourMask = { width: 8, height: 8, data: new Uint8Array(64).fill(255) };
  assert.equal(pairOf({ ...parts, colourMask }, nothing).notes["image.mask"], undefined);
  // The object touches one side of the frame, as a bust does.
  const bust = image(64, 64, (x, y) => (Math.hypot(x - 32, y - 50) < 20 ? 90 : 2));
  assert.equal(pairOf({ ...parts, colour: bust }, nothing).notes["image.mask"], undefined);
  assert.throws(
    () => pairOf({ ...parts, colourMask: { ...colourMask, width: 4 } }, nothing),
    ({ code, field, message }) => code === "size" && field === "image.mask" && /4 × 8 px.*8 × 8/.test(message),
  );
});

describe("cameras", () => {
  const given = (more) => ({ file: "k.json", camera: camera(96, 96, 120), width: 96, height: 96, ...more });
  const size = { width: 48, height: 48 };

  test("of another picture size are scaled where the aspect agrees, and both sizes are named", () => {
    const { colour, depth, warnings } = camerasFor([given({ name: "color" })], size, size);
    assert.equal(depth, undefined);
    close([colour.camera.fx, colour.camera.cx], [60, 23.5], 1e-12);
    assert.equal(colour.file, "k.json");
    assert.match(
      warnings[0].message,
      /colour images are for 96x96 pixels, but these pictures have 48x48: the intrinsics were scaled/,
    );
  });

  test("of another aspect are left out, and that is said", () => {
    const { colour, warnings } = camerasFor([given({ name: "color", height: 54 })], size, size);
    assert.equal(colour, undefined);
    assert.deepEqual(
      warnings.map(({ code }) => code),
      ["camera-size", "camera-left-out"],
    );
    assert.match(warnings[1].message, /^k\.json: not used for the colour images/);
  });

  test("go by the name of their file, by size, and a single one is that of both registered pictures", () => {
    const one = given({ file: "depth.json", width: 48, height: 48 });
    const byName = camerasFor([one], { width: 64, height: 64 }, size);
    assert.deepEqual([byName.colour, byName.depth?.file], [undefined, "depth.json"]);
    const both = camerasFor([given({ width: 48, height: 48 })], size, size);
    assert.deepEqual([both.colour?.file, both.depth?.file], ["k.json", "k.json"]);
    const two = [given({ width: 48, height: 48 }), given({ width: 64, height: 48, file: "j.json" })];
    const bySize = camerasFor(two, { width: 64, height: 48 }, size);
    assert.deepEqual([bySize.colour?.file, bySize.depth?.file], ["j.json", "k.json"]);
  });
});

test("larger pictures than those of a rig are read, and what is none of them is refused by name", async () => {
  const wide = png({ width: 4200, height: 1, depth: 8, colourType: 0, rows: [Array(4200).fill(7)] });
  const reading = await readPart({ name: "w.png", bytes: wide }, { as: "colour" });
  assert.deepEqual([reading.name, reading.image.width], ["w.png", 4200]);
  await assert.rejects(
    readPart({ name: "t.txt", bytes: new TextEncoder().encode("words") }, { as: "colour" }),
    (error) => {
      refused(
        () => {
          throw error;
        },
        "file",
        "file",
      );
      assert.match(error.message, /^t\.txt: /);
      return true;
    },
  );
});
