// Single parts of the method, as the page's lessons use them.
import assert from "node:assert/strict";
import { before, describe, test } from "node:test";
import * as package_ from "../../pkg/index.js";
import { init, refused, sample } from "./support.mjs";

const { integrateNormals, pixelLandscape, shadeNormals, turnLight } = package_;
const { basRelief, characteristicStrips, secondOrder, shadeLamp } = package_;
const NORMAL = [0.36, -0.48, -0.8];

let light;
before(async () => {
  await init();
  ({ light } = sample({ surface: "bust", light: "colourful", size: 16 }));
});

/** Eq. 5 written out, with nine terms per channel. */
function shade([x, y, z], l) {
  const basis = [
    0.886227,
    2 * 0.511664 * y,
    2 * 0.511664 * z,
    2 * 0.511664 * x,
    2 * 0.429043 * x * y,
    2 * 0.429043 * y * z,
    0.743125 * z * z - 0.247708,
    2 * 0.429043 * x * z,
    0.429043 * (x * x - y * y),
  ];
  return [0, 9, 18].map((from) => basis.reduce((sum, value, k) => sum + value * l[from + k], 0));
}

describe("predicted colours", () => {
  test("are the quadratic form of Eq. 5", () => {
    const normals = Float32Array.of(...NORMAL, 0, 0, -1, NaN, NaN, NaN);
    const found = shadeNormals(light, normals);
    const wanted = [...shade(NORMAL, light), ...shade([0, 0, -1], light)];
    wanted.forEach((value, at) => assert.ok(Math.abs(found[at] - value) < 1e-6));
    assert.ok(found.subarray(6).every(Number.isNaN));
    assert.equal(shadeNormals(light, new Float32Array()).length, 0);
  });

  test("of a turned normal under the light turned alike stay", () => {
    // gamma = 90 rotates x to y.
    const turned = turnLight(light, { gamma: 90 });
    const there = shadeNormals(turned, Float32Array.of(0.48, 0.36, -0.8));
    shade(NORMAL, light).forEach((value, at) => assert.ok(Math.abs(there[at] - value) < 1e-6));
    turnLight(light, {}).forEach((value, at) => assert.ok(Math.abs(value - light[at]) < 1e-12));
  });
});

describe("one lamp", () => {
  const LAMP = [0.6, 0, -0.8];
  const close = (found, wanted, within = 1e-6) =>
    wanted.forEach((value, at) => assert.ok(Math.abs(found[at] - value) < within, `${found[at]} ${value}`));

  test("lights a matte surface by the cosine", () => {
    const normals = Float32Array.of(...NORMAL, 0.6, 0, -0.8, -0.8, 0, -0.6);
    close(shadeLamp(LAMP, normals), [0.856, 1, 0]);
    refused(() => shadeLamp([0, NaN, 1], normals), "range", "lamp[1]");
    refused(() => shadeLamp(LAMP, new Float32Array(4)), "size", "normals");
  });

  test("lights a bas-relief as it lit the surface", () => {
    const normals = Float32Array.of(...NORMAL, 0, 0, -1);
    for (const [stretch, right, down] of [
      [0.5, 0, 0],
      [-1, 0, 0],
      [1.3, 0.2, -0.4],
    ]) {
      const found = basRelief(normals, LAMP, stretch, right, down);
      const seen = shadeLamp(found.lamp, found.normals).map((value, at) => value * found.albedo[at]);
      close(seen, [...shadeLamp(LAMP, normals)]);
      // The expected slope is p = -n_x / n_z.
      close([-found.normals[0] / found.normals[2]], [stretch * (NORMAL[0] / 0.8) + right], 1e-5);
    }
    refused(() => basRelief(normals, LAMP, 0), "range", "stretch");
  });

  test("is approximated by three Legendre polynomials", () => {
    const count = 1000;
    const middles = Array.from({ length: count }, (_, at) => (2 * at + 1) / count - 1);
    const found = secondOrder(Float32Array.from(middles, (c) => Math.max(0, c)));
    close(
      found,
      middles.map((c) => 1 / 4 + c / 2 + (5 / 32) * (3 * c * c - 1)),
      1e-4,
    );
  });

  test("is followed along strips of a ball", () => {
    const [side, radius, middle] = [97, 44, 48];
    const normals = new Float32Array(3 * side * side).fill(NaN);
    for (let at = 0; at < side * side; at++) {
      const [x, y] = [((at % side) - middle) / radius, (Math.floor(at / side) - middle) / radius];
      if (x * x + y * y < 0.99) normals.set([x, y, -Math.sqrt(1 - x * x - y * y)], 3 * at);
    }
    const request = { width: side, height: side, lamp: [0, 0, -1], centre: [middle, middle], count: 8 };
    const points = characteristicStrips({ ...request, intensity: shadeLamp([0, 0, -1], normals) });
    const ends = points.reduce((all, value, at) => (at % 3 === 0 && Number.isNaN(value) ? [...all, at] : all), []);
    assert.equal(ends.length, 8);
    for (let at = 0; at < points.length; at += 3) {
      const far = Math.hypot(points[at] - middle, points[at + 1] - middle);
      if (!(far < 0.9 * radius)) continue;
      const depth = radius - Math.sqrt(radius * radius - far * far);
      assert.ok(Math.abs(points[at + 2] - depth) < 0.02 * radius, `${far}: ${points[at + 2]} ${depth}`);
    }
    const flat = new Float32Array(side * side).fill(1);
    refused(() => characteristicStrips({ ...request, intensity: flat }), "range", "centre");
    refused(() => characteristicStrips({ ...request, intensity: flat.subarray(1) }), "size", "values");
    refused(() => characteristicStrips({ ...request, intensity: flat, count: 361 }), "size", "strips.count");
  });
});

describe("integrated normals", () => {
  test("are the surface that has them", () => {
    const [width, height, slope] = [20, 12, 0.25];
    const length = Math.hypot(1, slope);
    const normals = new Float32Array(3 * width * height).map((_, at) => [slope / length, 0, -1 / length][at % 3]);
    for (const robust of [false, true]) {
      const depth = integrateNormals(normals, width, height, robust);
      depth.forEach((value, at) => assert.ok(Math.abs(value - slope * ((at % width) - (width - 1) / 2)) < 1e-3));
    }
  });

  test("need as many as there are pixels", () => {
    refused(() => integrateNormals(new Float32Array(9), 2, 2), "size", "mask");
    refused(() => integrateNormals(new Float32Array(12).fill(NaN), 2, 2), "empty", "mask");
    refused(() => integrateNormals([0, 0, -1], 1, 1), "type", "normals");
    refused(() => integrateNormals(new Float32Array(3), 0, 1), "size", "width");
  });
});

describe("the landscape of a pixel", () => {
  const at = (landscape, place) => landscape.minima.subarray(5 * place, 5 * place + 3);

  test("has its lowest minimum at the normal that made the colours", () => {
    const landscape = pixelLandscape({ log: shade(NORMAL, light), light, side: 33 });
    assert.equal(landscape.objective.length, 33 * 33);
    NORMAL.forEach((value, axis) => assert.ok(Math.abs(at(landscape, 0)[axis] - value) < 2e-3));
    assert.deepEqual([...landscape.path.subarray(0, 3)], [0, 0, -1]);
    const finite = landscape.objective.filter(Number.isFinite);
    assert.ok(Math.min(...finite) < 0.01 && Math.max(...finite) > 0.3);
    // The corners are not normals.
    assert.ok(Number.isNaN(landscape.objective[0]));
  });

  test("follows a prior as it weighs more, and a robust one only so far", () => {
    const prior = [-0.6, 0, -0.8];
    const off = (options) => {
      const normal = at(pixelLandscape({ log: shade(NORMAL, light), light, prior, side: 1, ...options }), 0);
      return Math.hypot(...prior.map((value, axis) => value - normal[axis]));
    };
    const weights = [0, 0.1, 1, 100].map((weight) => off({ weight, robust: false }));
    assert.ok(
      weights.every((value, i) => i === 0 || value < weights[i - 1]),
      weights.join(),
    );
    // At 65 degrees, a robust prior has nearly no effect, and a plain one moves the pixel nearly halfway.
    assert.ok(off({ weight: 1 }) > 0.95 * weights[0] && off({ weight: 1, robust: false }) < 0.6 * weights[0]);
  });

  test("refuses what it cannot be", () => {
    const request = { log: [0, 0, 0], light };
    refused(() => pixelLandscape({ ...request, light: [1] }), "size", "landscape.light");
    refused(() => pixelLandscape({ light }), "missing", "landscape.log");
    refused(() => pixelLandscape({ ...request, side: 4096 }), "size", "landscape.side");
    refused(() => pixelLandscape({ ...request, weight: -1 }), "range", "landscape.weight");
    for (const value of [NaN, Infinity, 1e300])
      refused(() => pixelLandscape({ ...request, log: [0, value, 0] }), "range", "landscape.log[1]");
    refused(
      () =>
        shadeNormals(
          Array.from({ length: 27 }, () => NaN),
          new Float32Array(3),
        ),
      "range",
      "light",
    );
  });
});
