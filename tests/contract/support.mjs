// The built package, small inputs for it, and files made byte by byte.
import assert from "node:assert/strict";
import { crc32, deflateSync } from "node:zlib";
import init, * as package_ from "../../pkg/index.js";

export { init };
export const {
  BimodalError,
  Estimator,
  checkCalibration,
  sample,
  sampleBound,
  sampleLights,
  sampleSurfaces,
  shadeNormals,
  turnLight,
} = package_;

/** A pair with a known answer that takes little time. */
export const pair = (request = {}) => sample({ surface: "bust", light: "colourful", size: 32, ...request });

/** An estimator of that pair whose initial pose is near the answer. */
export function estimator(options = {}, { image, depth, light } = pair()) {
  return new Estimator(image, depth, { light, start: "identity", scale: 1, ...options });
}

/** All results, bit by bit, except times. */
export function outcome(estimator) {
  const { milliseconds, ...report } = estimator.report;
  const arrays = [
    estimator.imageNormals(),
    estimator.imageDepth(),
    estimator.depthNormals(),
    estimator.refinedDepth(),
    estimator.residual(),
  ];
  return { report, bits: arrays.map((array) => new Uint32Array(array.buffer)), light: estimator.light() };
}

/** Checks that a call is refused with this code and field, and that the message begins with the field. */
export function refused(call, code, field) {
  assert.throws(call, (error) => {
    assert.ok(error instanceof BimodalError, `not a BimodalError: ${error}`);
    assert.ok(error instanceof Error);
    assert.equal(error.name, "BimodalError");
    assert.deepEqual([error.code, error.field], [code, field], error.message);
    assert.equal("field" in error, field !== undefined, "absent rather than undefined");
    // A file is not a member of the contract, so its message begins with its name.
    if (field && code !== "file") assert.ok(error.message.startsWith(field), error.message);
    return true;
  });
}

function chunk(type, data) {
  const body = Buffer.concat([Buffer.from(type, "latin1"), data]);
  const frame = Buffer.alloc(body.length + 8);
  frame.writeUInt32BE(data.length, 0);
  body.copy(frame, 4);
  frame.writeUInt32BE(crc32(body), body.length + 4);
  return frame;
}

/** A PNG with its rows as the bytes in the file (big-endian, packed). */
export function png({ width, height, depth, colourType, rows, palette }) {
  const header = Buffer.alloc(13);
  header.writeUInt32BE(width, 0);
  header.writeUInt32BE(height, 4);
  header.set([depth, colourType], 8);
  const filtered = Buffer.concat(rows.map((row) => Buffer.from([0, ...row])));
  return new Uint8Array(
    Buffer.concat([
      Buffer.from("\x89PNG\r\n\x1a\n", "latin1"),
      chunk("IHDR", header),
      ...(palette ? [chunk("PLTE", Buffer.from(palette))] : []),
      chunk("IDAT", deflateSync(filtered)),
      chunk("IEND", Buffer.alloc(0)),
    ]),
  );
}

/** A .npy file of version 1 whose data begin at a multiple of `align`, which is 64 in NumPy. */
export function npy({ descr, shape, data, fortran = false, align = 64 }) {
  const entry = `{'descr': '${descr}', 'fortran_order': ${fortran ? "True" : "False"}, 'shape': (${shape.join(", ")}${shape.length === 1 ? "," : ""}), }`;
  const length = Math.ceil((11 + entry.length) / align) * align - 10;
  const head = Buffer.alloc(10 + length, " ");
  head.write("\x93NUMPY\x01\x00", 0, "latin1");
  head.writeUInt16LE(length, 8);
  head.write(entry, 10, "latin1");
  head.write("\n", head.length - 1);
  return new Uint8Array(Buffer.concat([head, Buffer.from(data.buffer, data.byteOffset, data.byteLength)]));
}
