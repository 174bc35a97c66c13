// Options of rendered scenes beyond a plain pair: the paper's bare grid, a scale, and the physical limit.
import assert from "node:assert/strict";
import { before, describe, test } from "node:test";
import { Estimator, init, refused, sample, sampleBound, sampleLights, shadeNormals, turnLight } from "./support.mjs";

const BUST = { surface: "bust", light: "colourful" };
const NOISY = { ...BUST, noise: 0.01 };

before(() => init());

describe("scale", () => {
  test("is the pose's, and makes the depth view as much smaller", () => {
    const area = ({ depth }) => depth.mask.filter(Boolean).length;
    const [plain, scaled] = [1, 1.25].map((scale) => sample({ ...BUST, scale, angles: {} }));
    assert.equal(plain.pose.scale, 1);
    assert.equal(scaled.pose.scale, 1.25);
    assert.ok(Math.abs(area(plain) / area(scaled) / 1.25 ** 2 - 1) < 0.05);
  });

  test("out of range", () => {
    refused(() => sample({ ...BUST, scale: 0 }), "range", "sample.scale");
    refused(() => sample({ ...BUST, scale: "1" }), "type", "sample.scale");
  });
});

describe("the bare grid", () => {
  const request = { ...BUST, protocol: "grid", angles: { beta: 60 } };

  test("is the image's own points, turned, with their normals", () => {
    const { image, depth, pose, truth } = sample(request);
    assert.deepEqual([image.width, image.height, depth.width, depth.height], [32, 32, 32, 32]);
    assert.equal(depth.data, undefined);
    const carry = ([x, y, z], [a, b, c]) => a * x + b * y + c * z;
    const rows = [0, 3, 6].map((first) => pose.rotation.slice(first, first + 3));
    let compared = 0;
    for (let index = 0; index < 32 * 32; index++) {
      if (!depth.mask[index]) continue;
      const point = depth.points.subarray(3 * index, 3 * index + 3);
      const normal = depth.normals.subarray(3 * index, 3 * index + 3);
      const where = rows.map((row, axis) => carry(point, row) + pose.translation[axis]);
      assert.ok(Math.abs(where[2] - truth.imageDepth[index]) < 1e-4);
      assert.ok(Math.abs(where[0] - ((index % 32) - 15.5)) < 1e-4);
      rows.forEach((row, axis) =>
        assert.ok(Math.abs(carry(normal, row) - truth.imageNormals[3 * index + axis]) < 1e-5),
      );
      compared++;
    }
    assert.ok(compared > 300);
    new Estimator(image, depth).free();
  });

  test("keeps the middle columns", () => {
    const columns = ({ depth }) => new Set([...depth.mask.keys()].filter((i) => depth.mask[i]).map((i) => i % 32)).size;
    assert.equal(columns(sample({ ...request, overlap: 0.25 })), Math.round(0.25 * columns(sample(request))));
  });

  test("refuses what it would ignore", () => {
    for (const surplus of [{ size: 64 }, { scale: 1 }, { noise: 0.01 }, { holes: 0.1 }, { seed: 2 }]) {
      refused(() => sample({ ...request, ...surplus }), "option", `sample.${Object.keys(surplus)[0]}`);
    }
    refused(() => sample({ ...BUST, protocol: "bare" }), "option", "sample.protocol");
  });
});

describe("sampleBound", () => {
  test("is linear in the noise and larger where the light is unknown", () => {
    const [known, unknown] = [true, false].map((lightIsKnown) => sampleBound(NOISY, lightIsKnown));
    assert.ok(known > 0 && known < unknown && unknown < 1, `${known} ${unknown}`);
    assert.ok(Math.abs(sampleBound({ ...NOISY, noise: 0.02 }, true) / known - 2) < 1e-9);
  });

  test("is null without noise and on the bare grid", () => {
    assert.equal(sampleBound(BUST, true), null);
    assert.equal(sampleBound({ ...BUST, protocol: "grid" }, true), null);
  });

  test("checks what it is given", () => {
    refused(() => sampleBound(NOISY), "type", "lightIsKnown");
    refused(() => sampleBound({ ...NOISY, noise: -1 }, true), "range", "sample.noise");
    refused(() => sampleBound({ ...NOISY, sise: 2 }, true), "option", "sample.sise");
  });
});

describe("lights", () => {
  const NORMALS = Float32Array.of(0, 0, -1, 0.6, 0, -0.8, 0.36, -0.48, -0.8);

  test("shade normals as the numbers of a sample say", () => {
    for (const name of sampleLights()) {
      const coefficients = turnLight(name);
      const { light } = sample({ surface: "bust", light: name });
      light.forEach((own, at) => assert.ok(Math.abs(coefficients[at] - own) < 1e-12, `${name} ${at}`));
      const [shaded, again] = [name, light].map((light) => shadeNormals(light, NORMALS));
      assert.deepEqual(shaded, again);
      // Towards the camera: the constant, the z term, and the second z term.
      const [l1, , l3, , , , l7] = coefficients;
      assert.ok(Math.abs(shaded[0] - (0.886227 * l1 - 2 * 0.511664 * l3 + (0.743125 - 0.247708) * l7)) < 1e-6);
    }
  });

  test("turned by an angle fall where they fell before", () => {
    const turned = turnLight("window", { beta: 90 });
    // A quarter turn about y takes x to -z, and z to x.
    const there = shadeNormals(turned, Float32Array.of(-1, 0, 0, -0.8, 0, -0.6));
    const before = shadeNormals("window", NORMALS);
    for (const at of [0, 1, 2, 3, 4, 5]) assert.ok(Math.abs(there[at] - before[at]) < 1e-5, `${at}`);
  });

  test("that are none are refused", () => {
    refused(() => turnLight("moon"), "range", "light");
    refused(() => turnLight([1, 2, 3]), "size", "light");
    refused(() => turnLight("window", { delta: 3 }), "option", "angles.delta");
    refused(() => shadeNormals("window", [0, 0, -1]), "type", "normals");
    refused(() => shadeNormals("window", new Float32Array(4)), "size", "normals");
  });
});
