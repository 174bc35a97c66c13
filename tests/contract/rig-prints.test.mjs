// What programs print, and numbers without names: intrinsics above a line of distortion, prints of MATLAB, Orbbec's SDK, Swift and ROS.
import assert from "node:assert/strict";
import { test } from "node:test";
import { close, read, refusedFile, rotation } from "./rig-support.mjs";

const [FX, FY, CX, CY] = [611.43, 609.97, 324.81, 236.44];
const K = [
  [FX, 0, CX],
  [0, FY, CY],
  [0, 0, 1],
];
const SHIFT = [0.061, -0.134, 0.287];
const lines = (rows, separator = " ") => rows.map((row) => row.join(separator)).join("\n");
const motion = [0, 1, 2].map((at) => [...rotation.slice(3 * at, 3 * at + 3), SHIFT[at]]);
const rounds = ({ fx, fy, cx, cy }, tolerance = 1e-9) => close([fx, fy, cx, cy], [FX, FY, CX, CY], tolerance);
const moves = ({ pose }, tolerance = 1e-6) => {
  close(pose.rotation, rotation, tolerance);
  close(pose.translation, SHIFT, tolerance);
};
const codes = ({ warnings }) => warnings.map(({ code }) => code);

test("a matrix of intrinsics above a line of 4, 5, 8, 12 or 14 numbers of distortion, and a motion below", async () => {
  const all = [0.11, -0.27, 0.0008, -0.0004, 0.09, 0.012, -0.02, 0.003];
  for (const count of [4, 5, 8, 12, 14])
    for (const gap of ["\n", "\n\n"])
      for (const separator of [" ", ", ", "\t"])
        for (const below of [undefined, motion, [...motion, [0, 0, 0, 1]]]) {
          const lens = Array.from({ length: count }, (_, at) => all[at] ?? 0);
          const parts = [lines(K, separator), lens.join(separator), ...(below ? [lines(below, separator)] : [])];
          const found = await read("calib.txt", parts.join(gap));
          rounds(found.cameras[0].camera);
          const kept = count < 8 ? count : 8;
          close(found.cameras[0].camera.distortion, all.slice(0, kept), 1e-12);
          assert.equal(found.poses.length, below ? 1 : 0);
          if (below) moves(found.poses[0]);
          assert.equal(codes(found).includes("distortion-guessed"), count === 4);
        }
  for (const count of [3, 6, 7, 13])
    await refusedFile(
      read("odd.txt", `${lines(K)}\n${Array(count).fill(0.01).join(" ")}`),
      "odd.txt",
      /numbers in 4 rows|projection/,
    );
});

test("eight numbers in a line are a camera with a doubt, a pose, or refused where they may be either", async () => {
  const found = await read("a.txt", `${FX} ${FY} ${CX} ${CY} 0.1182 -0.2731 0.00083 -0.00041`);
  rounds(found.cameras[0].camera);
  assert.ok(codes(found).includes("distortion-guessed"));
  const placed = await read("pose.txt", "1700000000.1 20.5 30.5 40.5 0 0 0.6 0.8");
  assert.equal(placed.kind, "poses");
  await refusedFile(read("either.txt", `${FX} ${FY} ${CX} ${CY} 0.6 -0.8 0 0`), "either.txt", /may be fx fy cx cy/);
});

test("Swift's print of a simd matrix has columns", async () => {
  for (const type of ["float", "double"]) {
    const found = await read("k.txt", `simd_${type}3x3([[${FX}, 0.0, 0.0], [0.0, ${FY}, 0.0], [${CX}, ${CY}, 1.0]])`);
    rounds(found.cameras[0].camera);
  }
  const pose = `simd_float4x4([${Array(4).fill("[1.0, 0.0, 0.0, 0.0]").join(", ")}])`;
  await refusedFile(read("pose.txt", pose), "pose.txt", /rows of 4x4/);
});

test("a print of ROS 2's TransformStamped leads from the child's frame to the header's", async () => {
  const stamped = (sign) =>
    `geometry_msgs.msg.TransformStamped(header=std_msgs.msg.Header(stamp=builtin_interfaces.msg.Time(sec=5, nanosec=0), frame_id='camera'), child_frame_id='lidar', transform=geometry_msgs.msg.Transform(translation=geometry_msgs.msg.Vector3(x=1.5, y=-2e-1, z=0.3), rotation=geometry_msgs.msg.Quaternion(x=0.0, y=0.0, z=${0.6 * sign}, w=0.8)))`;
  for (const sign of [1, -1]) {
    const { poses } = await read("lookup.txt", stamped(sign));
    assert.deepEqual([poses[0].from, poses[0].to], ["lidar", "camera"]);
    close(poses[0].pose.translation, [1.5, -0.2, 0.3], 1e-12);
    close(poses[0].pose.rotation, [0.28, -0.96 * sign, 0, 0.96 * sign, 0.28, 0, 0, 0, 1], 1e-9);
  }
});

test("a table of ROS's camera_info; messages that disagree are refused", async () => {
  const lens = [0.1, -0.2, 0.001, -0.002, 0.05];
  const columns = (values, name) => values.map((value, at) => [`field.${name}${at}`, value]);
  const row = (time) => [
    ["%time", time],
    ["field.header.frame_id", "camera_color"],
    ["field.width", 640],
    ["field.height", 480],
    ["field.distortion_model", "plumb_bob"],
    ...columns(lens, "D"),
    ...columns(K.flat(), "K"),
  ];
  const table = (...rows) =>
    lines([rows[0].map(([name]) => name), ...rows.map((each) => each.map(([, value]) => value))], ",");
  const found = await read("camera_info.csv", table(row(1), row(2)));
  assert.equal(found.cameras[0].width, 640);
  rounds(found.cameras[0].camera);
  close(found.cameras[0].camera.distortion, lens, 1e-12);
  const other = row(2).map(([name, value]) => [name, name === "field.K2" ? value + 5 : value]);
  await refusedFile(read("camera_info.csv", table(row(1), other)), "camera_info.csv", /different intrinsics/);
});

test("pyorbbecsdk's prints, in millimetres from the depth camera to the colour camera", async () => {
  const size = "width=640 height=480";
  const turn = `rot=[${rotation.join(", ")}]`;
  const shift = `[${SHIFT.map((value) => 1000 * value).join(", ")}]`;
  const prints = [
    `depth_intrinsic: <OBCameraIntrinsic fx=421.5 fy=422.5 cx=318 cy=241 ${size}>\nrgb_intrinsic: <OBCameraIntrinsic fx=${FX} fy=${FY} cx=${CX} cy=${CY} ${size}>\nrgb_distortion: <OBCameraDistortion k1=0.1 k2=-0.2 k3=0.3 k4=0 k5=0 k6=0 p1=0.01 p2=-0.02>\ntransform: <OBD2CTransform ${turn}\ntransform=${shift}\n`,
    `<OBCameraParam\n depth_intrinsic < fx=421.5 fy =422.5 cx=318 cy =241 ${size} >\n rgb_intrinsic < fx=${FX} fy =${FY} cx=${CX} cy =${CY} ${size} >\n  rgb_distortion < k1=0.1 k2=-0.2 k3=0.3 k4=0 k5=0 k6=0 p1=0.01 p2=-0.02 >\n  transform < ${turn}\n trans=${shift}\n>`,
  ];
  for (const print of prints) {
    const { cameras, poses } = await read("param.txt", print);
    assert.deepEqual(
      cameras.map(({ takes }) => takes),
      ["depth", "colour"],
    );
    rounds(cameras[1].camera);
    close(cameras[1].camera.distortion, [0.1, -0.2, 0.01, -0.02, 0.3], 1e-12);
    assert.deepEqual([poses[0].from, poses[0].to], ["depth", "color"]);
    moves(poses[0]);
  }
});

test("MATLAB's command window: common factors, either order of a matrix, pixels from 1", async () => {
  const shown = (rows) =>
    `   1.0e+03 *\n\n${rows.map((row) => row.map((value) => `    ${(value / 1000).toFixed(5)}`).join("")).join("\n")}\n`;
  // MATLAB's principal point is one larger.
  const ours = [
    [FX, 0, CX + 1],
    [0, FY, CY + 1],
    [0, 0, 1],
  ];
  const turned = ours.map((_, column) => ours.map((row) => row[column]));
  for (const [rows, one] of [
    [ours, 0.001],
    [turned, 0.001],
  ]) {
    assert.equal(one * 1000, rows[2][2]);
    const found = await read("window.txt", `K = \n\n${shown(rows)}`);
    rounds(found.cameras[0].camera, 0.006);
    assert.ok(found.warnings.some(({ code, isDoubt }) => code === "principal-point" && isDoubt));
  }
  const object = `intrinsics = \n\n  cameraIntrinsics with properties:\n\n             FocalLength: [${FX} ${FY}]\n          PrincipalPoint: [${CX + 1} ${CY + 1}]\n               ImageSize: [480 640]\n        RadialDistortion: [0.1100 -0.2700]\n    TangentialDistortion: [8.0000e-04 -4.0000e-04]\n                    Skew: 0\n                       K: [3x3 double]\n`;
  const { cameras } = await read("intrinsics.txt", object);
  assert.deepEqual([cameras[0].width, cameras[0].height], [640, 480]);
  rounds(cameras[0].camera);
  close(cameras[0].camera.distortion, [0.11, -0.27, 0.0008, -0.0004], 1e-12);
  await refusedFile(read("r.txt", `T = \n\n${shown([[1, 2, 3]])}`), "r.txt", /without intrinsics/);
});
