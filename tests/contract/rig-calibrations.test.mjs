// Cameras and poses of a rig in the formats of calibration tools.
import assert from "node:assert/strict";
import { describe, test } from "node:test";
import { cameraFromFieldOfView } from "../../pkg/rig.js";
import { K, close, distortion, read, readFixture, refusedFile, rotation, translation } from "./rig-support.mjs";

const sameCamera = ({ camera }, expected, message) =>
  close(
    [camera.fx, camera.fy, camera.cx, camera.cy],
    [expected.fx, expected.fy, expected.cx, expected.cy],
    1e-9,
    message,
  );
const samePose = ({ pose }, r = rotation, t = translation, tolerance = 1e-9) => {
  close(pose.rotation, r, tolerance, "rotation");
  close(pose.translation, t, tolerance, "translation");
  assert.equal(pose.scale, 1);
};
const only = (found) => (assert.equal(found.length, 1), found[0]);
const inverse = () => {
  const r = [0, 3, 6, 1, 4, 7, 2, 5, 8].map((at) => rotation[at]);
  return [
    r,
    [0, 1, 2].map((i) => -(r[3 * i] * translation[0] + r[3 * i + 1] * translation[1] + r[3 * i + 2] * translation[2])),
  ];
};

describe("as other programs write them", () => {
  test("OpenCV's FileStorage as YAML, XML and JSON", async () => {
    for (const name of ["opencv.yaml", "opencv.xml", "opencv.json"]) {
      const { kind, cameras } = await readFixture(name);
      assert.equal(kind, "cameras");
      const found = only(cameras);
      sameCamera(found, K, name);
      assert.deepEqual([...found.camera.distortion], distortion);
      assert.deepEqual([found.width, found.height], [640, 480]);
    }
  });

  test("OpenCV's stereo calibration: R and T, by matrix and by vector, in metres and millimetres", async () => {
    for (const name of ["stereo.yaml", "stereo-vector.xml"]) {
      const { cameras, poses, warnings } = await readFixture(name);
      assert.equal(cameras.length, 2);
      sameCamera(cameras[0], K);
      assert.equal(cameras[1].camera.distortion, undefined);
      samePose(only(poses), undefined, undefined, 1e-7);
      assert.deepEqual([poses[0].from, poses[0].to], ["1", "2"]);
      assert.equal(
        warnings.some(({ code }) => code === "translation-unit-guessed"),
        name === "stereo.yaml",
      );
    }
  });

  test("ROS's camera_info", async () => {
    const found = only((await readFixture("camera_info.yaml")).cameras);
    sameCamera(found, K);
    assert.deepEqual(
      [found.name, found.width, found.height, ...found.camera.distortion],
      ["rgb", 640, 480, ...distortion],
    );
    const message =
      "header:\n  frame_id: cam\nheight: 480\nwidth: 640\ndistortion_model: rational_polynomial\nD: [1, 2, 3, 4, 5, 6, 7, 8]\nK: [518.5, 0.0, 325.5, 0.0, 519.25, 253.75, 0.0, 0.0, 1.0]\nR: [1, 0, 0, 0, 1, 0, 0, 0, 1]\nP: [518.5, 0, 325.5, 0, 0, 519.25, 253.75, 0, 0, 0, 1, 0]\n---\n";
    for (const text of [
      message,
      message.replace("D:", "d:").replace("K:", "k:").replace("R:", "r:").replace("P:", "p:"),
    ]) {
      const { cameras, poses } = await read("info.yaml", text);
      sameCamera(only(cameras), K);
      assert.deepEqual([...cameras[0].camera.distortion], [1, 2, 3, 4, 5, 6, 7, 8]);
      assert.equal(poses.length, 0);
    }
  });

  test("Kalibr's chain: both cameras and what relates them", async () => {
    const { cameras, poses } = await readFixture("camchain.yaml");
    assert.deepEqual(
      cameras.map(({ name, camera }) => [name, camera.model, camera.distortion.length]),
      [
        ["cam0", undefined, 4],
        ["cam1", "fisheye", 4],
      ],
    );
    samePose(only(poses));
    assert.deepEqual([poses[0].from, poses[0].to], ["cam0", "cam1"]);
  });

  test("Kalibr's cameras that are related to the same inertial unit", async () => {
    const row = (t) => `[[1.0, 0.0, 0.0, ${t}], [0.0, 1.0, 0.0, 0.0], [0.0, 0.0, 1.0, 0.0], [0.0, 0.0, 0.0, 1.0]]`;
    const camera = (t) =>
      `  camera_model: pinhole\n  intrinsics: [500.0, 500.0, 320.0, 240.0]\n  distortion_model: none\n  distortion_coeffs: []\n  T_cam_imu: ${row(t)}\n  resolution: [640, 480]\n`;
    const { poses } = await read("chain.yaml", `cam0:\n${camera(0.1)}cam1:\n${camera(0.3)}`);
    assert.deepEqual([poses[0].from, poses[0].to], ["cam0", "cam1"]);
    samePose(poses[0], [1, 0, 0, 0, 1, 0, 0, 0, 1], [0.2, 0, 0]);
    assert.equal(poses.length, 3);
  });

  test("Open3D's intrinsics, parameters, trajectories, column by column", async () => {
    for (const name of ["open3d-intrinsic.json", "open3d-parameters.json", "open3d-trajectory.json"]) {
      const { cameras, poses } = await readFixture(name);
      for (const camera of cameras) sameCamera(camera, K, name);
      for (const pose of poses) samePose(pose);
      assert.deepEqual(
        [cameras.length, poses.length],
        { "open3d-intrinsic.json": [1, 0], "open3d-parameters.json": [1, 1], "open3d-trajectory.json": [2, 2] }[name],
      );
      assert.ok(poses.every(({ from, to }) => from === "world" && to === "camera"));
    }
    const log = (await readFixture("redwood.log")).poses;
    assert.equal(log.length, 2);
    samePose(log[0], ...inverse(), 1e-7);
  });

  test("numpy's text: 4x4, 3x4, K, with a size before it, with brackets", async () => {
    samePose(only((await readFixture("pose.txt")).poses));
    const rows = [0, 1, 2].map((i) => [...rotation.slice(3 * i, 3 * i + 3), translation[i]].join(" "));
    samePose(only((await read("Rt.txt", rows.join("\n"))).poses));
    sameCamera(only((await readFixture("K.txt")).cameras), K);
    const sized = only((await read("K.txt", "640 480\n518.5 0 325.5\n0 519.25 253.75\n0 0 1\n")).cameras);
    assert.deepEqual([sized.width, sized.height, sized.camera.fx], [640, 480, 518.5]);
    sameCamera(only((await read("K.txt", "[[518.5, 0., 325.5],\n [0., 519.25, 253.75],\n [0., 0., 1.]]")).cameras), K);
    assert.deepEqual(
      { ...only((await read("k.txt", "500 501 320 240 0.1 0.2 0 0 0\n")).cameras).camera },
      { fx: 500, fy: 501, cx: 320, cy: 240, distortion: [0.1, 0.2, 0, 0] },
    );
  });

  test("RealSense: intrinsics with their models, extrinsics column by column", async () => {
    const columns = [0, 3, 6, 1, 4, 7, 2, 5, 8].map((at) => rotation[at]);
    const file = (model, coeffs) =>
      JSON.stringify({
        color: { width: 640, height: 480, ppx: 325.5, ppy: 253.75, fx: 518.5, fy: 519.25, model, coeffs },
        depth: {
          intrinsics: {
            width: 848,
            height: 480,
            ppx: 420,
            ppy: 240,
            fx: 420,
            fy: 420,
            model: "Brown Conrady",
            coeffs: [0, 0, 0, 0, 0],
          },
        },
        extrinsics: { depth_to_color: { rotation: columns, translation } },
      });
    const { cameras, poses, warnings } = await read("rs.json", file("Inverse Brown Conrady", distortion));
    assert.deepEqual(
      cameras.map(({ name }) => name),
      ["color", "depth"],
    );
    sameCamera(cameras[0], K);
    assert.deepEqual([...cameras[0].camera.distortion], distortion);
    assert.ok(warnings.some(({ code, model }) => code === "lens-approximated" && model === "Inverse Brown Conrady"));
    samePose(only(poses));
    assert.deepEqual([poses[0].from, poses[0].to], ["depth", "color"]);
    assert.equal(
      (await read("rs.json", file("Kannala Brandt4", [0.1, 0.2, 0.3, 0.4, 0]))).cameras[0].camera.model,
      "fisheye",
    );
    assert.equal((await read("rs.json", file("Inverse Brown Conrady", [0, 0, 0, 0, 0]))).warnings.length, 0);
    const other = await read("rs.json", file("Ftheta", [1, 0, 0, 0, 0]));
    assert.ok(
      other.warnings.some(({ code, message }) => code === "camera-left-out" && /lens model "Ftheta"/.test(message)),
    );
  });

  test("RealSense's rs-enumerate-devices -c, whose rotations are printed row by row", async () => {
    const rows = [0, 1, 2].map((i) => `   ${rotation.slice(3 * i, 3 * i + 3).join("        ")}`).join("\n");
    const printed = `Intrinsic Parameters:\n\n Intrinsic of "Color" / 640x480 / {YUYV/RGB8}\n  Width:      \t640\n  Height:     \t480\n  PPX:        \t325.5\n  PPY:        \t253.75\n  Fx:         \t518.5\n  Fy:         \t519.25\n  Distortion: \tBrown Conrady\n  Coeffs:     \t${distortion.join("  \t")}  \n  FOV (deg):  \t63.4 x 49.6\n\nExtrinsic Parameters:\n\nExtrinsic from "Depth"\t  To\t  "Color" :\n Rotation Matrix:\n${rows}\n\n Translation Vector: ${translation.join("  ")}  \n\n`;
    const { cameras, poses } = await read("rs.txt", printed);
    sameCamera(only(cameras), K);
    assert.deepEqual(
      [cameras[0].name, cameras[0].width, ...cameras[0].camera.distortion],
      ["Color", 640, ...distortion],
    );
    samePose(only(poses));
    assert.deepEqual([poses[0].from, poses[0].to], ["Depth", "Color"]);
  });

  test("ORB-SLAM's settings, settings with equals signs, and members that name their camera", async () => {
    const slam = await read(
      "TUM1.yaml",
      "%YAML:1.0\n# comment\nCamera.fx: 518.5\nCamera.fy: 519.25\nCamera.cx: 325.5\nCamera.cy: 253.75\nCamera.k1: 0.2\nCamera.k2: -0.5\nCamera.p1: 0.001\nCamera.p2: -0.002\nCamera.k3: 0.3\nCamera.width: 640\nCamera.height: 480\nDepthMapFactor: 5000.0\n",
    );
    sameCamera(only(slam.cameras), K);
    assert.deepEqual([slam.cameras[0].width, ...slam.cameras[0].camera.distortion], [640, ...distortion]);
    sameCamera(only((await read("k.cfg", "fx = 518.5\nfy = 519.25\ncx = 325.5\ncy = 253.75\n")).cameras), K);
    const { cameras, poses } = await read(
      "rig.yaml",
      "K_rgb: [[518.5, 0, 325.5], [0, 519.25, 253.75], [0, 0, 1]]\nK_depth: [400, 0, 320, 0, 400, 240, 0, 0, 1]\nD_rgb: [0.2, -0.5, 0.001, -0.002, 0.3]\nR_depth_to_rgb: [[1, 0, 0], [0, 1, 0], [0, 0, 1]]\nT_depth_to_rgb: [0.1, 0, 0]\n",
    );
    assert.deepEqual(
      cameras.map(({ name, camera }) => [name, camera.distortion?.length]),
      [
        ["rgb", 5],
        ["depth", undefined],
      ],
    );
    assert.deepEqual([poses[0].from, poses[0].to], ["depth", "rgb"]);
  });

  test("YAML of all kinds: merged keys, keys after a question mark, anchors and folded texts", async () => {
    const merged =
      "base: &base {fx: 518.5, fy: 519.25}\ncameras:\n  - <<: *base\n    ? cx\n    : 325.5\n    cy: 253.75\n    notes: >-\n      of the\n      left one\n";
    sameCamera((await read("rig.yaml", merged)).cameras.at(-1), K);
  });

  test("COLMAP's cameras, whose pixels begin half a pixel earlier", async () => {
    const file = [
      "# comment",
      "1 PINHOLE 640 480 518.5 519.25 326 254.25",
      "2 SIMPLE_PINHOLE 640 480 500 320 240",
      "3 SIMPLE_RADIAL 640 480 500 320 240 0.1",
      "4 RADIAL 640 480 500 320 240 0.1 0.2",
      "5 OPENCV 640 480 500 501 320 240 0.1 0.2 0.3 0.4",
      "6 FULL_OPENCV 640 480 500 501 320 240 1 2 3 4 5 6 7 8",
      "7 OPENCV_FISHEYE 640 480 500 501 320 240 0.1 0.2 0.3 0.4",
    ];
    const { cameras } = await read("cameras.txt", file.join("\n"));
    sameCamera(cameras[0], K);
    assert.deepEqual(
      cameras.slice(1).map(({ camera: { fx, fy, cx, cy } }) => [fx, fy, cx, cy]),
      [
        [500, 500],
        [500, 500],
        [500, 500],
        [500, 501],
        [500, 501],
        [500, 501],
      ].map((focal) => [...focal, 319.5, 239.5]),
    );
    const lenses = cameras.map(({ camera }) => camera.distortion && [...camera.distortion]);
    assert.deepEqual(lenses, [
      undefined,
      undefined,
      [0.1, 0, 0, 0],
      [0.1, 0.2, 0, 0],
      [0.1, 0.2, 0.3, 0.4],
      [1, 2, 3, 4, 5, 6, 7, 8],
      [0.1, 0.2, 0.3, 0.4],
    ]);
    assert.equal(cameras[6].camera.model, "fisheye");
  });
});

describe("ROS's static transforms: from the child into the parent", () => {
  // Sine and cosine of half the fixtures' rotation vector: x y z w. The angles are about fixed axes, roll first.
  const quaternion = "0.009998417 -0.014997625 0.024996042 0.999525038";
  const [yaw, pitch, roll] = [
    Math.atan2(rotation[3], rotation[0]),
    Math.asin(-rotation[6]),
    Math.atan2(rotation[7], rotation[8]),
  ];
  const shift = translation.join(" ");
  const files = {
    "ROS 1, quaternion": `rosrun tf static_transform_publisher ${shift} ${quaternion} color depth 100`,
    "ROS 1, angles": `static_transform_publisher ${shift} ${yaw} ${pitch} ${roll} color depth`,
    "a launch file": `<launch>\n  <node pkg="tf2_ros" type="static_transform_publisher" name="x" args="${shift} ${quaternion} color depth"/>\n</launch>`,
    "ROS 2, flags": `ros2 run tf2_ros static_transform_publisher --x ${translation[0]} --y ${translation[1]} --z ${translation[2]} --qx 0.009998417 --qy -0.014997625 --qz 0.024996042 --qw 0.999525038 --frame-id color --child-frame-id depth`,
    "ROS 2, angles": `ros2 run tf2_ros static_transform_publisher --x ${translation[0]} --y ${translation[1]} --z ${translation[2]} --yaw ${yaw} --pitch ${pitch} --roll ${roll} --frame-id color --child-frame-id depth`,
    "a Python launch file": `Node(package='tf2_ros',\n  executable='static_transform_publisher',\n  arguments=[${[...translation, ...quaternion.split(" ")].map((word) => `'${word}'`).join(", ")}, 'color', 'depth'])`,
    "YAML of /tf_static": `transforms:\n- header:\n    frame_id: color\n  child_frame_id: depth\n  transform:\n    translation: {x: ${translation[0]}, y: ${translation[1]}, z: ${translation[2]}}\n    rotation: {x: 0.009998417, y: -0.014997625, z: 0.024996042, w: 0.999525038}\n`,
  };
  for (const [name, text] of Object.entries(files)) {
    test(name, async () => {
      const pose = only((await read("tf", text)).poses);
      samePose(pose, undefined, undefined, 1e-7);
      assert.deepEqual([pose.from, pose.to], ["depth", "color"]);
    });
  }
});

test("ROS's tf_echo", async () => {
  const printed = `At time 0.0\n- Translation: [${translation.join(", ")}]\n- Rotation: in Quaternion [0.009998420, -0.014997630, 0.024996049, 0.999525042]\n            in RPY (radian) [0.0, 0.0, 0.0]\n`;
  samePose(only((await read("tf.txt", printed)).poses), undefined, undefined, 1e-7);
});

describe("motions are checked", () => {
  const matrix = (r, t = [0, 0, 0]) => [0, 1, 2].map((i) => [...r.slice(3 * i, 3 * i + 3), t[i]].join(" ")).join("\n");

  test("one that is nearly a rotation is bent, one that is none or mirrors is refused", async () => {
    const bent = rotation.map((value, at) => value + (at === 0 ? 0.004 : 0));
    const { poses, warnings } = await read("T.txt", matrix(bent));
    assert.ok(warnings.some(({ code }) => code === "rotation-adjusted"));
    const r = poses[0].pose.rotation;
    for (let i = 0; i < 3; i++)
      for (let j = 0; j < 3; j++)
        close(
          [r[3 * i] * r[3 * j] + r[3 * i + 1] * r[3 * j + 1] + r[3 * i + 2] * r[3 * j + 2]],
          [i === j ? 1 : 0],
          1e-12,
        );
    await refusedFile(read("T.txt", matrix([1, 0.1, 0, 0, 1, 0, 0, 0, 1])), "T.txt", /R R\^T differs from 1/);
    await refusedFile(read("T.txt", matrix([1, 0, 0, 0, 1, 0, 0, 0, -1])), "T.txt", /mirrors/);
    const turned = await read("T.txt", "1 0 0 0\n0 1 0 0\n0 0 1 0\n0.1 0.2 0.3 1");
    assert.ok(turned.warnings.some(({ code, message }) => code === "rotation-order" && /transposed/.test(message)));
  });

  test("angles are those of R = Rx Ry Rz, also where two axes fall together", async () => {
    for (const {
      given: [alpha, beta, gamma],
      read: expected,
    } of [
      { given: [10, 20, 30], read: [10, 20, 30] },
      { given: [-170, 60, 5], read: [-170, 60, 5] },
      // At a pole only a sum or a difference is determined, and alpha is zero, as in a report (src/pose/angles.rs).
      { given: [30, 90, 0], read: [0, 90, 30] },
      { given: [30, -90, 10], read: [0, -90, -20] },
      { given: [0, 0, 0], read: [0, 0, 0] },
    ]) {
      const [a, b, c] = [alpha, beta, gamma].map((degrees) => (degrees * Math.PI) / 180);
      const [ca, sa, cb, sb, cc, sc] = [Math.cos(a), Math.sin(a), Math.cos(b), Math.sin(b), Math.cos(c), Math.sin(c)];
      const r = [
        cb * cc,
        -cb * sc,
        sb,
        ca * sc + sa * sb * cc,
        ca * cc - sa * sb * sc,
        -sa * cb,
        sa * sc - ca * sb * cc,
        sa * cc + ca * sb * sc,
        ca * cb,
      ];
      const { angles } = (await read("T.txt", matrix(r))).poses[0].pose;
      close([angles.alpha, angles.beta, angles.gamma], expected, 1e-6, `${alpha} ${beta} ${gamma}`);
    }
  });

  test("a shift longer than a rig is in millimetres", async () => {
    const { poses, warnings } = await read("T.txt", matrix(rotation, [-25, 1, 3]));
    close(poses[0].pose.translation, translation, 1e-12);
    assert.ok(warnings.some(({ code }) => code === "translation-unit-guessed"));
  });

  test("TUM's trajectory, and one shift with a quaternion", async () => {
    const line = `${translation.join(" ")} 0.009998417 -0.014997625 0.024996042 0.999525038`;
    const { poses } = await read("groundtruth.txt", `# timestamp tx ty tz qx qy qz qw\n1.5 ${line}\n2.5 ${line}\n`);
    assert.deepEqual(
      poses.map(({ name, from, to }) => [name, from, to]),
      [
        ["1.5", "camera", "world"],
        ["2.5", "camera", "world"],
      ],
    );
    samePose(poses[0], undefined, undefined, 1e-7);
    samePose(only((await read("T.txt", line)).poses), undefined, undefined, 1e-7);
  });
});

test("frames are told from names", async () => {
  const named = async (key) => {
    const { poses } = await read(
      "x.json",
      JSON.stringify({
        [key]: [
          [1, 0, 0, 0],
          [0, 1, 0, 0],
          [0, 0, 1, 0],
          [0, 0, 0, 1],
        ],
      }),
    );
    return [poses[0].from, poses[0].to];
  };
  assert.deepEqual(await named("depth_to_color"), ["depth", "color"]);
  assert.deepEqual(await named("depth2color"), ["depth", "color"]);
  assert.deepEqual(await named("color_from_depth"), ["depth", "color"]);
  assert.deepEqual(await named("T_color_depth"), ["depth", "color"]);
});

test("odd cameras are warned of", async () => {
  const warned = async (camera, expected, words = /./) => {
    const { warnings } = await read("k.json", JSON.stringify(camera));
    assert.ok(
      warnings.some(({ code, message }) => code === expected && words.test(message)),
      JSON.stringify(warnings),
    );
  };
  await warned({ fx: 0.9, fy: 0.9, cx: 0.5, cy: 0.5 }, "focal-length-normalised");
  await warned({ fx: 500, fy: 500, cx: 900, cy: 240, width: 640, height: 480 }, "principal-point");
  // A message rounds a file's sixteen digits.
  await warned(
    { fx: 500, fy: 500, cx: 651.1648988223807, cy: 507.4723326680093, width: 640, height: 480 },
    "principal-point",
    /\(651\.16, 507\.47 of 640x480\)/,
  );
  await warned(
    {
      K: [
        [500, 3, 320],
        [0, 500, 240],
        [0, 0, 1],
      ],
    },
    "skew-ignored",
  );
  await warned({ fx: 500, fy: 300, cx: 320, cy: 240 }, "pixels-not-square");
});

test("a camera by its field of view", () => {
  const { fx, fy, cx, cy } = cameraFromFieldOfView(640, 480, 90);
  close([fx, fy, cx, cy], [320, 320, 319.5, 239.5], 1e-9);
  assert.throws(() => cameraFromFieldOfView(640, 480, 180), { code: "range", field: "degrees" });
  assert.throws(() => cameraFromFieldOfView(0, 480, 90), { code: "size" });
});
