// Calibrations and depth maps of products that are malformed on purpose: invalid numbers, cycles, excessive counts.
import { deflateRawSync } from "node:zlib";
import { bytes, cut, u32 } from "./malformed.mjs";
import { fixture, text } from "./rig-support.mjs";
import { npy } from "./support.mjs";

const json = (value) => text(JSON.stringify(value));
const again = (count, of) => Array.from({ length: count }, (_, at) => of(at));
const K = [500, 0, 320, 0, 500, 240, 0, 0, 1];

const stream = (lines) => text(`Intrinsic of "Color" / 640x480 / {RGB8}\n${lines}`);
const sized = "  Width: 640\n  Height: 480\n  PPX: 320\n  PPY: 240\n";
const depthai = (cameras) =>
  json({
    cameraData: cameras.map((more, socket) => [
      socket,
      {
        ...{ cameraType: 0, height: 480, width: 640, intrinsicMatrix: [K.slice(0, 3), K.slice(3, 6), K.slice(6)] },
        ...{ distortionCoeff: Array(14).fill(0), extrinsics: {}, ...more },
      },
    ]),
  });
const azure = (ModelParameters) =>
  json({
    CalibrationInformation: {
      Cameras: [{ Purpose: "CALIBRATION_CameraPurposeDepth", Intrinsics: { ModelParameters } }],
    },
  });
const waymo = (inner) => text(`camera_calibrations {\n name: FRONT\n${inner}}\n`);
const urdf = (inner) => text(`<robot name="r">${inner}</robot>`);
const joint = (from, to, origin = '<origin xyz="0 0 0" rpy="0 0 0"/>') =>
  `<joint name="${from}" type="fixed"><parent link="${to}"/><child link="${from}"/>${origin}</joint>`;
/** An expression of xacro. */
const xacro = (inner) => `\${${inner}}`;
const origin = (x) => `<origin xyz="${x} 0 0" rpy="0 0 0"/>`;
const handEye = (q) =>
  text(
    `parameters:\n  eye_on_hand: false\n  tracking_base_frame: camera\ntransformation: {x: 0, y: 0, z: 1, qx: ${q}, qy: ${q}, qz: ${q}, qw: ${q}}\n`,
  );

/** File name, bytes, and a pattern for the error, or the code of a warning if the rest of the file is usable. */
export const CALIBRATIONS = [
  [
    "rs-nan.txt",
    stream(`${sized}  Fx: nan\n  Fy: 500\n  Distortion: None\n  Coeffs: 0 0 0 0 0\n`),
    /streams, but holds no camera/,
  ],
  ["rs-cut.txt", stream(`${sized}  Fx: 500\n`), /streams, but holds no camera/],
  [
    "rs-inf.txt",
    stream(`  Width: 640\n  Height: 480\n  PPX: inf\n  PPY: 240\n  Fx: 500\n  Fy: 500\n`),
    /principal point NaN, 240/,
  ],
  [
    "rs-many.txt",
    text(`Intrinsic of "Color" / 640x480\n${'Intrinsic of "Depth" / 640x480\n'.repeat(3000)}`),
    /more than 2000 intrinsics/,
  ],
  [
    "rs-print.txt",
    text("[ 640x480  p[1e999 240]  f[500 500]  Brown Conrady [0 0 0 0 0] ]"),
    /principal point Infinity, 240/,
  ],
  [
    "depthai-zero.json",
    depthai([
      {
        intrinsicMatrix: [
          [0, 0, 0],
          [0, 0, 0],
          [0, 0, 0],
        ],
      },
    ]),
    /depthai, but holds no camera/,
  ],
  [
    "depthai-nan.json",
    text(new TextDecoder().decode(depthai([{}])).replace("500", "NaN")),
    /depthai, but holds no camera/,
  ],
  ["azure-short.json", azure([0.5, 0.5]), /focal lengths NaN and NaN/],
  ["azure-words.json", azure("all of them"), /focal lengths NaN and NaN/],
  ["kitti-zero.txt", text(`P2: ${Array(12).fill(0).join(" ")}\n`), /"image_2" has the focal lengths 0 and 0/],
  ["kitti-nan.txt", text(`P2: nan ${Array(11).fill(1).join(" ")}\n`), /neither a camera/],
  [
    "kitti-eleven.txt",
    text(`P0: ${Array(11).fill(1).join(" ")}\nP2: ${Array(11).fill(1).join(" ")}\n`),
    /neither a camera/,
  ],
  ["kitti-turn.txt", text(`Tr: ${Array(12).fill(2).join(" ")}\n`), /not a rotation/],
  [
    "kalibr-nan.yaml",
    text("cam0:\n  camera_model: pinhole\n  intrinsics: [.nan, 500, 320, 240]\n  resolution: [640, 480]\n"),
    /no intrinsics that can be read/,
  ],
  [
    "kalibr-zero.yaml",
    text("cam0:\n  camera_model: pinhole\n  intrinsics: [0, 0, 0, 0]\n  resolution: [640, 480]\n"),
    /focal lengths 0 and 0/,
  ],
  [
    "kalibr-pose.yaml",
    text("cam1:\n  T_cn_cnm1:\n  - [1, 0, 0, 0]\n  - [0, 1, 0, 0]\n  - [0, 0, .inf, 0]\n  - [0, 0, 0, 1]\n"),
    /neither a camera/,
  ],
  [
    "nuscenes-zero.json",
    json([{ token: "a", sensor_token: "b", rotation: [0, 0, 0, 0], translation: [0, 0, 0], camera_intrinsic: [] }]),
    /quaternion has the length 0\.00/,
  ],
  ["waymo-transform.txt", waymo(` extrinsic {\n${" transform: 1\n".repeat(15)}}\n`), /Waymo's dataset, but its camera/],
  ["waymo-open.txt", text("camera_calibrations {\n".repeat(20_000)), /nested deeper/],
  ["waymo-number.txt", waymo(` intrinsic: ${"9".repeat(400)}\n`), /Waymo's dataset, but its camera/],
  ["urdf-origin.urdf", urdf(joint("a", "b", '<origin xyz="0 0" rpy="0 0 0"/>')), /expand it with xacro/],
  [
    "xacro-circle.xacro",
    urdf(
      `<xacro:property name="a" value="${xacro("b")}"/><xacro:property name="b" value="${xacro("a")}"/>${joint("a", "b", origin(xacro("a")))}`,
    ),
    /expand it with xacro/,
  ],
  [
    "xacro-deep.xacro",
    urdf(joint("a", "b", origin(xacro(`${"(".repeat(3000)}1${")".repeat(3000)}`)))),
    /more than 4096 characters/,
  ],
  ["xacro-zero.xacro", urdf(joint("a", "b", origin(xacro("1/0")))), /expand it with xacro/],
  ["mrcal-open.cameramodel", text("{ 'lensmodel': 'LENSMODEL_OPENCV4', 'intrinsics': [ 500,500,"), /as YAML/],
  [
    "mrcal-few.cameramodel",
    text("{ 'lensmodel': 'LENSMODEL_OPENCV4', 'intrinsics': [ 500,500,320 ], 'imagersize': [ 640,480 ] }"),
    /needs 8 intrinsics, but has 3/,
  ],
  ["zed-nan.conf", text("[LEFT_CAM_HD]\nfx=nan\nfy=700\ncx=640\ncy=360\n"), /ZED's calibration, but holds no camera/],
  ["zed-empty.conf", text("[LEFT_CAM_HD]\n"), /ZED's calibration, but holds no camera/],
  ["record3d-zero.json", json({ K: Array(9).fill(0), w: 720, h: 960, dw: 0, dh: 0, fps: 30 }), /focal lengths 0 and 0/],
  [
    "record3d-size.json",
    json({ K: [720, 0, 0, 0, 720, 0, 360, 480, 1], w: -720, h: 960, fps: 30 }),
    /invalid image size -720x960/,
  ],
  [
    "nerf-focal.json",
    json({ fl_x: -500, fl_y: 500, cx: 320, cy: 240, w: 640, h: 480, frames: [] }),
    /focal lengths -500 and 500/,
  ],
  [
    "nerf-many.json",
    json({ camera_angle_x: 0.7, frames: again(8000, (at) => ({ file_path: `${at}.png`, transform_matrix: 1 })) }),
    /neither a camera/,
  ],
  [
    "bop-scale.json",
    json({ fx: 500, fy: 500, cx: 320, cy: 240, width: 640, height: 480, depth_scale: -1 }),
    "unit-guessed",
  ],
  [
    "bop-many.json",
    json(Object.fromEntries(again(6000, (at) => [at, { cam_K: [500 + at, ...K.slice(1)], depth_scale: 1 }]))),
    /more than 5000 cameras/,
  ],
  ["bop-K.json", json({ 0: { cam_K: K.map(() => 1e300), depth_scale: 1 } }), /focal lengths 1e\+300/],
  [
    "matlab-zero.json",
    json({
      IntrinsicMatrix: [
        [0, 0, 0],
        [0, 0, 0],
        [0, 0, 0],
      ],
      RadialDistortion: [0, 0],
    }),
    /focal lengths 0 and 0/,
  ],
  [
    "bouguet-open.m",
    text(`fc = [ ${"5 ".repeat(100_000)}\ncc = [ 1 ; 2 ];\n`),
    /Bouguet's toolbox, but holds no camera/,
  ],
  ["scannet-shift.txt", text("m_depthShift = 0\nm_calibrationColorIntrinsic = 1\n"), /focal lengths 1 and NaN/],
  ["scannet-zero.txt", text(`m_calibrationColorIntrinsic = ${Array(16).fill(0).join(" ")}\n`), /focal lengths 0 and 0/],
  [
    "aria-turn.json",
    json({
      CameraCalibrations: [
        {
          Label: "a",
          Projection: { Name: "Linear", Params: [1, null, "x"] },
          T_Device_Camera: { Translation: [0, 0, 0], UnitQuaternion: [0, [0, 0, 0]] },
        },
      ],
    }),
    /quaternion has the length 0\.00/,
  ],
  ["handeye-zero.yaml", handEye(0), /quaternion has the length 0\.00/],
  ["handeye-inf.yaml", handEye(".inf"), /quaternion has the length NaN/],
  [
    "basalt-few.json",
    json({ value0: { T_imu_cam: [{ px: 0 }], intrinsics: [{ camera_type: "kb4", intrinsics: {} }], resolution: [] } }),
    /quaternion has the length NaN/,
  ],
  [
    "kinect2.json",
    json({ FocalLengthX: null, FocalLengthY: 366, PrincipalPointX: 258, PrincipalPointY: 205 }),
    /focal lengths NaN and 366/,
  ],
  ["zivid.yml", text("FloatMatrix:\n  Data: [[1, 2, 3], [4, 5, 6]]\n"), /neither a camera/],
  ["autoware.yaml", text("base:\n  lidar: {x: 0, y: 0, z: 0, roll: .nan, pitch: 0, yaw: 0}\n"), /neither a camera/],
  [
    "argoverse2.csv",
    text("sensor_name,qw,qx,qy,qz,tx_m,ty_m,tz_m\nring_front_center,0,0,0,0,1,1,1\n"),
    /quaternion has the length 0\.00/,
  ],
  [
    "middlebury.txt",
    text("cam0=[0 0 0; 0 0 0; 0 0 1]\ncam1=[0 0 0; 0 0 0; 0 0 1]\ndoffs=0\nbaseline=0\nwidth=0\nheight=0\n"),
    /focal lengths 0 and 0/,
  ],
  [
    "vlcal.json",
    json({ camera: { camera_model: "plumb_bob", intrinsics: [], distortion_coeffs: [] }, results: {} }),
    /focal lengths NaN and NaN/,
  ],
  ["images.txt", text("1 nan nan nan nan 0 0 0 1 a.png\n\n"), /an unknown format/],
  [
    "tf.launch",
    text(`${"static_transform_publisher 0 0 0 0 0 0 a b\n".repeat(2000)}`),
    /more than 1000 static transforms/,
  ],
  ["tf-zero.txt", text("static_transform_publisher 0 0 0 0 0 0 0 a b\n"), /quaternion has the length 0\.00/],
  ["echo.txt", text("- Translation: [1, 2]\n- Rotation: in Quaternion [0, 0, 0, 1]\n"), /does not have 3 numbers/],
  ["infinite.json", text('{"fx": 1e999, "fy": 500, "cx": 320, "cy": 240}'), /neither a camera/],
  ["nan.yaml", text("fx: .nan\nfy: 500\ncx: 320\ncy: 240\n"), /neither a camera/],
  ["huge.json", text('{"fx": 1e300, "fy": 1e300, "cx": 1e300, "cy": 1e300}'), /focal lengths 1e\+300/],
  ["utf16.txt", new Uint8Array([0xff, 0xfe, 0x35, 0xd8]), /format is not supported/],
  ["surrogate.yaml", bytes(text("K: "), [0xed, 0xa0, 0x80]), /format is not supported/],
  ["circle.yaml", text("a: &a\n  b: *a\n"), /nested deeper than 24/],
  ["merge.yaml", text("a: &a\n  <<: *a\n  fx: 500\n"), /neither a camera/],
  ["tag.yaml", text("K: !!js/function 'function(){}'\n"), /as YAML: unknown scalar tag/],
  [
    "rows.yaml",
    text("camera_matrix: !!opencv-matrix\n  rows: 3\n  cols: 3\n  dt: d\n  data: [500, 0, 320, 0, 500, 240, 0, 0]\n"),
    /neither a camera/,
  ],
  [
    "rows.xml",
    text(
      '<?xml version="1.0"?><opencv_storage><K type_id="opencv-matrix"><rows>-3</rows><cols>999999999</cols><dt>d</dt><data>1 2 3</data></K></opencv_storage>',
    ),
    /neither a camera/,
  ],
  ["cdata.xml", text("<a><![CDATA[ fx: 500"), /raw data, which is not supported/],
  ["comment.xml", text("<a><!-- without end"), /cut off: a "-->" is missing/],
  ["nested.toml", text(`[a]\nb = ${"[".repeat(5000)}${"]".repeat(5000)}\n`), /neither a camera/],
  ["proto.ini", text("[__proto__]\nfx = 500\n[constructor]\nfx: -1\nfy: 500\n"), /neither a camera/],
  [
    "columns.csv",
    text(`${again(5000, (at) => `c${at}`).join(",")}\n${again(5000, String).join(",")}\n`),
    /neither a camera/,
  ],
];

/** A ZIP archive with one entry whose header may be wrong. */
function zipOf(
  name,
  content,
  { size = content.length, packed = deflateRawSync(content), entries = 1, at = 0, flags = 0, method = 8 } = {},
) {
  const head = Buffer.alloc(30);
  head.write("PK\x03\x04", 0, "latin1");
  head.writeUInt16LE(flags, 6);
  head.writeUInt16LE(method, 8);
  head.writeUInt16LE(name.length, 26);
  const entry = Buffer.alloc(46);
  entry.write("PK\x01\x02", 0, "latin1");
  entry.writeUInt16LE(flags, 8);
  entry.writeUInt16LE(method, 10);
  entry.writeUInt32LE(packed.length, 20);
  entry.writeUInt32LE(size, 24);
  entry.writeUInt16LE(name.length, 28);
  entry.writeUInt32LE(at, 42);
  const end = Buffer.alloc(22);
  end.write("PK\x05\x06", 0, "latin1");
  end.writeUInt16LE(entries, 10);
  end.writeUInt32LE(30 + name.length + packed.length, 16);
  return bytes(head, text(name), packed, entry, text(name), end);
}
const array = npy({ descr: "<f4", shape: [4, 4], data: new Float32Array(16).fill(1) });
const head = (entry) =>
  bytes([0x93, 78, 85, 77, 80, 89, 1, 0, entry.length & 255, entry.length >> 8], text(entry), new Uint8Array(64));
const shaped = (shape, descr = "<f4") => head(`{'descr': '${descr}', 'fortran_order': False, 'shape': ${shape}, }\n`);

/** A LAS file of version 1.2 with points of 20 bytes. */
function las({
  count = 300,
  size = 20,
  format = 0,
  from = 227,
  scale = 0.001,
  offset = 0,
  minor = 2,
  body = 20 * 300,
} = {}) {
  const view = new DataView(new ArrayBuffer(227 + body));
  [..."LASF"].forEach((letter, at) => view.setUint8(at, letter.charCodeAt(0)));
  view.setUint8(24, 1);
  view.setUint8(25, minor);
  view.setUint16(94, minor >= 4 ? 375 : 227, true);
  view.setUint32(96, from, true);
  view.setUint8(104, format);
  view.setUint16(105, size, true);
  view.setUint32(107, count, true);
  for (let axis = 0; axis < 3; axis++) view.setFloat64(131 + 8 * axis, scale, true);
  for (let axis = 0; axis < 3; axis++) view.setFloat64(155 + 8 * axis, offset, true);
  return new Uint8Array(view.buffer);
}
const laz = (change) => {
  const file = fixture("scan-1.laz");
  change(new DataView(file.buffer), file);
  return file;
};
/** Offset of the points in a LAS file. */
const points = (view) => view.getUint32(96, true);
const nans = (count) => new Uint8Array(new Float32Array(count).fill(NaN).buffer);

/** File name, bytes, reason, options. */
export const BINARIES = [
  [
    "bomb.npz",
    zipOf("depth.npy", array, { size: 16, packed: deflateRawSync(Buffer.alloc(2 ** 26)) }),
    /inflates to more than the 16 bytes/,
  ],
  ["promises.npz", zipOf("depth.npy", array, { size: 0xfffffff0 }), /a file of 4294967280 bytes/],
  ["elsewhere.npz", zipOf("depth.npy", array, { at: 0x7fffffff }), /lies beyond its end/],
  ["entries.npz", zipOf("depth.npy", array, { entries: 65_535 }), /65535 files/],
  ["secret.npz", zipOf("depth.npy", array, { flags: 1 }), /encrypted/],
  ["method.npz", zipOf("depth.npy", array, { method: 14 }), /method 14/],
  ["text.npz", zipOf("depth.npy", text("no array at all")), /checksum/],
  ["negative.npy", shaped("(-4, 4)"), /shape \(-4, 4\)/],
  ["overflow.npy", shaped("(4294967296, 4294967296)"), /cut off: 64 of/],
  ["axes.npy", shaped(`(${Array(200).fill(1).join(", ")})`), /no valid depth/],
  ["none.npy", shaped("(0, 4)"), /shape \(0, 4\)/],
  ["words.npy", shaped("(four, 4)"), /shape \(four, 4\)/],
  ["type.npy", shaped("(4, 4)", "<f99"), /type "<f99"/],
  ["version.npy", bytes([0x93, 78, 85, 77, 80, 89, 9, 0, 4, 0, 1, 2, 3, 4]), /cut off in its header/],
  ["header.npy", bytes([0x93, 78, 85, 77, 80, 89, 2, 0, 255, 255, 255, 255]), /cut off in its header/],
  [
    "infinite.npy",
    npy({ descr: "<f4", shape: [4, 4], data: new Float32Array(16).fill(Infinity) }),
    /no valid depth/,
    { as: "depth" },
  ],

  ["none.las", las({ count: 0 }), /declares 0 points/],
  ["many.las", las({ count: 0xffffffff }), /4294967295 points; up to/],
  ["beyond.las", las({ from: 0xffffff00 }), /cut off/],
  ["size.las", las({ size: 3 }), /format 0, 3 bytes each/],
  ["format.las", las({ format: 77 }), /format 77/],
  ["scale.las", las({ scale: NaN }), /no measured point/],
  ["infinite.las", las({ offset: Infinity }), /no measured point/],
  ["cut.las", las({ body: 100 }), /cut off: 327 of 6227/],
  ["short.las", las({ minor: 4, body: 0 }), /cut off: 227 of 375/],
  ["cut.laz", cut("scan-1.laz", 900), /damaged or cut off/],
  ["vlr.laz", laz((view) => view.setUint32(100, 0xffffffff, true)), /damaged or cut off/],
  ["chunks.laz", laz((view) => view.setBigUint64(points(view), 2n ** 60n, true)), /damaged or cut off/],
  ["garbage.laz", laz((view, file) => file.fill(0xa5, points(view) + 8)), /damaged or cut off/],
  ["copies.laz", laz((view) => view.setUint32(107, 4_000_000, true)), /cannot hold the 4000000 points/],

  ["nan.bin", nans(4000), /format is not supported/],
  ["map.bin", bytes(text("99999&99999&1&"), new Uint8Array(64)), /99999x99999 pixels/],
  ["negative.bin", bytes(text("-4&4&1&"), new Uint8Array(64)), /format is not supported/],
  ["channels.bin", bytes(text("4&4&1000000000&"), new Uint8Array(64)), /format is not supported/],
  ["cameras.bin", bytes(u32(2, 0, 1, 99, 640, 0, 480, 0), new Uint8Array(64)), /format is not supported/],
  ["nan-cameras.bin", bytes(u32(1, 0, 1, 1, 640, 0, 480, 0), nans(8)), /focal lengths/],
  ["odd.raw", new Uint8Array(1000), /not 30x30 pixels/, { size: [30, 30] }],
  [
    "ragged.csv",
    text(again(30, (row) => again(30 - (row === 29 ? 7 : 0), String).join(",")).join("\n")),
    /23 columns in row 30/,
  ],
  ["wide.csv", text(again(20, () => again(5000, String).join(",")).join("\n")), /100000 numbers in 20 rows/],
  [
    "letters.csv",
    text(again(30, (row) => again(30, (at) => (row === 20 && at === 5 ? "x" : "900")).join(",")).join("\n")),
    /"x" where a number/,
  ],
  ["short.xyz", text("1 2 3\n".repeat(30)), /at least 200 points/],
  ["hole.xyz", text(again(300, (at) => (at === 200 ? "1 2" : `${at} 2 3`)).join("\n")), /no x, y and z in line 201/],
  ["same.npy", npy({ descr: "<f4", shape: [300, 3], data: new Float32Array(900) }), /no measured point/],
];
