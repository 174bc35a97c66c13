// Calibrations of vehicles and robots: frames, quaternions with w first, and chains of poses.
import assert from "node:assert/strict";
import { describe, test } from "node:test";
import {
  angles,
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
  samePose,
  translation,
} from "./rig-support.mjs";

const [x, y, z, w] = quaternion;
const [roll, pitch, yaw] = angles;

describe("LiDARs and cameras of vehicles", () => {
  test("direct_visual_lidar_calibration: the camera in the LiDAR's frame, the result before the first guess", async () => {
    const seven = [...translation, x, y, z, w];
    const camera = {
      camera_model: "plumb_bob",
      intrinsics: [518.5, 519.25, 325.5, 253.75],
      distortion_coeffs: distortion,
    };
    const found = await json({
      camera,
      meta: {},
      results: { init_T_lidar_camera: [0, 0, 0, 0, 0, 0, 1], T_lidar_camera: seven },
    });
    assert.deepEqual(
      [...numbers(found.cameras[0]), ...lens(found.cameras[0])],
      [518.5, 519.25, 325.5, 253.75, "brown", ...distortion],
    );
    samePose(found.poses[0]);
    assert.deepEqual(ends(found.poses[0]), ["camera", "lidar"]);
    const early = await json({ camera, results: { init_T_lidar_camera: seven } });
    assert.deepEqual(codes(early), ["pose-assumed"]);
    await refusedFile(
      json({ camera: { camera_model: "omnidir", intrinsics: [1, 2, 3, 4, 5], distortion_coeffs: [1] }, meta: {} }),
      "calib.json",
      /direct_visual_lidar_calibration.*omnidir/,
    );
  });

  test("nuScenes and Lyft: w x y z, sensors in the vehicle, one LiDAR and one camera related", async () => {
    const record = (token, r, t, camera_intrinsic) => ({
      ...{ token, sensor_token: `s${token}`, rotation: r, translation: t, camera_intrinsic },
    });
    const found = await json([
      record("aa", [1, 0, 0, 0], [0, 0, 2], []),
      record("bb", [w, -x, -y, -z], [0, 0, 2], intrinsicRows),
    ]);
    close(numbers(found.cameras[0]), [518.5, 519.25, 325.5, 253.75], 1e-9);
    assert.deepEqual(found.poses.map(ends), [
      ["sensor aa", "camera bb"],
      ["sensor aa", "ego"],
      ["camera bb", "ego"],
    ]);
    samePose(found.poses[0], rotation, [0, 0, 0]);
    samePose(found.poses[2], columns, [0, 0, 2]);
    const ego = await json([{ token: "cc", timestamp: 1, rotation: [1, 0, 0, 0], translation: [600, 1200, 0] }]);
    assert.deepEqual(ends(ego.poses[0]), ["ego", "world"]);
    assert.deepEqual(ego.poses[0].pose.translation, [600, 1200, 0]);
  });

  test("Argoverse's names lead into the vehicle; Waymo's cameras look along x", async () => {
    const argoverse = await json({
      camera_data_: [
        {
          key: "image_raw_ring_front_center",
          value: {
            ...{
              focal_length_x_px_: 518.5,
              focal_length_y_px_: 519.25,
              focal_center_x_px_: 325.5,
              focal_center_y_px_: 253.75,
            },
            ...{ distortion_coefficients_: [0.2, -0.5, 0.3], skew_: 0 },
            vehicle_SE3_camera_: { rotation: { coefficients: [w, x, y, z] }, translation },
          },
        },
      ],
      vehicle_SE3_down_lidar_: { rotation: { coefficients: [1, 0, 0, 0] }, translation: [1, 0, 2] },
    });
    assert.deepEqual(lens(argoverse.cameras[0]), ["brown", 0.2, -0.5, 0, 0, 0.3]);
    samePose(argoverse.poses[0]);
    assert.deepEqual(argoverse.poses.map(ends), [
      ["camera ring_front_center", "vehicle"],
      ["down lidar", "vehicle"],
    ]);
    const transform = (tx, ty, tz) => ({ transform: [1, 0, 0, tx, 0, 1, 0, ty, 0, 0, 1, tz, 0, 0, 0, 1] });
    const waymo = await json({
      cameraCalibrations: [
        {
          name: "FRONT",
          intrinsic: [518.5, 519.25, 325.5, 253.75, ...distortion],
          extrinsic: transform(1.5, 0, 2),
          width: 1920,
          height: 1280,
        },
      ],
      laserCalibrations: [{ name: "TOP", extrinsic: transform(1.5, 0, 2.5) }],
    });
    assert.deepEqual(lens(waymo.cameras[0]), ["brown", ...distortion]);
    // The LiDAR is half a metre above the camera; its x axis is the camera's z axis.
    assert.deepEqual(ends(waymo.poses[0]), ["lidar TOP", "camera FRONT"]);
    samePose(waymo.poses[0], [0, -1, 0, 0, 0, -1, 1, 0, 0], [0, -0.5, 0], 1e-9);
  });

  test("Argoverse 2's tables as CSV, Waymo's protocol buffers as text", async () => {
    const lenses = await read(
      "intrinsics.csv",
      "sensor_name,fx_px,fy_px,cx_px,cy_px,k1,k2,k3,height_px,width_px\nring_front_center,518.5,519.25,325.5,253.75,0.2,-0.5,0.3,480,640\n",
    );
    assert.deepEqual(
      [lenses.cameras[0].width, ...numbers(lenses.cameras[0]), ...lens(lenses.cameras[0])],
      [640, 518.5, 519.25, 325.5, 253.75, "brown", 0.2, -0.5, 0, 0, 0.3],
    );
    const places = await read(
      "egovehicle_SE3_sensor.csv",
      `sensor_name,qw,qx,qy,qz,tx_m,ty_m,tz_m\nring_front_center,${[w, x, y, z, ...translation].join()}\n`,
    );
    samePose(places.poses[0]);
    assert.deepEqual(ends(places.poses[0]), ["ring_front_center", "egovehicle"]);
    const values = [518.5, 519.25, 325.5, 253.75, ...distortion].map((value) => `  intrinsic: ${value}\n`).join("");
    const transform = [1, 0, 0, 1, 0, 1, 0, 0, 0, 0, 1, 2, 0, 0, 0, 1]
      .map((value) => `    transform: ${value}\n`)
      .join("");
    const waymo = await read(
      "context.txt",
      `name: "1"\ncamera_calibrations {\n  name: FRONT\n${values}  extrinsic {\n${transform}  }\n  width: 1920\n  height: 1280\n}\n`,
    );
    assert.deepEqual(
      [waymo.cameras[0].name, waymo.cameras[0].width, ...lens(waymo.cameras[0])],
      ["camera FRONT", 1920, "brown", ...distortion],
    );
    samePose(waymo.poses[0], [0, 0, 1, -1, 0, 0, 0, -1, 0], [1, 0, 2], 1e-9);
  });

  test("Autoware: x y z roll pitch yaw of children in their parents", async () => {
    const place = ([a, b, c], turn) =>
      `{x: ${a}, y: ${b}, z: ${c}, roll: ${turn[0]}, pitch: ${turn[1]}, yaw: ${turn[2]}}`;
    const plain = await read(
      "calib.yaml",
      `color_optical:\n  depth_optical: ${place(translation, [roll, pitch, yaw])}\n`,
    );
    samePose(plain.poses[0]);
    assert.deepEqual(ends(plain.poses[0]), ["depth_optical", "color_optical"]);
    const kit = await read(
      "sensor_kit_calibration.yaml",
      `sensor_kit_base_link:\n  camera0/camera_link: ${place([1, 0, 0], [0, 0, 0])}\n  velodyne_top_base_link: ${place([0, 0, 0.5], [0, 0, 0])}\n`,
    );
    // By ROS's convention, a camera_link looks along x.
    samePose(kit.poses[0], [0, -1, 0, 0, 0, -1, 1, 0, 0], [0, -0.5, -1], 1e-9);
    assert.deepEqual(codes(kit), ["pose-assumed"]);
    assert.equal(kit.poses.length, 3);
    // A frame whose y axis points down has optical axes, whatever its name.
    const half = Math.PI / 2;
    const optical = await read(
      "sensor_kit_calibration.yaml",
      `sensor_kit_base_link:\n  camera0/camera_link: ${place([1, 0, 0], [-half, 0, -half])}\n  velodyne_top_base_link: ${place([0, 0, 0.5], [0, 0, 0])}\n`,
    );
    samePose(optical.poses[0], [0, -1, 0, 0, 0, -1, 1, 0, 0], [0, -0.5, -1], 1e-9);
    assert.deepEqual(codes(optical), []);
  });
});

describe("KITTI", () => {
  const line = (key, values) => `${key}: ${values.join(" ")}\n`;
  const projection = (bx) => [500, 0, 320, 500 * bx, 0, 500, 240, 0, 0, 0, 1, 0];
  const rect = rotation;
  const velo = [0, -1, 0, 0.1, 0, 0, -1, 0.2, 1, 0, 0, 0.3];

  test("object, tracking and odometry: through the rectification and by the baseline of camera 2", async () => {
    const P = [0, 1, 2, 3].map((i) => line(`P${i}`, projection(-0.1 * i))).join("");
    const object = await read(
      "000000.txt",
      `${P}${line("R0_rect", rect)}${line("Tr_velo_to_cam", velo)}${line("Tr_imu_to_velo", velo)}`,
    );
    assert.deepEqual(ends(object.poses[0]), ["velodyne", "image_2"]);
    const axes = [0, -1, 0, 0, 0, -1, 1, 0, 0];
    const r = [0, 1, 2].flatMap((i) =>
      [0, 1, 2].map((j) => [0, 1, 2].reduce((sum, k) => sum + rect[3 * i + k] * axes[3 * k + j], 0)),
    );
    const t = [0, 1, 2].map((i) => [0.1, 0.2, 0.3].reduce((sum, value, k) => sum + rect[3 * i + k] * value, 0));
    samePose(object.poses[0], r, [t[0] - 0.2, t[1], t[2]], 1e-9);
    assert.deepEqual(
      [object.cameras[0].name, object.cameras[0].takes, ...numbers(object.cameras[0])],
      ["image_2", "both", 500, 500, 320, 240],
    );
    const odometry = await read("calib.txt", `${P}${line("Tr", velo)}`);
    samePose(odometry.poses[0], axes, [-0.1, 0.2, 0.3], 1e-9);
    const tracking = await read("0000.txt", `${P}R_rect ${rect.join(" ")}\nTr_velo_cam ${velo.join(" ")}\n`);
    samePose(tracking.poses[0], r, [t[0] - 0.2, t[1], t[2]], 1e-9);
  });

  test("raw: rectified and raw cameras by their sizes, poses by their frames", async () => {
    const cameras = await read(
      "calib_cam_to_cam.txt",
      `calib_time: 09-Jan-2012 13:57:47\n${line("S_02", [1392, 512])}${line("K_02", [900, 0, 690, 0, 901, 230, 0, 0, 1])}${line("D_02", distortion)}${line("R_02", rotation)}${line("T_02", translation)}${line("S_rect_02", [1242, 375])}${line("R_rect_00", rect)}${line("P_rect_02", projection(0.06))}`,
    );
    assert.deepEqual(
      cameras.cameras.map((each) => [each.width, each.camera.fx, each.camera.distortion?.length]),
      [
        [1242, 500, undefined],
        [1392, 900, 5],
      ],
    );
    assert.deepEqual(cameras.poses.map(ends), [
      ["cam00", "cam02"],
      ["cam00", "image_02"],
    ]);
    const single = (more) => `calib_time: 15-Mar-2012 11:37:16\n${line("R", rotation)}${line("T", translation)}${more}`;
    const lidar = await read("calib_velo_to_cam.txt", single("delta_f: 0 0\ndelta_c: 0 0\n"));
    samePose(lidar.poses[0]);
    assert.deepEqual(ends(lidar.poses[0]), ["velodyne", "cam00"]);
    assert.deepEqual(ends((await read("calib_imu_to_velo.txt", single(""))).poses[0]), ["imu", "velodyne"]);
  });
});

describe("robots", () => {
  const joint = (from, to, origin) =>
    `<joint name="j_${from}" type="fixed"><parent link="${to}"/><child link="${from}"/>${origin}</joint>`;
  /** An expression of xacro. */
  const xacro = (inner) => `\${${inner}}`;
  const optical = `<origin xyz="0 0 0" rpy="${xacro("-M_PI/2")} 0 ${xacro("-M_PI/2")}"/>`;

  test("URDF: fixed axes, from the child into the parent; xacro's properties and arithmetic", async () => {
    const origin = `<origin xyz="${translation.join(" ")}" rpy="${[roll, pitch, yaw].join(" ")}"/>`;
    const plain = await read(
      "rig.urdf",
      `<?xml version="1.0"?><robot name="rig">${joint("depth_optical", "color_optical", origin)}</robot>`,
    );
    samePose(plain.poses[0]);
    assert.deepEqual(ends(plain.poses[0]), ["depth_optical", "color_optical"]);
    const tree = `<robot name="rig" xmlns:xacro="x"><xacro:property name="base" value="0.06"/><xacro:property name="half" value="\${base/2}"/>${joint("color_frame", "camera_link", `<origin xyz="0 ${xacro("half + 0.01")} 0" rpy="0 0 ${xacro("radians(90) - pi/2")}"/>`)}${joint("color_optical_frame", "color_frame", optical)}${joint("depth_optical_frame", "camera_link", optical)}${joint("camera_link", "map", "<xacro:insert_block name='origin'/>")}</robot>`;
    const found = await read("rig.urdf.xacro", tree);
    // The depth camera is four centimetres to the left of the colour camera, so points move right in the picture.
    assert.deepEqual(ends(found.poses[0]), ["depth_optical_frame", "color_optical_frame"]);
    samePose(found.poses[0], [1, 0, 0, 0, 1, 0, 0, 0, 1], [0.04, 0, 0], 1e-9);
    assert.deepEqual(codes(found), ["pose-left-out"]);
    await refusedFile(
      read(
        "rig.xacro",
        `<robot name="rig">${joint("a", "b", `<origin xyz="${xacro("x")} 0 0" rpy="0 0 0"/>`)}</robot>`,
      ),
      "rig.xacro",
      /expand it with xacro/,
    );
  });

  test("easy_handeye names its frames, on the base and in the hand", async () => {
    const file = (inHand) =>
      `parameters:\n  eye_on_hand: ${inHand}\n  robot_base_frame: base\n  robot_effector_frame: tool0\n  tracking_base_frame: camera\ntransformation: {x: ${translation[0]}, y: ${translation[1]}, z: ${translation[2]}, qx: ${x}, qy: ${y}, qz: ${z}, qw: ${w}}\n`;
    const base = await read("eye.yaml", file(false));
    samePose(base.poses[0]);
    assert.deepEqual(ends(base.poses[0]), ["camera", "base"]);
    assert.deepEqual(ends((await read("eye.yaml", file(true))).poses[0]), ["camera", "tool0"]);
  });

  test("Basalt's and mrcal's cameras, with the lenses that are not known named", async () => {
    const place = (px) => ({ px, py: 0, pz: 0, qx: 0, qy: 0, qz: 0, qw: 1 });
    const { cameras, poses, warnings } = await json({
      value0: {
        T_imu_cam: [place(0), place(0.1)],
        intrinsics: [
          { camera_type: "ds", intrinsics: { fx: 300, fy: 300, cx: 320, cy: 240, xi: -0.2, alpha: 0.6 } },
          {
            camera_type: "kb4",
            intrinsics: { fx: 280, fy: 281, cx: 321, cy: 241, k1: 0.1, k2: 0.2, k3: 0.3, k4: 0.4 },
          },
        ],
        resolution: [
          [640, 480],
          [640, 480],
        ],
      },
    });
    assert.deepEqual(
      [cameras.length, cameras[0].name, cameras[0].width, ...lens(cameras[0])],
      [1, "cam1", 640, "fisheye", 0.1, 0.2, 0.3, 0.4],
    );
    assert.ok(warnings.some(({ code, message }) => code === "camera-left-out" && /double sphere/.test(message)));
    samePose(poses[0], [1, 0, 0, 0, 1, 0, 0, 0, 1], [-0.1, 0, 0], 1e-9);
    assert.deepEqual(ends(poses[0]), ["cam0", "cam1"]);
    const mrcal = (model, values) =>
      `# made by a test\n{\n  'lensmodel':  '${model}',\n  'intrinsics': [ ${values.join(",")},],\n  'extrinsics': [ 0.02,-0.03,0.05,${translation.join(",")},],\n  'imagersize': [ 640,480,]\n}\n`;
    const found = await read(
      "camera-0.cameramodel",
      mrcal("LENSMODEL_OPENCV5", [518.5, 519.25, 325.5, 253.75, ...distortion]),
    );
    assert.deepEqual([found.cameras[0].width, ...lens(found.cameras[0])], [640, "brown", ...distortion]);
    samePose(found.poses[0]);
    assert.deepEqual(ends(found.poses[0]), ["reference", "camera"]);
    await refusedFile(
      read("a.cameramodel", mrcal("LENSMODEL_CAHVOR", [1, 2, 3, 4])),
      "a.cameramodel",
      /mrcal.*CAHVOR.*mrcal-convert-lensmodel/,
    );
  });
});
