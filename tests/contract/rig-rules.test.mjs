// The rules for reading calibrations of any program: parts that belong together, numbers that can be read in two ways, and parts that are
// left over.
import assert from "node:assert/strict";
import { describe, test } from "node:test";
import {
  K,
  angles,
  close,
  codes,
  columns,
  distortion,
  intrinsicRows,
  json,
  matrix,
  only,
  quaternion,
  read,
  readFixture,
  refusedFile,
  rotation,
  rows,
  sameCamera,
  samePose,
  translation,
} from "./rig-support.mjs";

const wFirst = [quaternion[3], ...quaternion.slice(0, 3)];
/** Roll, pitch and yaw about fixed axes, degrees. */
const degrees = angles.map((angle) => (angle * 180) / Math.PI);
const others = { fx: 400, fy: 401, cx: 320, cy: 240 };
const members = { k1: 0.2, k2: -0.5, p1: 0.001, p2: -0.002, k3: 0.3 };

describe("lenses and sizes beside their cameras", () => {
  test("camodocal's parameters in groups of their own", async () => {
    const { cameras, warnings } = await read(
      "cam.yaml",
      "%YAML:1.0\n---\nmodel_type: PINHOLE\nimage_width: 640\nimage_height: 480\ndistortion_parameters:\n   k1: 0.2\n   k2: -0.5\n   p1: 0.001\n   p2: -0.002\nprojection_parameters:\n   fx: 518.5\n   fy: 519.25\n   cx: 325.5\n   cy: 253.75\n",
    );
    sameCamera(only(cameras), distortion.slice(0, 4));
    assert.deepEqual([cameras[0].width, cameras[0].height, warnings], [640, 480, []]);
  });

  test("camodocal's Kannala-Brandt and MEI cameras", async () => {
    const kannala =
      "model_type: KANNALA_BRANDT\nimage_width: 640\nimage_height: 480\nprojection_parameters: {k2: 0.1, k3: 0.2, k4: 0.3, k5: 0.4, mu: 518.5, mv: 519.25, u0: 325.5, v0: 253.75}\n";
    const { camera } = only((await read("cam.yaml", kannala)).cameras);
    assert.deepEqual([camera.model, camera.fx, ...camera.distortion], ["fisheye", 518.5, 0.1, 0.2, 0.3, 0.4]);
    const mei =
      "model_type: MEI\nmirror_parameters: {xi: 1.9}\nprojection_parameters: {gamma1: 700, gamma2: 700, u0: 370, v0: 240}\n";
    await refusedFile(read("mei.yaml", mei), "mei.yaml", /model "MEI"/);
  });

  test("by the same label, in objects and in sections", async () => {
    const found = await json({
      rgbIntrinsic: { ...K, width: 640, height: 480 },
      depthIntrinsic: { ...others, width: 512, height: 424 },
      depthDistortion: { k1: 0, k2: 0, p1: 0, p2: 0 },
      rgbDistortion: members,
    });
    sameCamera(found.cameras[0]);
    sameCamera(found.cameras[1], null, others);
    assert.deepEqual(codes(found), []);
    const lists = await json({
      intrinsics: { color: K, depth: others },
      distortion: { depth: [0.1, 0.2, 0, 0], color: distortion },
      image_size: { color: [1280, 720], depth: [640, 480] },
    });
    sameCamera(lists.cameras[0]);
    sameCamera(lists.cameras[1], [0.1, 0.2, 0, 0], others);
    assert.deepEqual(
      lists.cameras.map(({ width }) => width),
      [1280, 640],
    );
  });

  test("a lens of its own model, and lists of radial and tangential coefficients", async () => {
    const fisheye = await json({
      camera: { ...K, distortion: { model: "equidistant", coefficients: [0.1, 0.2, 0.3, 0.4] } },
    });
    assert.equal(only(fisheye.cameras).camera.model, "fisheye");
    const parts = await json({
      K: intrinsicRows,
      distortion_parameters: { radial: [0.2, -0.5, 0.3], tangential: [0.001, -0.002] },
    });
    sameCamera(only(parts.cameras));
    const three = await json({ ...K, distortion: [0.2, -0.5, 0.3] });
    sameCamera(only(three.cameras), [0.2, -0.5, 0, 0, 0.3]);
    assert.deepEqual(codes(three), ["distortion-guessed"]);
  });

  test("multical's models and reference camera, OpenCalib's nested rows", async () => {
    const camera = (k) => ({
      ...{ model: "standard", image_size: [640, 480], dist: [distortion] },
      K: [
        [k.fx, 0, k.cx],
        [0, k.fy, k.cy],
        [0, 0, 1],
      ],
    });
    const still = {
      R: [
        [1, 0, 0],
        [0, 1, 0],
        [0, 0, 1],
      ],
      T: [0, 0, 0],
    };
    const found = await json({
      cameras: { color: camera(K), depth: camera(others) },
      camera_poses: { color: still, depth_to_color: { R: rows, T: translation } },
    });
    sameCamera(found.cameras[0]);
    samePose(only(found.poses));
    assert.deepEqual([found.poses[0].from, found.poses[0].to], ["depth", "color"]);
    const param = {
      ...{ img_dist_w: 640, img_dist_h: 480, cam_dist: { rows: 1, cols: 5, type: 6, data: [distortion] } },
      cam_K: { rows: 3, cols: 3, type: 6, data: camera(K).K },
    };
    const { cameras } = await json({ "front-intrinsic": { sensor_name: "front", param } });
    sameCamera(only(cameras));
    assert.deepEqual([cameras[0].name, cameras[0].width], ["front-intrinsic", 640]);
    const sensors = { sensor_name: "top_lidar", target_sensor_name: "front" };
    const pose = only(
      (await json({ e: { ...sensors, param: { sensor_calib: { rows: 4, cols: 4, data: matrix } } } })).poses,
    );
    samePose(pose);
    assert.deepEqual([pose.from, pose.to], ["top_lidar", "front"]);
  });

  test("what nobody can place is not used, and said", async () => {
    const two = await json({ rgb: K, depth: others, distortion });
    assert.deepEqual(codes(two), ["distortion-unused"]);
    assert.ok(two.cameras.every(({ camera }) => camera.distortion === undefined));
    const sizes = await json({
      rgb: K,
      view_a: { size: [640, 480] },
      view_b: { size: [320, 240] },
    });
    assert.deepEqual(codes(sizes), ["size-unused"]);
    const boards = await json({ ...K, rvecs: [[0.1, 0.2, 0.3]], tvecs: [[1, 2, 3]] });
    assert.deepEqual(
      boards.warnings.map(({ code, name, isDoubt }) => [code, name, isDoubt]),
      [
        ["pose-left-out", "rvecs", false],
        ["pose-left-out", "tvecs", false],
      ],
    );
  });

  test("vikit's prefix, numbered coefficients, and names behind an underscore", async () => {
    const vikit =
      "cam_model: Pinhole\ncam_width: 640\ncam_height: 480\ncam_fx: 518.5\ncam_fy: 519.25\ncam_cx: 325.5\ncam_cy: 253.75\ncam_d0: 0.2\ncam_d1: -0.5\ncam_d2: 0.001\ncam_d3: -0.002\n";
    const found = await read("cam.yaml", vikit);
    sameCamera(only(found.cameras), distortion.slice(0, 4));
    assert.deepEqual([found.cameras[0].width, codes(found)], [640, []]);
    await refusedFile(
      read("cam.yaml", "cam_model: ATAN\ncam_fx: 0.7\ncam_fy: 1.1\ncam_cx: 0.5\ncam_cy: 0.5\ncam_d0: 0.9\n"),
      "cam.yaml",
      /lens model "ATAN"/,
    );
    const script =
      "fx_rgb = 518.5;\nfy_rgb = 519.25;\ncx_rgb = 325.5;\ncy_rgb = 253.75;\nk1_rgb = 0.2;\nk2_rgb = -0.5;\np1_rgb = 0.001;\np2_rgb = -0.002;\nk3_rgb = 0.3;\nfx_d = 400;\nfy_d = 401;\ncx_d = 320;\ncy_d = 240;\n";
    const { cameras } = await read("camera_params.m", script);
    sameCamera(cameras[0]);
    assert.deepEqual(
      cameras.map(({ name }) => name),
      ["rgb", "d"],
    );
  });

  test("Orbbec's sections, in millimetres", async () => {
    const section = (name, values) =>
      `[${name}]\n${Object.entries(values)
        .map(([key, value]) => `${key}=${value}\n`)
        .join("")}`;
    const turn = Object.fromEntries(rotation.map((value, at) => [`rot${at}`, value]));
    const shift = Object.fromEntries([-9, 0.5, 0.25].map((value, at) => [`trans${at}`, value]));
    const text =
      section("ColorIntrinsic", { ...K, width: 640, height: 480 }) +
      section("DepthIntrinsic", { ...others, width: 640, height: 576 }) +
      section("ColorDistortion", members) +
      section("D2CTransformParam", { ...turn, ...shift });
    const { cameras, poses, warnings } = await read("CameraParam.ini", text);
    sameCamera(cameras[0]);
    samePose(only(poses), rotation, [-0.009, 0.0005, 0.00025]);
    assert.deepEqual([poses[0].from, poses[0].to, warnings], ["depth", "color", []]);
  });
});

describe("rotations that can be read in two ways", () => {
  const pose = (turn) => ({ depth_to_color: { translation, ...turn } });

  test("quaternions: the order that is named, or else the one that makes a rig", async () => {
    for (const turn of [{ quaternion_wxyz: wFirst }, { q_xyzw: quaternion }, { rotation: quaternion }]) {
      const found = await json(pose(turn));
      samePose(only(found.poses));
      assert.deepEqual(codes(found), []);
    }
    const guessed = await json(pose({ rotation: wFirst }));
    samePose(only(guessed.poses));
    assert.deepEqual(
      guessed.warnings.map(({ code, order, isDoubt }) => [code, order, isDoubt]),
      [["quaternion-order", "wxyz", true]],
    );
    const aside = await json(pose({ rotation: [0.5, -0.5, 0.5, -0.5] }));
    assert.deepEqual(
      aside.warnings.map(({ code, order }) => [code, order]),
      [["quaternion-order", "xyzw"]],
    );
    const said = await read("x.yaml", `translation: [0, 0, 0]\nrotation: [0.5, 0.5, -0.5, 0.5] # w x y z\n`);
    close(only(said.poses).pose.rotation, [0, -1, 0, 0, 0, -1, 1, 0, 0], 1e-9);
    assert.deepEqual(codes(said), []);
  });

  test("a row of numbers, and a header that says the order", async () => {
    const line = [...translation, ...wFirst].join(" ");
    const row = await read("T.txt", line);
    samePose(only(row.poses));
    assert.deepEqual(codes(row), ["quaternion-order"]);
    samePose(only((await read("T.txt", `# tx ty tz qw qx qy qz\n${line}\n`)).poses));
  });

  test("three numbers: vectors, degrees and radians", async () => {
    const vector = [0.02, -0.03, 0.05];
    const named = await json({ depth_to_color: { rvec: vector, tvec: translation } });
    samePose(only(named.poses));
    assert.deepEqual(codes(named), []);
    const cases = [
      [{ rotation: degrees }, "euler-degrees"],
      [{ rotation_deg: degrees }, "euler-degrees"],
      [{ rpy: angles }, "euler-radians"],
      [{ rotation: vector }, "vector"],
    ];
    for (const [turn, as] of cases) {
      const found = await json(pose(turn));
      samePose(only(found.poses));
      assert.deepEqual(
        found.warnings.map(({ code, as }) => [code, as]),
        [["rotation-guessed", as]],
      );
    }
    // Right angles in radians swap axes; read as degrees they would also make a plausible rig.
    const axes = await json(pose({ rpy: [-1.59, 0.01, -1.55] }));
    assert.equal(axes.warnings[0].as, "euler-radians");
    const long = await json({ depth_to_color: { rvec: [1.2, -1.7, 2.9], tvec: translation } });
    assert.match(long.warnings[0].message, /more than pi/);
  });

  test("tables of angles, and of poses in time", async () => {
    const table = await read("c.csv", `roll,pitch,yaw,x,y,z\n${[...degrees, ...translation].join(",")}\n`);
    samePose(only(table.poses));
    assert.deepEqual(codes(table), ["rotation-guessed"]);
    const row = ["1.5", ...translation, ...quaternion].join(",");
    const series = await read("t.csv", `timestamp,x,y,z,qx,qy,qz,qw\n${row}\n${row}\n`);
    assert.deepEqual(
      series.poses.map(({ from, to }) => [from, to]),
      [
        ["camera", "world"],
        ["camera", "world"],
      ],
    );
  });

  test("rows or columns where members are called as librealsense calls them", async () => {
    const other = await json(pose({ rotation }));
    samePose(only(other.poses));
    assert.deepEqual(
      other.warnings.map(({ code, order }) => [code, order]),
      [["rotation-order", "rows"]],
    );
    assert.deepEqual(codes(await json(pose({ rotation: rows }))), ["rotation-order"]);
    const realsense = await json({
      ...pose({ rotation: columns }),
      color: { ppx: 1, model: "Brown Conrady" },
    });
    samePose(only(realsense.poses));
    assert.deepEqual(codes(realsense), []);
    const message = await read("e.yaml", `rotation: [${columns}]\ntranslation: [${translation}]\n`);
    samePose(only(message.poses));
    assert.deepEqual(codes(message), ["rotation-order"]);
    const everybody = await json({ depth_to_color: { R: rows, t: translation } });
    samePose(only(everybody.poses));
    assert.deepEqual(codes(everybody), []);
  });

  test("the way back in the same file tells rows from columns", async () => {
    const back = [0, 1, 2].map(
      (i) => -(rotation[i] * translation[0] + rotation[3 + i] * translation[1] + rotation[6 + i] * translation[2]),
    );
    const found = await json({
      depth_to_color: { rotation: columns, translation },
      color_to_depth: { rotation, translation: back },
    });
    samePose(found.poses[0]);
    samePose(found.poses[1], columns, back);
    assert.deepEqual(codes(found), []);
  });

  test("twelve numbers in a list", async () => {
    samePose(only((await json({ depth2color: matrix.slice(0, 3).flat() })).poses));
    const behind = await json({ depth2color: [...columns, ...translation] });
    samePose(only(behind.poses));
    assert.deepEqual(codes(behind), ["rotation-order"]);
  });

  test("units that stand in a file, and centimetres between the cameras of one device", async () => {
    const t = translation.map((value) => value * 1000);
    for (const value of [
      { depth_to_color: { R: rows, translation_mm: t } },
      { units: "mm", depth_to_color: { R: rows, t } },
    ]) {
      const found = await json(value);
      samePose(only(found.poses));
      assert.deepEqual(codes(found), []);
    }
    const far = translation.map((value) => value * 200);
    const centimetres = await json({ depth_to_color: { R: rows, t: far } });
    samePose(
      only(centimetres.poses),
      rotation,
      translation.map((value) => value * 2),
    );
    assert.deepEqual(codes(centimetres), ["translation-unit-guessed"]);
    samePose(only((await json({ lidar_to_camera: { R: rows, t: far } })).poses), rotation, far);
  });
});

describe("poses in the world are no extrinsics", () => {
  const world = async (value) => {
    const found = await json(value);
    assert.ok(found.poses.length > 0);
    for (const { from, to } of found.poses) assert.deepEqual([from, to], ["camera", "world"]);
    return codes(found);
  };

  test("ARKit, Blender, NeRF and lists of poses", async () => {
    for (const value of [
      { cameraPoseARFrame: matrix.flat(), projectionMatrix: [1.5, 0, 0, 0, 0, 2, 0, 0, 0, 0, -1, 0, 0, 0, -1, 0] },
      { trackingState: "normal", transform: { columns: [0, 1, 2, 3].map((i) => matrix.map((row) => row[i])) } },
      { camera: { matrix_world: matrix } },
      { c2w: matrix },
      { poses: [matrix, matrix, matrix] },
      [1, 2, 3].map((x) => ({ position: { x, y: 0, z: 0 }, heading: { w: 1, x: 0, y: 0, z: 0 } })),
    ])
      assert.deepEqual(await world(value), ["camera-to-world"], JSON.stringify(value));
    await world({ frames: [{ file_path: "a.png", transform_matrix: matrix }] });
    const back = await json({ world_to_camera: matrix });
    assert.deepEqual([back.poses[0].from, back.poses[0].to], ["camera", "world"]);
    close(back.poses[0].pose.rotation, columns, 1e-9);
  });

  test("columns of simd are turned into rows", async () => {
    const { poses } = await json({
      transform: { columns: [0, 1, 2, 3].map((i) => matrix.map((row) => row[i])) },
    });
    samePose(only(poses));
  });

  test("Blender's camera in millimetres", async () => {
    const found = await json({
      camera: { focal_length_mm: 35, sensor_width_mm: 36, resolution: [720, 480] },
    });
    const { camera, width } = only(found.cameras);
    assert.deepEqual([camera.fx, camera.fy, camera.cx, camera.cy, width], [700, 700, 359.5, 239.5, 720]);
    assert.deepEqual(codes(found), ["camera-computed"]);
  });

  test("rows of matrices and of poses", async () => {
    const lines = `${matrix.slice(0, 3).flat().join(" ")}\n`.repeat(3);
    const { poses } = await read("poses.txt", lines);
    assert.deepEqual(
      poses.map(({ from, to }) => [from, to]),
      Array(3).fill(["camera", "world"]),
    );
  });
});

test("frames by letters and by the names of LiDAR-inertial tools", async () => {
  const ends = async (text) => (await read("x.yaml", text)).poses.map(({ from, to }) => [from, to]);
  const r = `[${rotation}]`;
  assert.deepEqual(
    await ends(
      `lid_topic: /livox\nimu_topic: /imu\nextrinsic_R: ${r}\nextrinsic_T: [0, 0, 0]\nRcl: ${r}\nPcl: [0, 0, 0]\n`,
    ),
    [
      ["lidar", "imu"],
      ["lidar", "camera"],
    ],
  );
  assert.deepEqual(await ends(`imu_topic: /imu\nbody_T_cam0: [${matrix.flat()}]\n`), [["cam0", "body"]]);
  assert.deepEqual(await ends(`T_SC: [${matrix.flat()}]\n`), [["camera", "imu"]]);
});

test("OpenCV's vectors need no guess", async () => {
  assert.deepEqual(codes(await readFixture("stereo-vector.xml")), []);
});
