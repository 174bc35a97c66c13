// The direction of a pose by the names that people and programs give it, and chains of poses through several frames.
import assert from "node:assert/strict";
import { describe, test } from "node:test";
import { readRigFolder } from "../../pkg/rig.js";
import { close, codes, matrix, only, quaternion, read, rotation, samePose, text, translation } from "./rig-support.mjs";

const named = async (name) => only((await read("rig.json", JSON.stringify({ [name]: matrix }))).poses);
const ends = ({ from, to }) => [from, to];
const opencv = (values, ...size) => ({ rows: size[0], cols: size[1], dt: "d", data: values });

/** The motion of `a` after that of `b`, 4x4 by rows. */
const product = (a, b) =>
  Array.from({ length: 4 }, (_, i) =>
    Array.from({ length: 4 }, (_, j) => [0, 1, 2, 3].reduce((sum, at) => sum + a[i][at] * b[at][j], 0)),
  );
/** A quarter turn with a shift, as the pose of a camera in a body. */
const placed = [
  [0, 1, 0, 0.01],
  [-1, 0, 0, 0.02],
  [0, 0, 1, 0.03],
  [0, 0, 0, 1],
];
const inverse = (m) => {
  const turned = [0, 1, 2].map((i) => [0, 1, 2].map((j) => m[j][i]));
  const back = turned.map((row) => -row.reduce((sum, value, at) => sum + value * m[at][3], 0));
  return [...turned.map((row, i) => [...row, back[i]]), [0, 0, 0, 1]];
};

describe("names of poses", () => {
  const around = ["", "_initial", "_optimized", "_refined", "_final", "_estimated", "_guess", "_prior", "_result"];
  const forms = {
    camera_to_lidar: ["camera", "lidar"],
    lidar2cam: ["lidar", "cam"],
    T_lidar_camera: ["camera", "lidar"],
    lidar_T_cam: ["cam", "lidar"],
    color_from_depth: ["depth", "color"],
    color_in_depth: ["color", "depth"],
    camera_pose_in_lidar: ["camera", "lidar"],
    depth_wrt_color: ["depth", "color"],
  };
  for (const [form, expected] of Object.entries(forms))
    test(`${form}, whatever stands beside it`, async () => {
      for (const words of around)
        for (const name of [`${form}${words}`, `${words.slice(1)}${words && "_"}${form}`]) {
          const pose = await named(name);
          assert.deepEqual(ends(pose), expected, name);
          samePose(pose);
        }
    });

  test("two frames without a direction that is known are a doubt, and one frame is none", async () => {
    for (const [name, said] of Object.entries({ camera_lidar_extrinsics: ["pose-assumed"], extrinsics: [] }))
      assert.deepEqual(codes(await read("rig.json", JSON.stringify({ [name]: matrix }))), said, name);
  });

  test("single letters: ORB-SLAM's Tlr is the right camera in the left one, T_c_d no lens", async () => {
    assert.deepEqual(ends(await named("Tlr")), ["right", "left"]);
    assert.deepEqual(ends(await named("Tcl")), ["lidar", "camera"]);
    const reading = await read("rig.json", JSON.stringify({ T_c_d: matrix }));
    assert.deepEqual([ends(only(reading.poses)), codes(reading)], [["depth", "camera"], []]);
  });

  test("of two estimates the first one comes last, and both keep the names of their objects", async () => {
    const value = { factory: { depth_to_color: placed }, refined: { depth_to_color: matrix } };
    const reading = await read("rig.json", JSON.stringify(value));
    assert.deepEqual(
      reading.poses.map(({ name }) => name),
      ["refined depth_to_color", "factory depth_to_color"],
    );
    samePose(reading.poses[0]);
    assert.deepEqual(codes(reading), ["pose-assumed"]);
  });
});

describe("poses in the inertial unit", () => {
  test("FAST-LIVO2's, VINS-Mono's and R3LIVE's are called so", async () => {
    const flatten = (value) => JSON.stringify(value);
    const livo = `extrin_calib:\n  extrinsic_T: ${flatten(translation)}\n  extrinsic_R: ${flatten(rotation)}\n`;
    assert.deepEqual(ends(only((await read("avia.yaml", livo)).poses)), ["lidar", "imu"]);
    const vins = { extrinsicRotation: opencv(rotation, 3, 3), extrinsicTranslation: opencv(translation, 3, 1) };
    assert.deepEqual(ends(only((await read("vins.json", flatten(vins))).poses)), ["camera", "imu"]);
    const r3live = `r3live_vio:\n  camera_ext_R: ${flatten(rotation)}\n  camera_ext_t: ${flatten(translation)}\n`;
    assert.deepEqual(ends(only((await read("r3live.yaml", r3live)).poses)), ["camera", "imu"]);
  });

  test("two cameras in one body are chained: VINS-Fusion's body_T_cam0 and body_T_cam1", async () => {
    // The fixtures' motion leads from cam0 to cam1, so body_T_cam1 is body_T_cam0 times the inverse of that motion.
    const second = product(placed, inverse(matrix));
    const value = { body_T_cam0: opencv(placed.flat(), 4, 4), body_T_cam1: opencv(second.flat(), 4, 4) };
    const [first, ...others] = (await read("vins.json", JSON.stringify(value))).poses;
    assert.deepEqual([ends(first), others.length], [["cam0", "cam1"], 2]);
    samePose(first);
  });
});

describe("mrcal", () => {
  // A small turn's rotation vector is twice the vector part of its quaternion, scaled by the angle.
  const half = Math.acos(quaternion[3]);
  const turn = quaternion.slice(0, 3).map((value) => (2 * half * value) / Math.sin(half));
  const model = (key, motion) =>
    `{\n 'lensmodel': 'LENSMODEL_PINHOLE',\n 'intrinsics': [500, 501, 320, 240,],\n '${key}': [${motion}],\n 'imagersize': [640, 480,],\n}\n`;
  for (const key of ["rt_cam_ref", "extrinsics"])
    test(`the pose in the reference by the key ${key}`, async () => {
      const pose = only((await read("camera.cameramodel", model(key, [...turn, ...translation]))).poses);
      assert.deepEqual(ends(pose), ["reference", "camera"]);
      samePose(pose);
    });
});

describe("Kalibr's results", () => {
  // Published numbers of one calibration: the text, and the matrix that the same run wrote into camchain.yaml.
  const results = (q, t) =>
    [
      ...["Calibration results ", "====================", "Camera-system parameters:", "\tcam0 (/depth/image):"],
      "\t type: <class 'aslam_cv.libaslam_cv_python.DistortedPinholeCameraGeometry'>",
      "\t distortion: [ 0.07536437 -0.18468836\n  0.00092726  0.00033364] +- [0.00560802 0.01507799 0.00053571 0.00044853]",
      "\t projection: [1151.13341587 1150.30902036  648.80503297  365.50538407] +- [0.80018663 0.76459404 0.1 0.2]",
      "\t reprojection error: [0.000121, -0.000036] +- [0.380177, 0.318709]",
      ...["", "\tcam1 (/color/image):"],
      "\t type: <class 'aslam_cv.libaslam_cv_python.EquidistantDistortedPinholeCameraGeometry'>",
      "\t distortion: [ 0.06143751 -0.13747218  0.00153052 -0.00356831] +- [0.1 0.1 0.1 0.1]",
      "\t projection: [1155.11798085 1154.48430634  645.37252872  365.78508202] +- [0.8 0.7 0.1 0.8]",
      ...["", "\tbaseline T_1_0:", `\t q: [${q.join(" ")}] +- [0.0015 0.00034 0.00017]`],
      ...[`\t t: [${t.join(" ")}] +- [0.0001 0.00006 0.0003]`, "", "Target configuration", "===================="],
    ].join("\n");
  const published = results([-0.00087935, -0.00270995, -0.0008824, 0.99999555], [-0.02997144, -0.00027389, 0.00036353]);

  test("the rotation is the transpose of Hamilton's, as in the chain's matrix", async () => {
    const pose = only((await read("results-cam.txt", published)).poses);
    assert.deepEqual(ends(pose), ["cam0", "cam1"]);
    close(pose.pose.rotation.slice(0, 3), [0.9999837550791693, -0.0017600256386679, 0.0054214285495925], 1e-6);
    close(pose.pose.rotation.slice(3, 6), [0.0017695575766285, 0.9999968962420779, -0.0017539019917587], 1e-6);
    close(pose.pose.translation, [-0.02997144, -0.00027389, 0.00036353], 0);
  });

  test("its cameras are read by their type, and taken by their topics", async () => {
    const { cameras, warnings } = await read("results-cam.txt", published);
    assert.deepEqual(
      cameras.map(({ name, takes, camera }) => [name, takes, camera.model, camera.fx]),
      [
        ["cam0", "depth", undefined, 1151.13341587],
        ["cam1", "colour", "fisheye", 1155.11798085],
      ],
    );
    close(cameras[0].camera.distortion, [0.07536437, -0.18468836, 0.00092726, 0.00033364], 0);
    assert.deepEqual(warnings, []);
    const omni = await read("results-cam.txt", published.replace("EquidistantDistortedPinhole", "DistortedOmni"));
    assert.deepEqual([omni.cameras.length, codes(omni)], [1, ["camera-left-out"]]);
  });
});

test("a folder's two models of mrcal are chained through their reference", async () => {
  const model = (name, motion) => ({
    name,
    bytes: text(
      `{'lensmodel': 'LENSMODEL_PINHOLE', 'intrinsics': [500, 501, 7.5, 5.5,], 'rt_cam_ref': [0, 0, 0, ${motion}], 'imagersize': [16, 12,],}`,
    ),
  });
  const picture = (name, value) => ({ name, bytes: text(`P2\n16 12\n65535\n${Array(192).fill(value).join(" ")}\n`) });
  const { poses } = await readRigFolder([
    picture("color/1.pgm", 9000),
    picture("depth/1.pgm", 1500),
    model("camera-depth.cameramodel", [0.3, -0.2, 0.5]),
    model("camera-color.cameramodel", [0.25, -0.2, 0.5]),
  ]);
  assert.deepEqual(ends(poses[0]), ["camera-depth.cameramodel", "camera-color.cameramodel"]);
  close(poses[0].pose.translation, [-0.05, 0, 0], 1e-9);
});
