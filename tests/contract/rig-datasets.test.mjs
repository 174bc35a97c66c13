// Calibrations of data sets and toolboxes: camera poses in the world, units of depth, and pixels counted from 1.
import assert from "node:assert/strict";
import { describe, test } from "node:test";
import {
  close,
  codes,
  columns,
  distortion,
  ends,
  intrinsicRows,
  json,
  lens,
  matrix,
  numbers,
  read,
  refusedFile,
  rotation,
  samePose,
  translation,
} from "./rig-support.mjs";

describe("data sets and toolboxes", () => {
  test("nerfstudio: where the camera stood is no extrinsics, and has our axes", async () => {
    const found = await json({
      ...{
        fl_x: 500,
        fl_y: 501,
        cx: 320,
        cy: 240,
        w: 640,
        h: 480,
        k1: 0.1,
        k2: 0,
        p1: 0,
        p2: 0,
        camera_model: "OPENCV",
      },
      frames: [{ file_path: "images/1.png", transform_matrix: matrix }],
    });
    assert.deepEqual([...numbers(found.cameras[0]), found.cameras[0].width], [500, 501, 319.5, 239.5, 640]);
    assert.deepEqual(ends(found.poses[0]), ["camera", "world"]);
    samePose(
      found.poses[0],
      rotation.map((value, at) => (at % 3 === 0 ? value : -value)),
    );
    const varying = await json({
      frames: [500, 520].map((fl_x, i) => ({
        file_path: `${i}.png`,
        fl_x,
        cx: 320,
        cy: 240,
        w: 640,
        h: 480,
        transform_matrix: matrix,
      })),
    });
    assert.deepEqual(
      varying.cameras.map(({ name, camera }) => [name, camera.fx]),
      [
        ["0", 500],
        ["1", 520],
      ],
    );
    const blender = await json({ camera_angle_x: 0.7, frames: [{ file_path: "r_0", transform_matrix: matrix }] });
    assert.deepEqual([blender.kind, ...codes(blender)], ["poses", "camera-left-out", "camera-to-world"]);
  });

  test("Record3D: K by columns, the depth map's camera scaled; a focus that moved is said", async () => {
    const metadata = {
      K: [720, 0, 0, 0, 720, 0, 360, 480, 1],
      w: 720,
      h: 960,
      dw: 180,
      dh: 240,
      fps: 30,
      poses: [[0, 0, 0, 1, 0, 0, 0]],
    };
    const { cameras, poses } = await json(metadata, "metadata");
    assert.deepEqual(
      cameras.map((each) => [each.name, each.width, ...numbers(each)]),
      [
        ["rgb", 720, 720, 720, 360, 480],
        ["depth", 180, 180, 180, 360.5 / 4 - 0.5, 480.5 / 4 - 0.5],
      ],
    );
    assert.equal(poses.length, 0);
    const focused = await json({
      ...metadata,
      perFrameIntrinsicCoeffs: [
        [720, 720, 360, 480],
        [750, 750, 360, 480],
      ],
    });
    assert.ok(codes(focused).includes("intrinsics-vary"));
  });

  test("ScanNet: K of 4x4, and a scene's text with its unit", async () => {
    const k = await read("intrinsic_color.txt", "518.5 0 325.5 0\n0 519.25 253.75 0\n0 0 1 0\n0 0 0 1\n");
    assert.deepEqual([k.poses.length, ...numbers(k.cameras[0])], [0, 518.5, 519.25, 325.5, 253.75]);
    const four = (a, b, c, d) => [a, 0, c, 0, 0, b, d, 0, 0, 0, 1, 0, 0, 0, 0, 1].join(" ");
    const scene = await read(
      "scene0000_00.txt",
      `m_colorWidth = 1296\nm_colorHeight = 968\nm_depthWidth = 640\nm_depthHeight = 480\nm_depthShift = 2000\nm_calibrationColorIntrinsic = ${four(1160, 1161, 650, 480)}\nm_calibrationDepthIntrinsic = ${four(570, 571, 320, 240)}\nm_calibrationColorExtrinsic = ${four(1, 1, 0, 0)}\nm_calibrationDepthExtrinsic = ${four(1, 1, 0, 0)}\n`,
    );
    assert.deepEqual(
      scene.cameras.map((each) => [each.name, each.width, each.camera.fx]),
      [
        ["color", 1296, 1160],
        ["depth", 640, 570],
      ],
    );
    assert.equal(scene.depthUnit, 1 / 2000);
    assert.deepEqual(ends(scene.poses[0]), ["depth", "color"]);
    const released = await read(
      "scene0001_00.txt",
      `axisAlignment = 1 0 0 0 0 1 0 0 0 0 1 0 0 0 0 1\ncolorHeight = 968\ncolorWidth = 1296\ncolorToDepthExtrinsics = ${four(1, 1, 0, 0)}\nfx_color = 1160\nfy_color = 1161\nmx_color = 650\nmy_color = 480\nsceneType = Bathroom\n`,
    );
    assert.deepEqual([released.cameras.length, ...numbers(released.cameras[0])], [1, 1160, 1161, 650, 480]);
  });

  test("BOP: millimetres per unit; the same name with metres per unit, and units per metre", async () => {
    const camera = { fx: 500, fy: 501, cx: 320, cy: 240, width: 640, height: 480 };
    const unit = async (depth_scale) => (await json({ ...camera, depth_scale })).depthUnit;
    close([await unit(0.1), await unit(1), await unit(0.00025), await unit(5000)], [1e-4, 1e-3, 2.5e-4, 2e-4], 1e-12);
    const scene = {
      7: { cam_K: intrinsicRows.flat(), depth_scale: 0.5 },
      8: { cam_K: intrinsicRows.flat(), depth_scale: 0.5 },
    };
    const found = await json(scene, "scene_camera.json");
    assert.deepEqual([found.cameras.length, found.cameras[0].takes, found.depthUnit], [1, "both", 5e-4]);
  });

  test("MATLAB: rows by columns, row vectors, pixels from 1; Bouguet's toolbox with its board left out", async () => {
    const camera = {
      ...{
        RadialDistortion: [0.2, -0.5],
        TangentialDistortion: [0.001, -0.002],
        ImageSize: [480, 640],
        WorldUnits: "millimeters",
      },
      IntrinsicMatrix: [
        [518.5, 0, 0],
        [0, 519.25, 0],
        [326.5, 254.75, 1],
      ],
    };
    const found = await json({
      ...{ CameraParameters1: camera, CameraParameters2: camera },
      RotationOfCamera2: [0, 1, 2].map((i) => columns.slice(3 * i, 3 * i + 3)),
      TranslationOfCamera2: translation.map((value) => 1000 * value),
    });
    assert.deepEqual(
      [found.cameras[0].width, ...numbers(found.cameras[0]), ...lens(found.cameras[0])],
      [640, 518.5, 519.25, 325.5, 253.75, "brown", 0.2, -0.5, 0.001, -0.002],
    );
    samePose(found.poses[0]);
    assert.deepEqual(ends(found.poses[0]), ["1", "2"]);
    await refusedFile(
      json({ MappingCoefficients: [1, 2, 3, 4], DistortionCenter: [1, 2] }),
      "calib.json",
      /MATLAB.*Scaramuzza/,
    );
    const script =
      "% Intrinsic parameters\nfc = [ 518.5 ; 519.25 ];\ncc = [ 325.5 ; 253.75 ];\nalpha_c = 0.0;\nkc = [ 0.2 ; -0.5 ; 0.001 ; -0.002 ; 0.3 ];\nnx = 640;\nny = 480;\nomc_1 = [ 1 ; 2 ; 3 ];\nTc_1  = [ 1 ; 2 ; 900 ];\n";
    const bouguet = await read("Calib_Results.m", script);
    assert.deepEqual(
      [bouguet.cameras[0].width, ...numbers(bouguet.cameras[0]), ...lens(bouguet.cameras[0])],
      [640, 518.5, 519.25, 325.5, 253.75, "brown", ...distortion],
    );
    assert.deepEqual([bouguet.poses.length, ...codes(bouguet)], [0, "pose-left-out"]);
    const stereo = await read(
      "Calib_Results_stereo.m",
      `${script.replace(/\b(fc|cc|kc|alpha_c)\b/g, "$1_left")}${script.replace(/\b(fc|cc|kc|alpha_c)\b/g, "$1_right")}om = [ 0.02 ; -0.03 ; 0.05 ];\nT = [ ${translation.map((value) => 1000 * value).join(" ; ")} ];\n`,
    );
    samePose(stereo.poses[0]);
    assert.deepEqual(ends(stereo.poses[0]), ["left", "right"]);
  });
});
