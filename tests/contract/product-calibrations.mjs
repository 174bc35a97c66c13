// A small file of each product that writes calibrations, by the keys of js/rig/formats/catalogue, in the product's format, shortened.
import { zipSync } from "fflate";
import {
  K,
  angles,
  columns,
  distortion,
  fixture,
  intrinsicRows,
  matrix,
  quaternion,
  rotation,
  rows,
  text,
  translation,
} from "./rig-support.mjs";
import { npy } from "./support.mjs";
import { writeNpy } from "../../pkg/write.js";

const [x, y, z, w] = quaternion;
const [roll, pitch, yaw] = angles;
const [k1, k2, p1, p2, k3] = distortion;
const { fx, fy, cx, cy } = K;
const centimetres = Object.fromEntries(["x", "y", "z"].map((axis, at) => [axis, 100 * translation[at]]));
const millimetres = translation.map((value) => 1000 * value);
const pinhole = { fx, fy, cx, cy };
const lens = { k1, k2, p1, p2, k3 };
const four = (a, b, c, d) => [a, 0, c, 0, 0, b, d, 0, 0, 0, 1, 0, 0, 0, 0, 1].join(" ");

const words = (name, content) => ({ name, bytes: text(content) });
const json = (name, value) => words(name, JSON.stringify(value, null, 1));
const made = (name) => ({ name, bytes: fixture(name) });
const lines = (all) => `${all.join("\n")}\n`;
const yamlPlace = ([a, b, c]) => `{x: ${a}, y: ${b}, z: ${c}, roll: ${roll}, pitch: ${pitch}, yaw: ${yaw}}`;

/** Devices whose files hold both the depth and the colour camera. */
const DEVICES = {
  "realsense-list": words(
    "rs-enumerate-devices.txt",
    lines([
      ...["Depth", "Color"].flatMap((name) => [
        ` Intrinsic of "${name}" / 640x480 / {Z16}`,
        ...["Width: 640", "Height: 480", `PPX: ${cx}`, `PPY: ${cy}`, `Fx: ${fx}`, `Fy: ${fy}`].map(
          (line) => `  ${line}`,
        ),
        "  Distortion: Brown Conrady",
        `  Coeffs: ${distortion.join("  ")}`,
        "",
      ]),
      'Extrinsic from "Depth"\t  To\t  "Color" :',
      " Rotation Matrix:",
      ...rows.map((row) => `  ${row.join("   ")}`),
      ` Translation Vector: ${translation.join("  ")}`,
    ]),
  ),
  "realsense-print": words(
    "intrinsics.txt",
    `Depth intrinsics: [ 848x480  p[424.1 238.2]  f[421.3 421.4]  Brown Conrady [0 0 0 0 0] ]\nColor intrinsics: [ 640x480  p[${cx} ${cy}]  f[${fx} ${fy}]  Inverse Brown Conrady [${distortion.join(" ")}] ]\nDepth to Color: rotation: [${columns.join(", ")}]\ntranslation: [${translation.join(", ")}]\n`,
  ),
  "realsense-snapshot": words(
    "snap_Color_metadata.csv",
    `Frame Info\nType,Color\nFormat,RGB8\nResolution x,640\nResolution y,480\n\nIntrinsic:,\nFx,${fx}\nFy,${fy}\nPPx,${cx}\nPPy,${cy}\nDistorsion,Inverse Brown Conrady\n`,
  ),
  depthai: json("calib.json", {
    boardName: "OAK-D",
    cameraData: [
      [0, {}],
      [2, { rotationMatrix: rows, toCameraSocket: 0, translation: centimetres }],
    ].map(([socket, extrinsics]) => [
      socket,
      {
        ...{ cameraType: 0, height: 480, width: 640, intrinsicMatrix: intrinsicRows },
        distortionCoeff: [...distortion, ...Array(9).fill(0)],
        extrinsics,
      },
    ]),
  }),
  "azure-json": json("calibration.json", {
    CalibrationInformation: {
      Cameras: ["Depth", "PhotoVideo"].map((purpose, at) => ({
        Purpose: `CALIBRATION_CameraPurpose${purpose}`,
        Intrinsics: {
          ModelType: "CALIBRATION_LensDistortionModelBrownConrady",
          ModelParameters: [0.5, 0.51, at ? 0.48 : 0.49, at ? 0.64 : 0.49, k1, k2, k3, 0.1, 0.05, 0.02, 0, 0, p2, p1],
        },
        Rt: at
          ? { Rotation: rotation, Translation: translation }
          : { Rotation: [1, 0, 0, 0, 1, 0, 0, 0, 1], Translation: [0, 0, 0] },
      })),
      InertialSensors: [{}],
    },
  }),
  "azure-print": words(
    "calibration_info.txt",
    lines([
      "===== Device 0: 000 =====",
      ...["resolution width: 640", "resolution height: 576", `principal point x: ${cx}`, `principal point y: ${cy}`],
      ...[
        `focal length x: ${fx}`,
        `focal length y: ${fy}`,
        "radial distortion coefficients:",
        `k1: ${k1}`,
        `k2: ${k2}`,
      ],
      ...[`k3: ${k3}`, "k4: 0.1", "k5: 0.05", "k6: 0.02", `tangential distortion coefficient x: ${p1}`],
      ...[`tangential distortion coefficient y: ${p2}`, "metric radius: 1.7"],
    ]),
  ),
  "kinect-v2": json("kinect2.json", {
    ...{ FocalLengthX: 365, FocalLengthY: 366, PrincipalPointX: 258, PrincipalPointY: 205 },
    ...{ RadialDistortionSecondOrder: 0.09, RadialDistortionFourthOrder: -0.27, RadialDistortionSixthOrder: 0.08 },
  }),
  "kinect-v2-pose": words(
    "calib_pose.yaml",
    `%YAML:1.0\nrotation: !!opencv-matrix\n   rows: 3\n   cols: 3\n   dt: d\n   data: [ ${rotation.join(", ")} ]\ntranslation: !!opencv-matrix\n   rows: 3\n   cols: 1\n   dt: d\n   data: [ ${translation.join(", ")} ]\n`,
  ),
  zed: words(
    "SN12345.conf",
    ["LEFT", "RIGHT"]
      .map((side) => `[${side}_CAM_HD]\nfx=700\nfy=700\ncx=640\ncy=360\nk1=${k1}\nk2=${k2}\n`)
      .join("\n") + "\n[STEREO]\nBaseline=120\n",
  ),
  zivid: words(
    "Intrinsics.yml",
    `__version__: 1\nCameraIntrinsics:\n  CameraMatrix:\n    CX: ${cx}\n    CY: ${cy}\n    FX: ${fx}\n    FY: ${fy}\n  Distortion:\n    K1: ${k1}\n    K2: ${k2}\n    K3: ${k3}\n    P1: ${p1}\n    P2: ${p2}\n`,
  ),
  orbbec: json("camera_param.json", {
    depthIntrinsic: { ...pinhole, width: 640, height: 480 },
    rgbIntrinsic: { ...pinhole, width: 640, height: 480 },
    depthDistortion: { ...lens, k4: 0, k5: 0, k6: 0 },
    rgbDistortion: { ...lens, k4: 0, k5: 0, k6: 0 },
    transform: { rot: rotation, trans: millimetres },
  }),
  aria: json("calib.json", {
    CameraCalibrations: ["camera-slam-left", "camera-slam-right"].map((Label, at) => ({
      ...{ Label, Projection: { Name: "KannalaBrandtK3", Params: [fx, fy, cx, cy, 0.1, 0.2, 0.3, 0.4] } },
      T_Device_Camera: {
        Translation: at ? translation : [0, 0, 0],
        UnitQuaternion: at ? [w, [x, y, z]] : [1, [0, 0, 0]],
      },
    })),
  }),
  "record3d-metadata": json("metadata", {
    K: [720, 0, 0, 0, 720, 0, 360, 480, 1],
    w: 720,
    h: 960,
    dw: 180,
    dh: 240,
    fps: 30,
    poses: [[0, 0, 0, 1, 0, 0, 0]],
  }),
  "polycam-camera": json("keyframes/corrected_cameras/100000.json", {
    ...{ fx: 1434.2, fy: 1434.2, cx: 511.3, cy: 383.1, width: 1024, height: 768 },
    ...{ t_00: 1, t_01: 0, t_02: 0, t_03: 0.1, t_10: 0, t_11: 1, t_12: 0, t_13: 0, t_20: 0, t_21: 0, t_22: 1, t_23: 0 },
  }),
  "stray-matrix": words("camera_matrix.csv", `${fx}, 0.0, ${cx}\n0.0, ${fy}, ${cy}\n0.0, 0.0, 1.0\n`),
  arkit: json("frame_00000.json", {
    intrinsics: [fx, 0, cx, 0, fy, cy, 0, 0, 1],
    cameraPoseARFrame: matrix.flat(),
    time: 1,
  }),
};

/** Calibration tools. */
const TOOLS = {
  kalibr: made("camchain.yaml"),
  "kalibr-results": words(
    "results-cam.txt",
    lines([
      ...["Calibration results", "====================", "Camera-system parameters:", "\tcam0 (/color/image):"],
      "\t type: <class 'aslam_cv.libaslam_cv_python.DistortedPinholeCameraGeometry'>",
      `\t distortion: [${[k1, k2, p1, p2].join(" ")}] +- [0.1 0.1 0.1 0.1]`,
      `\t projection: [${[fx, fy, cx, cy].join(" ")}] +- [0.1 0.1 0.1 0.1]`,
    ]),
  ),
  euroc: words(
    "sensor.yaml",
    `sensor_type: camera\nT_BS:\n  cols: 4\n  rows: 4\n  data: [${matrix.flat().join(", ")}]\nresolution: [640, 480]\ncamera_model: pinhole\nintrinsics: [${fx}, ${fy}, ${cx}, ${cy}]\ndistortion_model: radial-tangential\ndistortion_coefficients: [${k1}, ${k2}, ${p1}, ${p2}]\n`,
  ),
  camodocal: words(
    "cam0_pinhole.yaml",
    `%YAML:1.0\n---\nmodel_type: PINHOLE\ncamera_name: camera\nimage_width: 640\nimage_height: 480\ndistortion_parameters:\n   k1: ${k1}\n   k2: ${k2}\n   p1: ${p1}\n   p2: ${p2}\nprojection_parameters:\n   fx: ${fx}\n   fy: ${fy}\n   cx: ${cx}\n   cy: ${cy}\n`,
  ),
  basalt: json("calibration.json", {
    value0: {
      T_imu_cam: [0, 0.1].map((px) => ({ px, py: 0, pz: 0, qx: 0, qy: 0, qz: 0, qw: 1 })),
      intrinsics: [0, 1].map(() => ({
        camera_type: "kb4",
        intrinsics: { ...pinhole, k1: 0.1, k2: 0.2, k3: 0.3, k4: 0.4 },
      })),
      resolution: [
        [640, 480],
        [640, 480],
      ],
    },
  }),
  mrcal: words(
    "camera-0.cameramodel",
    `# generated by mrcal\n{\n  'lensmodel':  'LENSMODEL_OPENCV5',\n  'intrinsics': [ ${[fx, fy, cx, cy, ...distortion].join(",")},],\n  'extrinsics': [ 0.02,-0.03,0.05,${translation.join(",")},],\n  'imagersize': [ 640,480,]\n}\n`,
  ),
  "opencv-yaml": made("opencv.yaml"),
  "opencv-xml": made("stereo-vector.xml"),
  "opencv-npz": {
    name: "calibration.npz",
    bytes: zipSync({
      "mtx.npy": npy({ descr: "<f8", shape: [3, 3], data: Float64Array.from(intrinsicRows.flat()) }),
      "dist.npy": npy({ descr: "<f8", shape: [1, 5], data: Float64Array.from(distortion) }),
    }),
  },
  open3d: made("open3d-intrinsic.json"),
  "camera-info": made("camera_info.yaml"),
  ost: words(
    "ost.txt",
    `# oST version 5.0 parameters\n\n[image]\n\nwidth\n640\n\nheight\n480\n\n[narrow_stereo]\n\ncamera matrix\n${intrinsicRows.map((row) => row.join(" ")).join("\n")}\n\ndistortion\n${distortion.join(" ")}\n\nrectification\n1 0 0\n0 1 0\n0 0 1\n\nprojection\n${fx} 0 ${cx} 0\n0 ${fy} ${cy} 0\n0 0 1 0\n`,
  ),
  "static-transform": words(
    "rig.launch.py",
    `arguments=["--x", "${translation[0]}"]\nros2 run tf2_ros static_transform_publisher --x ${translation[0]} --y ${translation[1]} --z ${translation[2]} --qx ${x} --qy ${y} --qz ${z} --qw ${w} --frame-id color_optical --child-frame-id depth_optical\n`,
  ),
  "tf2-echo": words(
    "tf.txt",
    `At time 0.0\n- Translation: [${translation.join(", ")}]\n- Rotation: in Quaternion [${quaternion.join(", ")}]\n`,
  ),
  urdf: words(
    "rig.urdf",
    `<?xml version="1.0"?><robot name="rig"><joint name="j" type="fixed"><parent link="color_optical_frame"/><child link="depth_optical_frame"/><origin xyz="${translation.join(" ")}" rpy="${roll} ${pitch} ${yaw}"/></joint></robot>`,
  ),
  autoware: words("sensor_kit_calibration.yaml", `camera_optical_link:\n  velodyne_top: ${yamlPlace(translation)}\n`),
  "hand-eye": words(
    "eye_on_base.yaml",
    `parameters:\n  eye_on_hand: false\n  robot_base_frame: base_link\n  tracking_base_frame: camera_color_optical_frame\ntransformation: {x: ${translation[0]}, y: ${translation[1]}, z: ${translation[2]}, qx: ${x}, qy: ${y}, qz: ${z}, qw: ${w}}\n`,
  ),
  multical: json("calibration.json", {
    cameras: Object.fromEntries(
      ["color", "depth"].map((name) => [
        name,
        { model: "standard", image_size: [640, 480], K: intrinsicRows, dist: [distortion] },
      ]),
    ),
    camera_poses: {
      color: {
        R: [
          [1, 0, 0],
          [0, 1, 0],
          [0, 0, 1],
        ],
        T: [0, 0, 0],
      },
      depth_to_color: { R: rows, T: translation },
    },
  }),
  opencalib: json("center_camera-intrinsic.json", {
    "center_camera-intrinsic": {
      ...{ sensor_name: "center_camera", param_type: "intrinsic" },
      param: {
        ...{ img_dist_w: 640, img_dist_h: 480 },
        cam_K: { rows: 3, cols: 3, type: 6, data: intrinsicRows },
        cam_dist: { rows: 1, cols: 5, type: 6, data: [distortion] },
      },
    },
  }),
  vlcal: json("calib.json", {
    camera: { camera_model: "plumb_bob", intrinsics: [fx, fy, cx, cy], distortion_coeffs: distortion },
    results: { T_lidar_camera: [...translation, x, y, z, w] },
  }),
  "fast-livo": words(
    "avia.yaml",
    `extrin_calib:\n  extrinsic_T: [0.04165, 0.02326, -0.0284]\n  extrinsic_R: [1, 0, 0, 0, 1, 0, 0, 0, 1]\n  Rcl: [${rotation.join(", ")}]\n  Pcl: [${translation.join(", ")}]\n`,
  ),
  vikit: words(
    "camera_pinhole.yaml",
    `cam_model: Pinhole\ncam_width: 640\ncam_height: 480\nscale: 1.0\ncam_fx: ${fx}\ncam_fy: ${fy}\ncam_cx: ${cx}\ncam_cy: ${cy}\ncam_d0: ${k1}\ncam_d1: ${k2}\ncam_d2: ${p1}\ncam_d3: ${p2}\n`,
  ),
  matlab: json("stereoParams.json", {
    ...Object.fromEntries(
      [1, 2].map((number) => [
        `CameraParameters${number}`,
        {
          ...{
            RadialDistortion: [k1, k2],
            TangentialDistortion: [p1, p2],
            ImageSize: [480, 640],
            WorldUnits: "millimeters",
          },
          IntrinsicMatrix: [
            [fx, 0, 0],
            [0, fy, 0],
            [cx + 1, cy + 1, 1],
          ],
        },
      ]),
    ),
    RotationOfCamera2: [0, 1, 2].map((at) => columns.slice(3 * at, 3 * at + 3)),
    TranslationOfCamera2: millimetres,
  }),
  bouguet: words(
    "Calib_Results.m",
    `% Intrinsic parameters\nfc = [ ${fx} ; ${fy} ];\ncc = [ ${cx} ; ${cy} ];\nalpha_c = 0.0;\nkc = [ ${distortion.join(" ; ")} ];\nnx = 640;\nny = 480;\nomc_1 = [ 1 ; 2 ; 3 ];\nTc_1  = [ 1 ; 2 ; 900 ];\n`,
  ),
  "colmap-cameras": words(
    "cameras.txt",
    `# Camera list\n1 OPENCV 640 480 ${fx} ${fy} ${cx + 0.5} ${cy + 0.5} ${k1} ${k2} ${p1} ${p2}\n`,
  ),
  "colmap-cameras-bin": {
    name: "cameras.bin",
    bytes: (() => {
      const view = new DataView(new ArrayBuffer(8 + 24 + 32));
      view.setUint32(0, 1, true);
      view.setUint32(8, 1, true);
      view.setInt32(12, 1, true);
      view.setBigUint64(16, 640n, true);
      view.setBigUint64(24, 480n, true);
      [fx, fy, cx + 0.5, cy + 0.5].forEach((value, at) => view.setFloat64(32 + 8 * at, value, true));
      return new Uint8Array(view.buffer);
    })(),
  },
  "colmap-images": words(
    "images.txt",
    `# Image list\n1 ${w} ${x} ${y} ${z} ${translation.join(" ")} 1 0001.png\n100.0 200.0 -1\n`,
  ),
  nerfstudio: json("transforms.json", {
    ...{ fl_x: fx, fl_y: fy, cx: cx + 0.5, cy: cy + 0.5, w: 640, h: 480, k1, k2, p1, p2, camera_model: "OPENCV" },
    frames: [{ file_path: "images/0001.png", transform_matrix: matrix }],
  }),
  "matrix-text": made("K.txt"),
  "matrix-npy": {
    name: "depth_to_color.npy",
    bytes: writeNpy({ width: 4, height: 4, channels: 1, data: Float32Array.from(matrix.flat()) }),
  },
  "tum-trajectory": words(
    "groundtruth.txt",
    lines([0, 1].map((at) => `${at}.5 ${translation.join(" ")} ${quaternion.join(" ")}`)),
  ),
  "redwood-log": made("redwood.log"),
  "table-of-poses": words("calibration.csv", `roll,pitch,yaw,x,y,z\n${[roll, pitch, yaw, ...translation].join(",")}\n`),
  "any-json": json("rig.json", { rgb: pinhole, depth: pinhole, depth_to_color: matrix }),
  "any-toml": words("rig.toml", `[color]\nfx = ${fx}\nfy = ${fy}\ncx = ${cx}\ncy = ${cy}\nresolution = [640, 480]\n`),
  "any-labels": words("calib.txt", `fx ${fx}\nfy ${fy}\ncx ${cx}\ncy ${cy}\n`),
};

const line = (key, values) => `${key}: ${values.join(" ")}\n`;
const projection = [500, 0, 320, 0, 0, 500, 240, 0, 0, 0, 1, 0];
const velodyne = [0, -1, 0, 0.1, 0, 0, -1, 0.2, 1, 0, 0, 0.3];

/** Datasets. */
const DATASETS = {
  "kitti-object": words(
    "calib/000000.txt",
    [0, 1, 2, 3].map((at) => line(`P${at}`, projection)).join("") +
      line("R0_rect", [1, 0, 0, 0, 1, 0, 0, 0, 1]) +
      line("Tr_velo_to_cam", velodyne),
  ),
  "kitti-raw": words(
    "calib_velo_to_cam.txt",
    `calib_time: 15-Mar-2012 11:37:16\n${line("R", rotation)}${line("T", translation)}delta_f: 0 0\ndelta_c: 0 0\n`,
  ),
  nuscenes: json("calibrated_sensor.json", [
    { token: "aa", sensor_token: "s1", rotation: [1, 0, 0, 0], translation: [0, 0, 2], camera_intrinsic: [] },
    {
      token: "bb",
      sensor_token: "s2",
      rotation: [w, -x, -y, -z],
      translation: [0, 0, 2],
      camera_intrinsic: intrinsicRows,
    },
  ]),
  "waymo-json": json("context.json", {
    cameraCalibrations: [
      {
        ...{ name: "FRONT", intrinsic: [fx, fy, cx, cy, ...distortion], width: 1920, height: 1280 },
        extrinsic: { transform: [1, 0, 0, 1.5, 0, 1, 0, 0, 0, 0, 1, 2, 0, 0, 0, 1] },
      },
    ],
    laserCalibrations: [
      { name: "TOP", extrinsic: { transform: [1, 0, 0, 1.5, 0, 1, 0, 0, 0, 0, 1, 2.5, 0, 0, 0, 1] } },
    ],
  }),
  "waymo-text": words(
    "context.txt",
    `name: "1"\ncamera_calibrations {\n  name: FRONT\n${[fx, fy, cx, cy, ...distortion].map((value) => `  intrinsic: ${value}\n`).join("")}  extrinsic {\n${[1, 0, 0, 1, 0, 1, 0, 0, 0, 0, 1, 2, 0, 0, 0, 1].map((value) => `    transform: ${value}\n`).join("")}  }\n  width: 1920\n  height: 1280\n}\n`,
  ),
  a2d2: json("cams_lidars.json", {
    cameras: {
      front_center: {
        CamMatrix: [
          [1687.3, 0, 965.4],
          [0, 1783.2, 684.4],
          [0, 0, 1],
        ],
        CamMatrixOriginal: [
          [1711, 0, 945],
          [0, 1711, 604],
          [0, 0, 1],
        ],
        Distortion: [[-0.24, 0.14, 0.0008, 0.0003, -0.04]],
        Lens: "Telecam",
        Resolution: [1920, 1208],
        view: { origin: [1.71, 0, 0.94], "x-axis": [1, 0, 0], "y-axis": [0, 1, 0] },
      },
    },
    lidars: {},
  }),
  argoverse: json("vehicle_calibration_info.json", {
    camera_data_: [
      {
        key: "image_raw_ring_front_center",
        value: {
          ...{ focal_length_x_px_: fx, focal_length_y_px_: fy, focal_center_x_px_: cx, focal_center_y_px_: cy },
          ...{ distortion_coefficients_: [k1, k2, k3], skew_: 0 },
          vehicle_SE3_camera_: { rotation: { coefficients: [w, x, y, z] }, translation },
        },
      },
    ],
  }),
  "argoverse2-csv": words(
    "egovehicle_SE3_sensor.csv",
    `sensor_name,qw,qx,qy,qz,tx_m,ty_m,tz_m\nring_front_center,${[w, x, y, z, ...translation].join()}\n`,
  ),
  "argoverse2-json": json("intrinsics.json", [
    {
      sensor_name: "ring_front_center",
      fx_px: fx,
      fy_px: fy,
      cx_px: cx,
      cy_px: cy,
      k1,
      k2,
      k3,
      height_px: 480,
      width_px: 640,
    },
  ]),
  scannet: words(
    "scene0000_00.txt",
    `m_colorWidth = 1296\nm_colorHeight = 968\nm_depthWidth = 640\nm_depthHeight = 480\nm_depthShift = 1000\nm_calibrationColorIntrinsic = ${four(1160, 1161, 650, 480)}\nm_calibrationDepthIntrinsic = ${four(570, 571, 320, 240)}\nm_calibrationColorExtrinsic = ${four(1, 1, 0, 0)}\nm_calibrationDepthExtrinsic = ${four(1, 1, 0, 0)}\n`,
  ),
  bop: json("camera.json", { ...pinhole, width: 640, height: 480, depth_scale: 0.1 }),
  arkitscenes: words("41069021_123.456.pincam", "256 192 212.5 212.5 127.9 95.6\n"),
  "middlebury-calibration": words(
    "calib.txt",
    "cam0=[3997.684 0 1176.728; 0 3997.684 1011.728; 0 0 1]\ncam1=[3997.684 0 1307.839; 0 3997.684 1011.728; 0 0 1]\ndoffs=131.111\nbaseline=193.001\nwidth=2964\nheight=1988\n",
  ),
};

export const CALIBRATION_SAMPLES = { ...DEVICES, ...TOOLS, ...DATASETS };
