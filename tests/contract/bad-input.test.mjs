// Every invalid input is named in an error.
import assert from "node:assert/strict";
import { before, describe, test } from "node:test";
import { Estimator, estimator, init, pair, refused, sample } from "./support.mjs";

test("before init", () => refused(() => sample({ surface: "bust", light: "colourful" }), "init", undefined));

describe("after init", () => {
  let image, depth, light;
  before(async () => {
    await init();
    ({ image, depth, light } = pair());
  });
  const make = (changes = {}, options = {}) =>
    new Estimator({ ...image, ...changes.image }, { ...depth, ...changes.depth }, options);
  const onImage = (changes) => () => make({ image: changes });
  const onDepth = (changes) => () => make({ depth: changes });
  const withOptions = (options) => () => make({}, options);

  test("sizes", () => {
    refused(onImage({ width: 0, height: 0, data: new Float32Array(0), mask: undefined }), "size", "image");
    refused(onImage({ width: 1, height: 1, data: new Float32Array(3), mask: undefined }), "size", "image");
    refused(onDepth({ width: 1, height: 1, data: new Float32Array(1), mask: undefined }), "size", "depth");
    refused(onImage({ width: 5000, height: 5000 }), "size", "image");
    refused(onImage({ width: 31 }), "size", "image.mask");
    refused(onImage({ width: 31, mask: undefined }), "size", "image.data");
    refused(onDepth({ height: 31, mask: undefined }), "size", "depth.data");
    refused(onDepth({ normals: new Float32Array(5) }), "size", "depth.normals");
    refused(onImage({ width: 32.5 }), "range", "image.width");
    refused(onImage({ width: -32 }), "range", "image.width");
    refused(onImage({ width: 2 ** 32 + 32 }), "size", "image.width");
    assert.throws(onImage({ width: 2 ** 32 + 1 }), /\(got 4294967297\)$/);
    assert.throws(onImage({ width: 1e300 }), /\(got 1e\+300\)$/);
    // A photograph of this size would be reduced to the depth map's resolution, so the error is about its missing samples.
    refused(onImage({ width: 4000, height: 3000, mask: undefined }), "size", "image.data");
    refused(onDepth({ width: 4000, height: 3000, mask: undefined }), "memory", "depth");
  });

  test("nothing to work on", () => {
    refused(onImage({ data: new Float32Array(image.data.length) }), "empty", "image.data");
    refused(onImage({ data: new Uint8Array(4 * 32 * 32) }), "empty", "image.data");
    refused(onDepth({ data: new Float32Array(32 * 32).fill(NaN) }), "empty", "depth.data");
    const onePixel = new Uint8Array(32 * 32);
    onePixel[500] = 1;
    refused(onImage({ mask: onePixel }), "empty", "image.mask");
    refused(onDepth({ mask: onePixel }), "empty", "depth.mask");
  });

  test("depth.data or depth.points, exactly one", () => {
    const points = new Float32Array(3 * 32 * 32);
    refused(onDepth({ data: undefined }), "missing", "depth.data");
    refused(onDepth({ points }), "missing", "depth.points");
  });

  test("cameras and units", () => {
    const camera = { fx: 30, fy: 30, cx: 16, cy: 16 };
    refused(onDepth({ camera: { ...camera, fx: 0 } }), "range", "depth.camera.fx");
    refused(onImage({ camera: { ...camera, fy: -1 } }), "range", "image.camera.fy");
    refused(onImage({ camera: { ...camera, cx: NaN } }), "range", "image.camera.cx");
    refused(onImage({ camera: { ...camera, distortion: [1, 2] } }), "size", "image.camera.distortion");
    refused(onImage({ camera: { ...camera, distortion: [0.1, 0, 0, 0, 0, 0] } }), "size", "image.camera.distortion");
    refused(onImage({ camera: { ...camera, model: "round" } }), "option", "image.camera.model");
    const fisheye = { ...camera, model: "fisheye", distortion: [0.1, 0, 0, 0, 0] };
    refused(onDepth({ camera: fisheye }), "size", "depth.camera.distortion");
    refused(onDepth({ camera: { ...fisheye, distortion: [NaN, 0, 0, 0] } }), "range", "depth.camera.distortion");
    const folded = { fx: 60, fy: 60, cx: 90, cy: 90, distortion: [-1, 0, 0, 0, 0] };
    refused(onDepth({ camera: folded }), "range", "depth.camera.distortion");
    refused(onImage({ camera: folded }), "range", "image.camera.distortion");
    refused(onImage({ camera: { ...camera, f: 30 } }), "option", "image.camera.f");
    refused(onDepth({ camera: { fx: 30, fy: 30, cx: 16 } }), "missing", "depth.camera.cy");
    refused(onDepth({ unit: 0 }), "range", "depth.unit");
  });

  test("the entry and the number at fault are values of the error", () => {
    const light = new Array(27).fill(0.1);
    light[5] = 1e300;
    assert.throws(withOptions({ light }), { code: "range", field: "options.light", index: 5, value: 1e300 });
    assert.throws(onDepth({ width: 31 }), (error) => !("index" in error) && !("value" in error));
  });

  test("numbers among the options", () => {
    refused(withOptions({ light: new Array(27).fill(NaN) }), "range", "options.light");
    refused(withOptions({ light: new Array(27).fill(1e300) }), "range", "options.light");
    refused(withOptions({ light: [1, 2, 3] }), "size", "options.light");
    refused(withOptions({ lambda: { prior: -1 } }), "range", "options.lambda.prior");
    refused(withOptions({ lambda: { light: NaN } }), "range", "options.lambda.light");
    refused(withOptions({ lambda: { light: 1e300 } }), "range", "options.lambda.light");
    assert.throws(withOptions({ lambda: { light: 1e300 } }), /\(got 1e\+300\)$/);
    refused(withOptions({ scale: 0 }), "range", "options.scale");
    refused(withOptions({ stopDegrees: 0 }), "range", "options.stopDegrees");
    refused(withOptions({ correspondenceDistance: -1 }), "range", "options.correspondenceDistance");
    refused(withOptions({ maxIterations: 0 }), "range", "options.maxIterations");
    refused(withOptions({ maxIterations: 1.5 }), "range", "options.maxIterations");
    refused(withOptions({ seed: -1 }), "range", "options.seed");
    refused(withOptions({ start: { rotation: [1, 0, 0] } }), "size", "options.start.rotation");
    refused(withOptions({ start: { rotation: new Array(9).fill(0) } }), "range", "options.start.rotation");
    refused(withOptions({ start: { translation: [0, 0, Infinity] } }), "range", "options.start.translation");
    for (const beta of [NaN, 500, -1e308]) {
      refused(withOptions({ start: { angles: { beta } } }), "range", "options.start.angles.beta");
    }
    withOptions({ start: { angles: { beta: 360 } } })().free();
  });

  test("lists that claim a length are not copied to see", () => {
    const endless = { length: 1e9 };
    const camera = { fx: 30, fy: 30, cx: 16, cy: 16, distortion: endless };
    refused(withOptions({ light: endless }), "size", "options.light");
    refused(withOptions({ start: { rotation: endless } }), "size", "options.start.rotation");
    refused(withOptions({ start: { translation: endless } }), "size", "options.start.translation");
    refused(onDepth({ camera }), "size", "depth.camera.distortion");
    refused(() => sample({ surface: "bust", light: endless }), "size", "sample.light");
    refused(withOptions({ light: { length: NaN } }), "size", "options.light");
    refused(withOptions({ light: { length: 27 } }), "type", "options.light");
  });

  test("misspelt names, with the likely one", () => {
    refused(withOptions({ regstration: "icp" }), "option", "options.regstration");
    assert.throws(withOptions({ regstration: "icp" }), /did you mean "registration"\?/);
    assert.throws(withOptions({ LAMBDA: {} }), /did you mean "lambda"\?/);
    assert.throws(withOptions({ zzz: 1 }), /known: light, prior, start/);
    // Words of any length are compared with the known ones quickly, and messages repeat them only in part.
    assert.throws(withOptions({ ["z".repeat(1e6)]: 1 }), ({ message }) => message.length < 1000);
    assert.throws(withOptions({ start: "z".repeat(1e7) }), ({ message }) => message.length < 1000);
    refused(withOptions({ lambda: { priors: 1 } }), "option", "options.lambda.priors");
    refused(withOptions({ start: { angels: {} } }), "option", "options.start.angels");
    refused(withOptions({ start: { angles: { delta: 1 } } }), "option", "options.start.angles.delta");
    refused(withOptions({ start: "identty" }), "option", "options.start");
    refused(withOptions({ constructor: 1 }), "option", "options.constructor");
    refused(onImage({ colour: 1 }), "option", "image.colour");
    refused(onDepth({ Unit: 1 }), "option", "depth.Unit");
    refused(() => sample({ surface: "bust", light: "colourful", sise: 32 }), "option", "sample.sise");
  });

  test("wrong types", () => {
    refused(() => new Estimator(undefined, depth), "type", "image");
    refused(() => new Estimator(image, []), "type", "depth");
    refused(withOptions(null), "type", "options");
    refused(onImage({ data: [1, 2, 3] }), "type", "image.data");
    refused(onImage({ data: undefined }), "missing", "image.data");
    refused(onImage({ width: "32" }), "type", "image.width");
    refused(onImage({ mask: new Float32Array(32 * 32) }), "type", "image.mask");
    refused(onImage({ camera: 5 }), "type", "image.camera");
    refused(onImage({ transfer: "gamma" }), "option", "image.transfer");
    refused(onDepth({ data: new Float64Array(32 * 32) }), "type", "depth.data");
    refused(withOptions({ light: { red: 1 } }), "type", "options.light");
    refused(withOptions({ light: new Array(27).fill("1") }), "type", "options.light");
    assert.throws(withOptions({ light: Object.assign(new Array(27).fill(1), { 5: 1n }) }), /entry 5, not bigint/);
    refused(withOptions({ maxIterations: "10" }), "type", "options.maxIterations");
    refused(withOptions({ trim: 1 }), "type", "options.trim");
    refused(withOptions({ registration: 3 }), "type", "options.registration");
  });

  test("arrays whose memory is gone, and arrays that are none or lie about their length", () => {
    const gone = (array) => (structuredClone(array, { transfer: [array.buffer] }), array);
    refused(onImage({ data: gone(image.data.slice()) }), "empty", "image.data");
    refused(onImage({ mask: gone(image.mask.slice()) }), "empty", "image.mask");
    refused(onDepth({ data: gone(depth.data.slice()) }), "empty", "depth.data");
    refused(() => Estimator.restore(gone(new Uint8Array(9))), "empty", "state");
    const buffer = new ArrayBuffer(image.data.byteLength, { maxByteLength: 2 * image.data.byteLength });
    const shrunk = new Float32Array(buffer, 0, image.data.length);
    buffer.resize(16);
    refused(onImage({ data: shrunk }), "empty", "image.data");
    // A false length could make the numerics allocate 4e9 bytes and abort.
    refused(
      onImage({ data: Object.defineProperty(image.data.slice(), "length", { value: 1e9 }) }),
      "type",
      "image.data",
    );
    class Short extends Float32Array {
      get length() {
        return 7;
      }
    }
    refused(onImage({ data: new Short(image.data) }), "type", "image.data");
    refused(onImage({ data: Object.create(Float32Array.prototype) }), "type", "image.data");
    refused(onImage({ data: new Proxy(image.data, {}) }), "type", "image.data");
    // A view of shared memory or of a part of a buffer is valid.
    const within = new Float32Array(new SharedArrayBuffer(image.data.byteLength + 12), 12);
    within.set(image.data);
    make({ image: { data: within } }).free();
  });

  test("samples", () => {
    const request = (changes) => () => sample({ surface: "bust", light: "colourful", ...changes });
    refused(request({ surface: "teapot" }), "range", "sample.surface");
    refused(request({ light: "candle" }), "range", "sample.light");
    refused(request({ light: [1] }), "size", "sample.light");
    refused(request({ size: 8 }), "size", "sample.size");
    refused(request({ overlap: 0 }), "range", "sample.overlap");
    refused(request({ noise: -1 }), "range", "sample.noise");
    for (const beta of [NaN, 500]) refused(request({ angles: { beta } }), "range", "sample.angles.beta");
    refused(request({ holes: 1 }), "range", "sample.holes");
    refused(request({ surface: undefined }), "missing", "sample.surface");
    refused(request({ surface: { width: 64, height: 64 } }), "missing", "sample.surface.heights");
    refused(request({ surface: { width: 10, height: 10, heights: new Float32Array(100) } }), "size", "sample.surface");
    refused(
      request({ surface: { width: 64, height: 64, heights: new Float32Array(64 * 64) } }),
      "empty",
      "sample.surface.heights",
    );
    const heights = new Float32Array(5);
    refused(request({ surface: { width: 0.5, height: 64, heights } }), "range", "sample.surface.width");
    assert.throws(request({ surface: { width: 64, height: 64, heights } }), (error) =>
      error.field.startsWith("sample.surface"),
    );
  });

  test("a refused input leaves everything else alone", () => {
    const good = estimator({ light });
    refused(withOptions({ lambda: { prior: -1 } }), "range", "options.lambda.prior");
    refused(() => good.reset({ scale: -1 }), "range", "options.scale");
    refused(() => good.points("both"), "option", "view");
    assert.equal(good.step().iteration, 1);
  });
});
