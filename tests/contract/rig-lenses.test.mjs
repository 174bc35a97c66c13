// Lens models by their many names: Kannala-Brandt's coefficients are not Brown's, and models that are not supported are refused by name.
import assert from "node:assert/strict";
import { describe, test } from "node:test";
import { K, close, codes, only, read, refusedFile, sameCamera } from "./rig-support.mjs";

const { fx, fy, cx, cy } = K;
const pinhole = { fx, fy, cx, cy, width: 640, height: 480 };
const k = [0.0034, 0.0007, -0.002, 0.0002];
const ks = { k1: k[0], k2: k[1], k3: k[2], k4: k[3] };
const opencv = (values, ...size) => ({ rows: size[0], cols: size[1], dt: "d", data: values });
const ofCamera = (more) => read("camera.json", JSON.stringify({ ...pinhole, ...more }));

describe("Kannala-Brandt's model", () => {
  for (const name of [
    "KannalaBrandt8",
    "KANNALA_BRANDT4",
    "kb4",
    "equidistant",
    "EquidistantCamera",
    "OPENCV_FISHEYE",
    "fisheye",
  ])
    test(`is meant by "${name}"`, async () => {
      for (const key of ["model", "type", "camera_model", "distortion_model"]) {
        const { camera } = only((await ofCamera({ [key]: name, ...ks })).cameras);
        assert.equal(camera.model, "fisheye", key);
        close(camera.distortion, k, 0);
      }
    });

  test("is named once for all cameras of ORB-SLAM3's settings", async () => {
    const lines = (name) => Object.entries({ fx, fy, cx, cy, ...ks }).map(([key, value]) => `${name}.${key}: ${value}`);
    const yaml = ["%YAML:1.0", 'Camera.type: "KannalaBrandt8"', ...lines("Camera1"), ...lines("Camera2")].join("\n");
    const { cameras } = await read("orb.yaml", yaml);
    assert.equal(cameras.length, 2);
    for (const { camera } of cameras) {
      assert.equal(camera.model, "fisheye");
      close(camera.distortion, k, 0);
    }
    const brown = await read("orb.yaml", yaml.replace("KannalaBrandt8", "PinHole"));
    assert.equal(brown.cameras[0].camera.model, undefined);
  });

  test("may be meant by k1 to k4 without p1 and p2 and without a name, which is a doubt", async () => {
    const open = await ofCamera(ks);
    assert.deepEqual(codes(open), ["distortion-guessed"]);
    assert.ok(open.warnings[0].isDoubt);
    assert.match(open.warnings[0].message, /fisheye/);
    assert.deepEqual(codes(await ofCamera({ ...ks, p1: 0, p2: 0 })), []);
    assert.deepEqual(codes(await ofCamera({ ...ks, distortion_model: "plumb_bob" })), []);
  });
});

describe("Models that are not supported", () => {
  const models = {
    double_sphere: { xi: -0.27, alpha: 0.57 },
    ds: { xi: -0.27, alpha: 0.57 },
    eucm: { alpha: 0.6, beta: 1.1 },
    omni: { xi: 1.2, distortion: [0.1, -0.2, 0.001, 0.0004] },
    stereographic: {},
  };
  for (const [model, more] of Object.entries(models))
    test(`${model} is refused by its name, and by its parameters alone`, async () => {
      await refusedFile(ofCamera({ model, ...more }), "camera.json", new RegExp(model));
      if (Object.keys(more).length > 0)
        await refusedFile(ofCamera(more), "camera.json", /lens model "(?:xi|xi alpha|alpha beta)".* is not supported/);
    });

  test("OpenCV's omnidirectional calibration is refused by its xi", async () => {
    const value = {
      camera_matrix: opencv([fx, 0, cx, 0, fy, cy, 0, 0, 1], 3, 3),
      distortion_coefficients: opencv([0.1, -0.2, 0.001, 0.0004], 1, 4),
      xi: opencv([1.2], 1, 1),
    };
    await refusedFile(read("omni.json", JSON.stringify(value)), "omni.json", /omnidirectional/);
    sameCamera(
      only((await read("omni.json", JSON.stringify({ ...value, xi: opencv([0], 1, 1) }))).cameras),
      [0.1, -0.2, 0.001, 0.0004],
    );
  });

  test("leave out their camera with a doubt and keep the others of the file", async () => {
    const file = JSON.stringify({ depth: pinhole, color: { ...pinhole, model: "double_sphere", xi: 0.1, alpha: 0.5 } });
    const reading = await read("rig.json", file);
    assert.deepEqual(
      reading.cameras.map(({ name }) => name),
      ["depth"],
    );
    assert.deepEqual(codes(reading), ["camera-left-out"]);
    assert.ok(reading.warnings[0].isDoubt && /double_sphere/.test(reading.warnings[0].message));
  });

  test("an unknown name of a lens is a doubt, and the name of a product is not", async () => {
    assert.deepEqual(codes(await ofCamera({ distortion_model: "my_own" })), ["distortion-guessed"]);
    assert.deepEqual(codes(await ofCamera({ model: "RealSense D455" })), []);
    await refusedFile(ofCamera({ distortion_model: "my_own", dist: [0.1, 0, 0, 0] }), "camera.json", /my_own/);
  });
});

test("RealSense's models as Python prints them", async () => {
  const lens = { model: "distortion.inverse_brown_conrady", coeffs: [0.1, -0.2, 0.001, 0.0004, 0.05] };
  const reading = await read("camera.json", JSON.stringify({ fx, fy, ppx: cx, ppy: cy, ...lens }));
  close(only(reading.cameras).camera.distortion, lens.coeffs, 0);
  assert.deepEqual(codes(reading), ["lens-approximated"]);
});
