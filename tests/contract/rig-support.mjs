// Shared by the tests of a rig's files: the fixtures of scripts/reference/rig-files.py and their formulas.
import assert from "node:assert/strict";
import { readFileSync } from "node:fs";
import { fileURLToPath } from "node:url";
import { BimodalError, readRigFile } from "../../pkg/rig.js";

export const W = 16,
  H = 12;
const eachPixel = (value) => Array.from({ length: W * H }, (_, at) => value(at % W, Math.floor(at / W)));
export const millimetres = eachPixel((x, y) => ((x + y) % 7 === 0 ? 0 : 800 + 37 * x + 11 * y));
export const rgb = eachPixel((x, y) => [16 * x, 20 * y, 8 * (x + y)]);

export const fixture = (name) =>
  new Uint8Array(readFileSync(fileURLToPath(new URL(`../fixtures/rig/${name}`, import.meta.url))));
export const text = (content) => new TextEncoder().encode(content);
export const read = (name, bytes, options) =>
  readRigFile({ name, bytes: typeof bytes === "string" ? text(bytes) : bytes }, options);
export const readFixture = (name, options) => read(name, fixture(name), options);

export function close(actual, expected, tolerance, message) {
  assert.equal(actual.length, expected.length, message);
  expected.forEach((value, at) =>
    assert.ok(Math.abs(actual[at] - value) <= tolerance, `${message ?? ""} [${at}]: ${actual[at]} instead of ${value}`),
  );
}

/** The depths of a reading in metres, 0 where missing. */
export function metres({ depth }) {
  if (depth.points)
    return Array.from({ length: depth.width * depth.height }, (_, at) =>
      Number.isNaN(depth.points[3 * at + 2]) ? 0 : depth.points[3 * at + 2],
    );
  return Array.from(depth.data, (value) => (value > 0 && value < 1e12 ? value * (depth.unit ?? 1) : 0));
}

/** The colours of a reading without alpha. */
export function colours({ image }) {
  const channels = image.data instanceof Float32Array ? 3 : 4;
  return Array.from({ length: image.width * image.height }, (_, at) => [
    ...image.data.slice(channels * at, channels * at + 3),
  ]);
}

/** Checks that a file is refused, and that the error names it and a reason. */
export async function refusedFile(reading, name, reason) {
  await assert.rejects(reading, (error) => {
    assert.ok(error instanceof BimodalError, `not a BimodalError: ${error.stack}`);
    assert.deepEqual([error.code, error.field], ["file", "file"], error.message);
    assert.ok(error.message.startsWith(`${name}: `), error.message);
    assert.match(error.message, reason);
    assert.deepEqual([error.details.file, `${name}: ${error.details.reason}`], [name, error.message]);
    return true;
  });
}

/** The rotation of cv2.Rodrigues for (0.02, -0.03, 0.05), and the translation, as in the fixtures. */
export const rotation = [
  0.9983005382651491, -0.05026824436148818, -0.029481161922952533, 0.04966843433742314, 0.9985504591085095,
  -0.020737098269863558, 0.030480845296394256, 0.019237573209700973, 0.999350205807263,
];
export const translation = [-0.025, 0.001, 0.003];
export const K = { fx: 518.5, fy: 519.25, cx: 325.5, cy: 253.75 };
export const distortion = [0.2, -0.5, 0.001, -0.002, 0.3];

/** The only item of a list; fails if there is another number of items. */
export const only = (found) => (assert.equal(found.length, 1, JSON.stringify(found)), found[0]);
export const codes = ({ warnings }) => warnings.map(({ code }) => code);
export const sameCamera = ({ camera }, lens = distortion, expected = K) => {
  const { fx, fy, cx, cy } = camera;
  close([fx, fy, cx, cy], [expected.fx, expected.fy, expected.cx, expected.cy], 1e-9);
  assert.deepEqual(camera.distortion === undefined ? null : [...camera.distortion], lens);
};
export const samePose = ({ pose }, r = rotation, t = translation, tolerance = 1e-6) => {
  close(pose.rotation, r, tolerance, "rotation");
  close(pose.translation, t, tolerance, "translation");
};
export const rows = [0, 3, 6].map((at) => rotation.slice(at, at + 3));
export const matrix = [...rows.map((row, at) => [...row, translation[at]]), [0, 0, 0, 1]];
export const columns = [0, 3, 6, 1, 4, 7, 2, 5, 8].map((at) => rotation[at]);
/** The fixtures' rotation as a quaternion x y z w. */
export const quaternion = [0.009998416741873298, -0.014997625112809946, 0.024996041854683248, 0.999525037602976];
/** The fixtures' roll, pitch and yaw about fixed axes, radians. */
export const angles = [
  Math.atan2(rotation[7], rotation[8]),
  Math.asin(-rotation[6]),
  Math.atan2(rotation[3], rotation[0]),
];
/** The intrinsics of the fixtures as rows. */
export const intrinsicRows = [
  [K.fx, 0, K.cx],
  [0, K.fy, K.cy],
  [0, 0, 1],
];
export const numbers = ({ camera: { fx, fy, cx, cy } }) => [fx, fy, cx, cy];
export const lens = ({ camera }) => [camera.model ?? "brown", ...(camera.distortion ?? [])];
export const size = ({ width, height }) => [width, height];
export const ends = ({ from, to }) => [from, to];
export const json = (value, name = "calib.json") => read(name, JSON.stringify(value));
