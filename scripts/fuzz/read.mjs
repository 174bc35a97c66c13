// The contract of the readers for any bytes: a reading that keeps its promises, or a BimodalError of code "file", in bounded time. The
// fuzzer shares it with tests/contract/fuzz-corpus.test.mjs, which replays the committed corpus.
import assert from "node:assert/strict";
import { decodeColour, decodeDepth, decodeMask } from "../../pkg/files.js";
import { BimodalError, readRigFile, readRigFolder } from "../../pkg/rig.js";

/** Limit of processor time for reading a small file, milliseconds. */
export const MOST_MILLISECONDS = 1000;

const isFinite = (numbers) => numbers.every((value) => Number.isFinite(value));

function checkRaster({ width, height, data }, channels, what) {
  assert.ok(
    Number.isInteger(width) && Number.isInteger(height) && width > 0 && height > 0,
    `${what} of ${width}x${height}`,
  );
  assert.equal(data.length, width * height * channels, what);
}

function checkImage(image) {
  checkRaster(image, image.data instanceof Float32Array ? 3 : 4, "an image");
  if (image.mask !== undefined) checkRaster({ ...image, data: image.mask }, 1, "an image's mask");
}

function checkDepth(depth) {
  if (depth.points === undefined) checkRaster(depth, 1, "a depth map");
  else checkRaster({ ...depth, data: depth.points }, 3, "a cloud");
  if (depth.unit !== undefined) assert.ok(depth.unit > 0 && isFinite([depth.unit]), `a unit of ${depth.unit}`);
}

function checkCamera({ camera, width, height }) {
  const { fx, fy, cx, cy, distortion = [] } = camera;
  assert.ok(isFinite([fx, fy, cx, cy, ...distortion]) && fx > 0 && fy > 0, JSON.stringify(camera));
  for (const side of [width, height])
    if (side !== undefined) assert.ok(side > 0 && isFinite([side]), `a side of ${side}`);
}

function checkPose({ pose }) {
  const { rotation: r, translation } = pose;
  assert.ok(r.length === 9 && translation.length === 3 && isFinite([...r, ...translation]), JSON.stringify(pose));
  for (const [i, j] of [
    [0, 0],
    [1, 1],
    [2, 2],
    [0, 1],
    [0, 2],
    [1, 2],
  ]) {
    const product = r[3 * i] * r[3 * j] + r[3 * i + 1] * r[3 * j + 1] + r[3 * i + 2] * r[3 * j + 2];
    assert.ok(Math.abs(product - (i === j ? 1 : 0)) < 0.05, `no rotation: ${JSON.stringify(r)}`);
  }
}

function checkWords(list) {
  for (const words of list)
    assert.ok(typeof words === "string" && words.length > 0 && !/undefined|\[object/.test(words), `says ${words}`);
}

function checkReading({ says, warnings, kind, image, depth, mask, cameras = [], poses = [] }) {
  checkWords([says, ...warnings.map(({ message }) => message)]);
  checkWords(warnings.map(({ code }) => code));
  if (kind === "colour") checkImage(image);
  else if (kind === "depth") checkDepth(depth);
  else if (kind === "mask") checkRaster(mask, 1, "a mask");
  else assert.ok(kind === "cameras" ? cameras.length > 0 : poses.length > 0, `nothing in a file of ${kind}`);
  cameras.forEach(checkCamera);
  poses.forEach(checkPose);
}

/** Every way to request a file. */
const WAYS = [
  ...[undefined, "colour", "depth", "mask", "cameras", "poses"].map((as) => ({
    name: `as ${as}`,
    run: async (bytes) => checkReading(await readRigFile({ name: "file", bytes }, as && { as })),
  })),
  { name: "decodeColour", run: (bytes) => checkImage(decodeColour(bytes)) },
  { name: "decodeDepth", run: (bytes) => checkDepth(decodeDepth(bytes)) },
  { name: "decodeMask", run: (bytes) => checkRaster(decodeMask(bytes), 1, "a mask") },
  {
    name: "folder",
    run: async (bytes) => {
      const names = ["rgb/1.png", "depth/1.png", "mask/1.png", "rgb.txt", "calibration.txt"];
      const { frames, cameras, poses, readings, warnings } = await readRigFolder(
        names.map((name) => ({ name, bytes })),
      );
      frames.forEach(({ image, depth }) => (checkImage(image), checkDepth(depth)));
      cameras.forEach(checkCamera);
      poses.forEach(checkPose);
      checkWords([...warnings.map(({ message }) => message), ...readings.map(({ says }) => says)]);
    },
  },
];

/** Processor time that a call takes, milliseconds. */
async function spentOn(run) {
  const before = process.cpuUsage();
  await run();
  const { user, system } = process.cpuUsage(before);
  return (user + system) / 1000;
}

/** Reads a file in every way and returns how many readings succeed; throws if a promise is broken. */
export async function readEveryWay(bytes) {
  const copy = bytes.slice();
  let read = 0;
  for (const { name, run } of WAYS) {
    const attempt = async () => {
      try {
        await run(bytes);
        read++;
      } catch (error) {
        if (error instanceof BimodalError && error.code === "file" && error.details?.reason)
          checkWords([error.message]);
        else throw new Error(`${name}: ${error?.stack ?? error}`, { cause: error });
      }
    };
    let spent = Infinity;
    // Other programs compete for the caches, so the best of three trials counts.
    for (let trial = 0; trial < 3 && spent > MOST_MILLISECONDS; trial++) spent = await spentOn(attempt);
    assert.ok(spent <= MOST_MILLISECONDS, `${name}: ${spent} ms`);
  }
  assert.deepEqual(bytes, copy, "the file itself was changed");
  return read;
}
