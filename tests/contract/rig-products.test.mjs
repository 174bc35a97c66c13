// Calibrations of products: units, modes, frames and orders that the product defines and its file does not state.
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
  numbers,
  quaternion,
  read,
  refusedFile,
  rotation,
  rows,
  samePose,
  size,
  translation,
} from "./rig-support.mjs";

const [x, y, z, w] = quaternion;

describe("OAK cameras (depthai)", () => {
  const camera = (extrinsics, more = {}) => ({
    ...{ cameraType: 0, distortionCoeff: [...distortion, 0, 0, 0, 0, 0, 0, 0, 0, 0], extrinsics },
    ...{ height: 480, width: 640, intrinsicMatrix: intrinsicRows, ...more },
  });
  const none = { rotationMatrix: [], toCameraSocket: -1, translation: { x: 0, y: 0, z: 0 } };
  const to = (socket) => ({
    rotationMatrix: rows,
    toCameraSocket: socket,
    translation: { x: 100 * translation[0], y: 100 * translation[1], z: 100 * translation[2] },
    specTranslation: { x: 7.5, y: 0, z: 0 },
  });

  test("sockets, centimetres, and the way to the colour camera by another one", async () => {
    const found = await json({
      boardName: "OAK-D",
      cameraData: [
        [0, camera(none)],
        [1, camera(to(2))],
        [2, camera(to(0))],
      ],
    });
    assert.deepEqual(
      found.cameras.map(({ name }) => name),
      ["rgb (CAM_A)", "left (CAM_B)", "right (CAM_C)"],
    );
    close(numbers(found.cameras[0]), [518.5, 519.25, 325.5, 253.75], 1e-9);
    assert.deepEqual(lens(found.cameras[0]), ["brown", ...distortion]);
    assert.deepEqual(size(found.cameras[0]), [640, 480]);
    assert.deepEqual(found.poses.map(ends), [
      ["right (CAM_C)", "rgb (CAM_A)"],
      ["left (CAM_B)", "rgb (CAM_A)"],
      ["left (CAM_B)", "right (CAM_C)"],
    ]);
    samePose(found.poses[0]);
    assert.ok(codes(found).includes("pose-assumed"));
  });

  test("a lens with thin-prism terms costs its camera, not the file", async () => {
    const thin = { distortionCoeff: [1, 2, 0, 0, 1, 2, 3, 4, 0.1, 0, 0, 0, 0, 0] };
    const found = await json({
      boardName: "OAK-D",
      cameraData: { 0: camera(none, thin), CAM_C: camera(to(0)) },
    });
    assert.deepEqual(
      found.cameras.map(({ name }) => name),
      ["right (CAM_C)"],
    );
    assert.ok(
      found.warnings.some(({ code, message }) => code === "camera-left-out" && /rgb.*thin-prism/.test(message)),
    );
  });
});

describe("the Azure Kinect", () => {
  const camera = (purpose, [cx, cy, f, g], pose) => ({
    Intrinsics: {
      ModelParameters: [cx, cy, f, g, 0.2, -0.5, 0.3, 0.1, 0.05, 0.02, 0, 0, -0.002, 0.001],
      ModelType: "CALIBRATION_LensDistortionModelBrownConrady",
    },
    Purpose: `CALIBRATION_CameraPurpose${purpose}`,
    Rt: { Rotation: pose ? rotation : [1, 0, 0, 0, 1, 0, 0, 0, 1], Translation: pose ? translation : [0, 0, 0] },
  });
  const file = {
    CalibrationInformation: {
      Cameras: [camera("Depth", [0.5, 0.51, 0.49, 0.48]), camera("PhotoVideo", [0.5, 0.51, 0.48, 0.64], true)],
      InertialSensors: [{ Rt: { Rotation: [0, -1, 0, 0, 0, -1, 1, 0, 0], Translation: [0, 0, 0] } }],
    },
  };

  test("shares of the sensor are pixels of each mode; the gyroscope is no camera", async () => {
    const { cameras, poses } = await json(file);
    const of = (width, height) => cameras.find((each) => each.width === width && each.height === height);
    close(numbers(of(640, 576)), [0.49 * 1024, 0.48 * 1024, 512 - 192 - 0.5, 0.51 * 1024 - 180 - 0.5], 1e-9);
    close(numbers(of(512, 512)), [0.49 * 512, 0.48 * 512, 255.5, 0.51 * 512 - 0.5], 1e-9);
    close(numbers(of(1280, 720)), [0.48 * 1280, 0.64 * 960, 639.5, 0.51 * 960 - 120 - 0.5], 1e-9);
    close(numbers(of(2048, 1536)), [0.48 * 2048, 0.64 * 1536, 1023.5, 0.51 * 1536 - 0.5], 1e-9);
    assert.deepEqual(lens(of(3840, 2160)), ["brown", 0.2, -0.5, 0.001, -0.002, 0.3, 0.1, 0.05, 0.02]);
    assert.equal(poses.length, 1);
    assert.deepEqual(ends(poses[0]), ["depth", "color"]);
    samePose(poses[0], rotation, translation, 1e-9);
  });

  test("what the SDK's example prints", async () => {
    const text =
      "===== Device 0: 000 =====\nresolution width: 640\nresolution height: 576\nprincipal point x: 325.5\nprincipal point y: 253.75\nfocal length x: 518.5\nfocal length y: 519.25\nradial distortion coefficients:\nk1: 0.2\nk2: -0.5\nk3: 0.3\nk4: 0.1\nk5: 0.05\nk6: 0.02\ncenter of distortion in Z=1 plane, x: 0\ncenter of distortion in Z=1 plane, y: 0\ntangential distortion coefficient x: 0.001\ntangential distortion coefficient y: -0.002\nmetric radius: 1.7\n";
    const both = (await read("k4a.txt", `Depth camera:\n${text}Color camera:\n${text.replace("325.5", "640.5")}`))
      .cameras;
    assert.deepEqual(
      both.map(({ name, camera: { cx } }) => [name, cx]),
      [
        ["depth", 325.5],
        ["color", 640.5],
      ],
    );
    const [camera] = (await read("k4a.txt", text)).cameras;
    close(numbers(camera), [518.5, 519.25, 325.5, 253.75], 1e-9);
    assert.deepEqual(
      [...size(camera), ...lens(camera)],
      [640, 576, "brown", 0.2, -0.5, 0.001, -0.002, 0.3, 0.1, 0.05, 0.02],
    );
  });
});

describe("RealSense", () => {
  const stream = (name, w, h, f, coeffs = "0  \t0  \t0  \t0  \t0") =>
    ` Intrinsic of "${name}" / ${w}x${h} / {Z16}\n  Width:      \t${w}\n  Height:     \t${h}\n  PPX:        \t${w / 2}\n  PPY:        \t${h / 2}\n  Fx:         \t${f}\n  Fy:         \t${f}\n  Distortion: \tBrown Conrady\n  Coeffs:     \t${coeffs}  \n\n`;
  const way = (from, to, r, t) =>
    `Extrinsic from "${from}"\t  To\t  "${to}" :\n Rotation Matrix:\n${[0, 1, 2].map((i) => `   ${r.slice(3 * i, 3 * i + 3).join("        ")}  `).join("\n")}\n\n Translation Vector: ${t.join("  ")}  \n\n`;

  test("a list of all sizes: self, N/A and zeros are left out, depth to colour comes first", async () => {
    const none = `${way("Depth", "Gyro", Array(9).fill("N/A"), Array(3).fill("N/A"))}${way("Infrared 2", "Color", Array(9).fill(0), [0.05, 0, 0])}`;
    const found = await read(
      "rs.txt",
      `${stream("Depth", 1280, 720, 640)}${stream("Depth", 640, 480, 320)}${stream("Infrared 1", 0, 0, 0)} Intrinsic of "Infrared 2" / 1280x800 / {Y16}\n  Intrinsic NOT available!\n\n${stream("Color", 640, 480, 600)}${way("Depth", "Depth", [1, 0, 0, 0, 1, 0, 0, 0, 1], [0, 0, 0])}${none}${way("Color", "Depth", columns, [0, 0, 0])}${way("Depth", "Color", rotation, translation)}`,
    );
    assert.deepEqual(found.cameras.map(size), [
      [1280, 720],
      [640, 480],
      [640, 480],
    ]);
    assert.deepEqual(found.poses.map(ends), [
      ["Depth", "Color"],
      ["Color", "Depth"],
    ]);
    samePose(found.poses[0]);
    assert.deepEqual(codes(found), ["pose-left-out"]);
    assert.match(found.warnings[0].message, /Infrared 1" and 3 more/);
  });

  test("of two devices the first, with a word", async () => {
    const device = (f) =>
      `Device info: \n    Name : D435\n\n${stream("Color", 640, 480, f)}${stream("Depth", 640, 480, f - 100)}`;
    const found = await read("rs.txt", device(600) + device(700));
    assert.deepEqual(
      found.cameras.map(({ camera }) => camera.fx),
      [600, 500],
    );
    assert.deepEqual(codes(found), ["pose-assumed"]);
  });

  test("what pyrealsense2 prints, of both kinds, with the names before it", async () => {
    const text = `Depth intrinsics: [ 848x480  p[424.1 238.2]  f[421.3 421.4]  Brown Conrady [0 0 0 0 0] ]\nColor:\n  width: 640, height: 480, ppx: 325.5, ppy: 253.75, fx: 518.5, fy: 519.25, model: distortion.inverse_brown_conrady, coeffs: [${distortion.join(", ")}]\nDepth to Color: rotation: [${columns.join(", ")}]\ntranslation: [${translation.join(", ")}]\n`;
    const { cameras, poses } = await read("print.txt", text);
    assert.deepEqual(
      cameras.map((each) => [each.name, ...size(each), ...numbers(each)]),
      [
        ["Depth", 848, 480, 421.3, 421.4, 424.1, 238.2],
        ["Color", 640, 480, 518.5, 519.25, 325.5, 253.75],
      ],
    );
    assert.deepEqual(lens(cameras[1]), ["brown", ...distortion]);
    samePose(poses[0]);
    assert.deepEqual(ends(poses[0]), ["Depth", "Color"]);
  });

  test("twelve numbers in a list: a 3x4 matrix, or a rotation and a shift whose order is said", async () => {
    const byRows = await json({ depth2color: rows.flatMap((row, i) => [...row, translation[i]]) });
    samePose(byRows.poses[0]);
    assert.deepEqual(codes(byRows), []);
    const apart = await json({ depth2color: [...columns, ...translation] });
    samePose(apart.poses[0]);
    assert.deepEqual(codes(apart), ["rotation-order"]);
  });

  test("the .csv beside a snapshot of its viewer", async () => {
    const text =
      "Frame Info\nType,Color\nFormat,RGB8\nResolution x,640\nResolution y,480\n\nIntrinsic:,\nFx,518.5\nFy,519.25\nPPx,325.5\nPPy,253.75\nDistorsion,Inverse Brown Conrady\n";
    const found = await read("snap_Color_metadata.csv", text);
    assert.deepEqual(
      found.cameras.map((each) => [each.name, ...size(each), ...numbers(each)]),
      [["Color", 640, 480, 518.5, 519.25, 325.5, 253.75]],
    );
    assert.deepEqual(codes(found), ["lens-approximated"]);
  });
});

describe("ZED, Zivid, Kinect v2, Aria", () => {
  test("a ZED's file: both cameras at every size, the lens beside them or in a section of its own", async () => {
    const section = (name, f) => `[${name}]\nfx=${f}\nfy=${f}\ncx=640\ncy=360\n`;
    const lenses = "k1=0.2\nk2=-0.5\np1=0.001\np2=-0.002\nk3=0.3\n";
    const old = await read(
      "SN1.conf",
      `${section("LEFT_CAM_HD", 700)}${lenses}\n${section("RIGHT_CAM_HD", 701)}${lenses}\n${section("LEFT_CAM_2K", 1400)}${lenses}[STEREO]\nBaseline=120\n`,
    );
    assert.deepEqual(
      old.cameras.map((each) => [each.name, ...size(each), each.camera.fx, each.takes]),
      [
        ["left HD", 1280, 720, 700, "both"],
        ["left 2K", 2208, 1242, 1400, "both"],
        ["right HD", 1280, 720, 701, undefined],
      ],
    );
    assert.deepEqual(lens(old.cameras[0]), ["brown", ...distortion]);
    const newer = await read(
      "SN2.conf",
      `${section("LEFT_CAM_FHD1200", 950)}\n[LEFT_DISTO]\n${lenses}k4=0.1\nk5=0\nk6=0\n`,
    );
    assert.deepEqual(lens(newer.cameras[0]), ["brown", ...distortion, 0.1, 0, 0]);
  });

  test("a Zivid's lens stands beside its matrix", async () => {
    const text =
      "__version__: 1\nCameraIntrinsics:\n  CameraMatrix:\n    CX: 325.5\n    CY: 253.75\n    FX: 518.5\n    FY: 519.25\n  Distortion:\n    K1: 0.2\n    K2: -0.5\n    K3: 0.3\n    P1: 0.001\n    P2: -0.002\n";
    const [camera] = (await read("intrinsics.yml", text)).cameras;
    assert.deepEqual([...numbers(camera), ...lens(camera)], [518.5, 519.25, 325.5, 253.75, "brown", ...distortion]);
    const lower = await json({
      camera_matrix: { cx: 1, cy: 2, fx: 500, fy: 501 },
      distortion: { k1: 0.1, k2: 0.2, k3: 0.3, p1: 0.4, p2: 0.5 },
    });
    assert.deepEqual(lens(lower.cameras[0]), ["brown", 0.1, 0.2, 0.4, 0.5, 0.3]);
    const transform = `FloatMatrix:\n  Data: [${rows.map((row, i) => `[${row.join(", ")}, ${1000 * translation[i]}]`).join(", ")}, [0, 0, 0, 1]]\n`;
    const found = await read("transform.yaml", transform);
    samePose(found.poses[0]);
    assert.deepEqual(codes(found), ["pose-assumed"]);
  });

  test("a Kinect v2 by its SDK's names; iai_kinect2's shift of depths is named", async () => {
    const [camera] = (
      await json({
        ...{ FocalLengthX: 365, FocalLengthY: 366, PrincipalPointX: 258, PrincipalPointY: 205 },
        ...{ RadialDistortionSecondOrder: 0.09, RadialDistortionFourthOrder: -0.27, RadialDistortionSixthOrder: 0.08 },
      })
    ).cameras;
    assert.deepEqual([...numbers(camera), ...lens(camera)], [365, 366, 258, 205, "brown", 0.09, -0.27, 0, 0, 0.08]);
    await refusedFile(
      read("calib_depth.yaml", "%YAML:1.0\ndepthShift: -27.5\n"),
      "calib_depth.yaml",
      /depthShift of -27.5 mm/,
    );
  });

  test("Aria's quaternions have w apart, and its own lens costs the camera", async () => {
    const camera = (Label, Name, Params) => ({
      ...{ Label, Projection: { Name, Params } },
      T_Device_Camera: { Translation: translation, UnitQuaternion: [w, [x, y, z]] },
    });
    const found = await json({
      CameraCalibrations: [
        camera("camera-rgb", "FisheyeRadTanThinPrism", [1220, 1450, 1440, 1, 2, 3, 4, 5, 6, 7, 8, 9, 1, 1, 1]),
        camera("camera-slam-left", "KannalaBrandtK3", [240, 241, 320, 239, 0.1, 0.2, 0.3, 0.4]),
      ],
    });
    assert.equal(found.cameras.length, 1);
    assert.deepEqual(lens(found.cameras[0]), ["fisheye", 0.1, 0.2, 0.3, 0.4]);
    samePose(found.poses[0]);
    assert.deepEqual(ends(found.poses[0]), ["camera-rgb", "device"]);
    assert.ok(
      found.warnings.some(({ code, message }) => code === "camera-left-out" && /projectaria_tools/.test(message)),
    );
  });
});
