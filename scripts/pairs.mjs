// node scripts/pairs.mjs: runs the loop on every real pair beside the project; prints a table and saves pictures in target/pairs/.
import { mkdirSync, writeFileSync } from "node:fs";
import { encode } from "fast-png";
import { build } from "./build.mjs";
import { MISSING, PAIRS, hasData, runPair, table } from "./real-pairs.mjs";
import { Failure, inRoot, say, script } from "./shell.mjs";
import { setup } from "./setup.mjs";

/** Share of the depths at either end that the grey scale leaves out; otherwise one flying pixel would take up the whole scale. */
const OUTSIDE = 0.01;
/** Colour of pixels without a value, as on the page: neither black nor the colour of any normal. */
const MISSING_COLOUR = [48, 0, 0];

/** A picture of `pixel(index)`, cropped to the mask's bounding box. */
function picture({ width, mask }, pixel) {
  const inside = [...mask.keys()].filter((index) => mask[index]);
  const range = (values) =>
    values.reduce(([low, high], value) => [Math.min(low, value), Math.max(high, value)], [Infinity, 0]);
  const [left, right] = range(inside.map((index) => index % width));
  const [top, bottom] = range(inside.map((index) => Math.floor(index / width)));
  const size = { width: right - left + 1, height: bottom - top + 1 };
  const data = new Uint8Array(3 * size.width * size.height);
  for (let row = 0; row < size.height; row++) {
    for (let column = 0; column < size.width; column++) {
      const index = (row + top) * width + column + left;
      data.set((mask[index] && pixel(index)) || MISSING_COLOUR, 3 * (row * size.width + column));
    }
  }
  return { ...size, data };
}

/** Greys between two depths; near is white. */
const greys =
  (depth, [near, far]) =>
  (index) => {
    const share = (depth[index] - near) / (far - near);
    return depth[index] > 0 && new Array(3).fill(255 - 215 * Math.min(1, Math.max(0, share)));
  };

/** Red is x to the right, green y upward, blue toward the camera. */
const colours = (normals) => (index) => {
  const [x, y, z] = normals.subarray(3 * index, 3 * index + 3);
  return Number.isFinite(z) && [x, -y, -z].map((part) => 127.5 * (part + 1));
};

function save(name, { image, depth }, { refined, imageNormals, depthNormals }) {
  const metres = Float32Array.from(depth.data, (value) => value * depth.unit);
  const sorted = metres.filter((value, index) => value > 0 && depth.mask[index]).sort();
  const range = [OUTSIDE, 1 - OUTSIDE].map((share) => sorted[Math.floor(share * (sorted.length - 1))]);
  const pictures = {
    image: picture(image, (index) => image.data.subarray(4 * index, 4 * index + 3)),
    "image-normals": picture(image, colours(imageNormals)),
    "given-depth": picture(depth, greys(metres, range)),
    "refined-depth": picture(depth, greys(refined, range)),
    "refined-normals": picture(depth, colours(depthNormals)),
  };
  for (const [kind, made] of Object.entries(pictures)) {
    writeFileSync(inRoot(`target/pairs/${name}-${kind}.png`), encode({ ...made, channels: 3, depth: 8 }));
  }
}

await script(async () => {
  if (!hasData()) throw new Failure(`Nothing to do: ${MISSING}.`);
  await setup();
  await build();
  const { default: init, Estimator } = await import("../pkg/index.js");
  const files = await import("../pkg/files.js");
  await init();
  mkdirSync(inRoot("target/pairs"), { recursive: true });
  const rows = [];
  for (const [name, read] of Object.entries(PAIRS)) {
    const pair = read(files);
    const result = await runPair(Estimator, pair);
    save(name, pair, result);
    rows.push([name, result]);
    if (result.report.message) say(`${name}: ${result.report.message}`);
  }
  console.log(table(rows).join("\n"));
  say("pictures are in target/pairs/");
});
