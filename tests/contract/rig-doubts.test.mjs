// Files that are ambiguous or misleading: comments, positions of cameras in bodies and worlds, lenses without a model.
import assert from "node:assert/strict";
import { spawnSync } from "node:child_process";
import { mkdtempSync, rmSync, writeFileSync } from "node:fs";
import { tmpdir } from "node:os";
import { join } from "node:path";
import { after, describe, test } from "node:test";
import { readRigFolder } from "../../pkg/rig.js";
import { inRoot } from "../../scripts/shell.mjs";
import {
  K,
  close,
  codes,
  columns,
  ends,
  intrinsicRows,
  json,
  lens,
  matrix,
  only,
  read,
  refusedFile,
  rotation,
  rows,
  samePose,
  translation,
} from "./rig-support.mjs";
import { png } from "./support.mjs";

const doubts = ({ warnings }) => warnings.filter(({ isDoubt }) => isDoubt).map(({ code }) => code);
const numbersOf = (m) => m.map((row) => row.join(" ")).join("\n");
const inverse = {
  rotation: columns,
  translation: [0, 1, 2].map(
    (i) => -columns.slice(3 * i, 3 * i + 3).reduce((sum, r, j) => sum + r * translation[j], 0),
  ),
};

describe("static transforms of ROS", () => {
  const node = (numbers, more = "") =>
    `<node ${more} pkg="tf2_ros" type="static_transform_publisher" name="a" args="${numbers} lidar camera"/>`;

  test("comments are not read", async () => {
    const launch = `<launch><!-- ${node("9 9 9 0 0 0")} -->${node("0.1 0.2 0.3 0 0 0")}</launch>`;
    const shell =
      "#rosrun tf static_transform_publisher 9 9 9 0 0 0 lidar camera 100\nrosrun tf static_transform_publisher 0.1 0.2 0.3 0 0 0 lidar camera 100 # 1\n";
    const python =
      "Node(executable='static_transform_publisher',\n  # arguments=['9','9','9','0','0','0','lidar','camera'],\n  arguments=['0.1','0.2','0.3','0','0','0','lidar','camera'])\n";
    for (const [name, content] of [
      ["tf.launch", launch],
      ["tf.sh", shell],
      ["tf.launch.py", python],
    ]) {
      const found = await read(name, content);
      const pose = only(found.poses);
      assert.deepEqual([ends(pose), codes(found)], [["camera", "lidar"], []], name);
      close(pose.pose.translation, [0.1, 0.2, 0.3], 1e-12, name);
    }
    const alone = `<launch><!--\n${node("9 9 9 0 0 0")}\n--></launch>`;
    await refusedFile(read("tf.launch", alone), "tf.launch", /only in comments/);
  });

  test("conditions, and several transforms between the same frames, are doubts", async () => {
    const either = `<launch>${node("1 0 0 0 0 0", 'if="$(arg sim)"')}${node("2 0 0 0 0 0", 'unless="$(arg sim)"')}</launch>`;
    assert.deepEqual(doubts(await read("tf.launch", either)), ["pose-assumed"]);
    const twice = `<launch>${node("1 0 0 0 0 0")}${node("2 0 0 0 0 0")}</launch>`;
    assert.match(only((await read("tf.launch", twice)).warnings).message, /several transforms from camera to lidar/);
  });

  test("numbers that ROS computes are refused by their name, names of frames are not", async () => {
    const ofArgument = `<launch>${node("$(arg x) 0 0 0 0 0")}</launch>`;
    await refusedFile(read("tf.launch", ofArgument), "tf.launch", /\$\(arg x\).*tf_echo/);
    await refusedFile(
      read("tf.launch", `<launch>${node("0 0 0 $(eval pi) 0 0")}</launch>`),
      "tf.launch",
      /\$\(eval pi\)/,
    );
    const frames = `<launch><node type="static_transform_publisher" args="1 2 3 0 0 0 $(arg ns)_lidar $(arg ns)_cam"/></launch>`;
    assert.deepEqual(ends(only((await read("tf.launch", frames)).poses)), ["ns_cam", "ns_lidar"]);
  });
});

describe("places of a camera in a body or in the world", () => {
  const folder = mkdtempSync(join(tmpdir(), "rig-doubts-"));
  after(() => rmSync(folder, { recursive: true, force: true }));
  const check = (name, content) => {
    writeFileSync(join(folder, name), content);
    return spawnSync(process.execPath, [inRoot("pkg/cli.js"), "check", folder, "--calibration", join(folder, name)], {
      encoding: "utf8",
    });
  };
  const opencv = (key, m) =>
    `${key}: !!opencv-matrix\n   rows: 4\n   cols: 4\n   dt: f\n   data: [${m.flat().join(", ")}]\n`;

  test("ORB-SLAM's pose of the camera in the inertial unit is given once, with its frames", async () => {
    const found = await read(
      "d435i.yaml",
      `%YAML:1.0\n---\nCamera1.fx: 500\nCamera1.fy: 500\nCamera1.cx: 320\nCamera1.cy: 240\n${opencv("IMU.T_b_c1", matrix)}`,
    );
    assert.deepEqual(ends(only(found.poses)), ["c1", "b"]);
    samePose(found.poses[0]);
  });

  test("RTAB-Map's local transform is in the robot's base", async () => {
    const values = matrix.slice(0, 3).flat().join(", ");
    const found = await read("cam.yaml", `local_transform:\n  rows: 3\n  cols: 4\n  data: [${values}]\n`);
    assert.deepEqual(ends(only(found.poses)), ["camera", "base"]);
  });

  test("the check says what such a file is", () => {
    for (const [name, content] of [
      ["vins.yaml", `%YAML:1.0\n---\n${opencv("body_T_cam0", matrix)}`],
      ["kimera.yaml", `T_BS:\n  rows: 4\n  cols: 4\n  data: [${matrix.flat().join(", ")}]\n`],
      ["orb.yaml", `%YAML:1.0\n---\n${opencv("IMU.T_b_c1", matrix)}`],
    ]) {
      const { status, stderr } = check(name, content);
      assert.equal(status, 3, stderr);
      assert.match(stderr, /is not a sensor of the pictures .*depth_to_color\.txt/s);
    }
    const { status, stderr } = check("c2w.txt", numbersOf(matrix));
    assert.equal(status, 3);
    assert.match(stderr, /camera in the world/);
  });

  test("two sensors in one body are related", () => {
    const lidar = `lidar_to_imu: ${JSON.stringify(matrix)}\ncamera_to_imu: ${JSON.stringify(matrix)}\n`;
    // The calibration is read, and the folder has no frames.
    assert.match(check("both.yaml", lidar).stderr, /no pair|no readable pair/);
  });

  test("files of a matrix that are called as places in the world", async () => {
    for (const name of [
      "c2w.txt",
      "cam2world.txt",
      "T_wc.txt",
      "T_world_camera.txt",
      "camera_pose.txt",
      "pose.txt",
      "frame-000000.pose.txt",
      "c2w/0.txt",
      "poses/12.txt",
    ]) {
      const found = await read(name, numbersOf(matrix));
      assert.deepEqual([ends(only(found.poses)), codes(found)], [["camera", "world"], ["camera-to-world"]], name);
      samePose(found.poses[0]);
    }
    for (const name of ["w2c.txt", "world2cam.txt", "T_cw.txt"]) {
      const found = await read(name, numbersOf(matrix));
      assert.deepEqual(ends(only(found.poses)), ["camera", "world"], name);
      samePose(found.poses[0], inverse.rotation, inverse.translation);
    }
    for (const name of ["extrinsics.txt", "depth_to_color.txt", "stereo_pose.txt", "Rt.txt"]) {
      const found = await read(name, numbersOf(matrix));
      assert.deepEqual([ends(only(found.poses)), codes(found)], [[undefined, undefined], []], name);
    }
  });

  test("poses that are called as pictures, and view matrices, are of the world", async () => {
    const scan = `scan a_d0.png a_i0.jpg ${matrix.flat().join(" ")}\n`;
    const conf = await read("scan.conf", `intrinsics_matrix 500 0 320  0 500 240  0 0 1\n${scan}`);
    assert.deepEqual(ends(only(conf.poses)), ["camera", "world"]);
    const isaac = await json({ cameraViewTransform: matrix });
    assert.deepEqual(ends(only(isaac.poses)), ["camera", "world"]);
    samePose(isaac.poses[0], inverse.rotation, inverse.translation);
  });
});

describe("poses in a folder", () => {
  const colour = png({ width: 2, height: 1, depth: 8, colourType: 2, rows: [[90, 2, 3, 90, 2, 3]] });
  const depth = png({ width: 2, height: 1, depth: 16, colourType: 0, rows: [[4, 176, 4, 177]] });
  const folder = (more) =>
    readRigFolder(
      Object.entries({ "0_color.png": colour, "0_depth.png": depth, ...more }).map(([name, bytes]) => ({
        name,
        bytes: typeof bytes === "string" ? new TextEncoder().encode(bytes) : bytes,
      })),
      { unit: 0.001 },
    );

  test("a pose that is called as the frame is a doubt", async () => {
    const found = await folder({ "0.txt": numbersOf(matrix) });
    assert.ok(doubts(found).includes("pose-assumed"), JSON.stringify(found.warnings));
    assert.ok(!codes(await folder({ "depth_to_color.txt": numbersOf(matrix) })).includes("pose-assumed"));
  });

  test("the place of a camera in a body is left out", async () => {
    const found = await folder({
      "vins.yaml": JSON.stringify({ body_T_cam0: matrix }),
      "extrinsics.txt": numbersOf(matrix),
    });
    assert.equal(only(found.poses).name, undefined);
    assert.ok(codes(found).includes("pose-left-out"));
  });

  test("the scale of Replica's camera is the unit of its depth maps", async () => {
    const camera = JSON.stringify({ camera: { w: 2, h: 1, fx: 5, fy: 5, cx: 1, cy: 0.5, scale: 6553.5 } });
    const files = { "0_color.png": colour, "0_depth.png": depth, "cam_params.json": new TextEncoder().encode(camera) };
    const found = await readRigFolder(Object.entries(files).map(([name, bytes]) => ({ name, bytes })));
    close([found.frames[0].depth.unit], [1 / 6553.5], 1e-12);
  });
});

describe("frames of a matrix", () => {
  test("by pairs of names", async () => {
    for (const [to, from] of [
      ["parent", "child"],
      ["parent_link", "child_link"],
      ["parent_frame", "child_frame"],
      ["reference", "sensor"],
      ["base", "frame"],
    ]) {
      const found = await json({ [to]: "lidar", [from]: "camera", matrix });
      assert.deepEqual(ends(only(found.poses)), ["camera", "lidar"], to);
    }
    assert.deepEqual(ends(only((await json({ T_10: matrix })).poses)), ["cam0", "cam1"]);
  });

  test("without them, a LiDAR's pose is read as the one of an upright camera, with a doubt", async () => {
    // Rows of a camera that looks along x of a LiDAR with z up, turned a little.
    const upright = [0, -1, 0, 0, 0, -1, 1, 0, 0];
    const turned = [0, 1, 2].flatMap((i) =>
      [0, 1, 2].map((j) => [0, 1, 2].reduce((sum, k) => sum + rotation[3 * i + k] * upright[3 * k + j], 0)),
    );
    const back = [0, 3, 6, 1, 4, 7, 2, 5, 8].map((at) => turned[at]);
    const four = (r) => [0, 1, 2].map((i) => [...r.slice(3 * i, 3 * i + 3), 0]).concat([[0, 0, 0, 1]]);
    const key = "ouster-pylon_transform";
    const usual = await json({ [key]: four(turned) });
    samePose(only(usual.poses), turned, [0, 0, 0]);
    const other = await json({ [key]: four(back) });
    samePose(only(other.poses), turned, [0, 0, 0]);
    assert.deepEqual([ends(other.poses[0]), doubts(other).includes("pose-assumed")], [["lidar", "camera"], true]);
    // Both cameras look in the same direction, whichever way the pose leads.
    samePose(only((await json({ "ouster-pylon_transform": matrix })).poses));
  });

  test("several poses without frames are a doubt", async () => {
    const found = await json({ first_transform: matrix, second_transform: matrix });
    assert.deepEqual([found.poses.length, doubts(found)], [2, ["pose-assumed"]]);
  });
});

describe("lenses", () => {
  const four = [-0.0123, 0.0456, -0.0389, 0.0071];
  const column = four.map((value) => [value]);

  test("four coefficients without a model are a doubt", async () => {
    const found = await json({ K: intrinsicRows, D: column });
    assert.deepEqual([lens(only(found.cameras)), doubts(found)], [["brown", ...four], ["distortion-guessed"]]);
    const known = await json({ K: intrinsicRows, D: column, distortion_model: "plumb_bob" });
    assert.deepEqual([lens(only(known.cameras)), codes(known)], [["brown", ...four], []]);
  });

  test("of a fisheye where the file, its name or a flag says so", async () => {
    for (const found of [
      await json({ K: intrinsicRows, D: column }, "fisheye_left.json"),
      await json({ comment: "by cv2.fisheye.calibrate", K: intrinsicRows, D: column }),
    ])
      assert.deepEqual([lens(only(found.cameras)), doubts(found)], [["fisheye", ...four], ["distortion-guessed"]]);
    for (const flag of ["fisheye", "is_fisheye", "isFisheye", "use_fisheye"]) {
      const found = await json({ K: intrinsicRows, D: four, [flag]: true });
      assert.deepEqual([lens(only(found.cameras)), codes(found)], [["fisheye", ...four], []], flag);
    }
    const denied = await json({ K: intrinsicRows, D: four, is_fisheye: false });
    assert.deepEqual(lens(only(denied.cameras)), ["brown", ...four]);
  });

  test("plain coefficients belong to the only camera with a prefix", async () => {
    const cam = "cam_model: EquidistantCamera\ncam_fx: 350\ncam_fy: 351\ncam_cx: 319\ncam_cy: 249\n";
    const found = await read("cam.yaml", `${cam}k1: -0.0123\nk2: 0.0456\nk3: -0.0389\nk4: 0.0071\n`);
    assert.deepEqual([lens(only(found.cameras)), codes(found)], [["fisheye", ...four], []]);
    assert.deepEqual(doubts(await read("cam.yaml", cam)), ["distortion-guessed"]);
  });

  test("models of nerfstudio that are not supported are left out by name", async () => {
    const all = { fl_x: 500, fl_y: 500, cx: 320, cy: 240, w: 640, h: 480, k1: 0.1, k2: 0.01 };
    const frames = [{ file_path: "1.png", transform_matrix: matrix }];
    for (const camera_model of ["EQUIRECTANGULAR", "ORTHOPHOTO", "THIN_PRISM_FISHEYE", "FISHEYE624"]) {
      const { poses, warnings } = await json({ ...all, camera_model, frames });
      const left = warnings.find(({ code }) => code === "camera-left-out");
      assert.equal(poses.length, 1);
      assert.ok(left?.isDoubt && left.message.includes(camera_model), camera_model);
    }
    const fisheye = await json({ ...all, is_fisheye: true, k3: 0.2, k4: 0.3, frames });
    assert.deepEqual(lens(only(fisheye.cameras)), ["fisheye", 0.1, 0.01, 0.2, 0.3]);
  });

  test("the lens of DAIR-V2X's camera, and the cameras of A2D2 before they are undistorted", async () => {
    const cam_K = intrinsicRows.flat();
    const dair = await json({ cam_K, cam_D: [0.1, -0.2, 0.001, 0.002, 0.3] });
    assert.deepEqual(lens(only(dair.cameras)), ["brown", 0.1, -0.2, 0.001, 0.002, 0.3]);
    const CamMatrix = [
      [400, 0, 300],
      [0, 400, 200],
      [0, 0, 1],
    ];
    const side = {
      CamMatrix,
      CamMatrixOriginal: intrinsicRows,
      Distortion: [four],
      Lens: "Fisheye",
      Resolution: [640, 480],
    };
    const a2d2 = await json({ cameras: { side_left: side }, lidars: {} });
    assert.deepEqual([lens(only(a2d2.cameras)), a2d2.cameras[0].camera.fx], [["fisheye", ...four], K.fx]);
    assert.deepEqual(doubts(a2d2), ["distortion-guessed"]);
  });

  test("a list that may be a lens is not dropped without a word", async () => {
    for (const name of ["kappa", "rdist", "kd", "k", "lens", "coefficients", "distor"]) {
      const found = await json({ K: intrinsicRows, [name]: [0.1, -0.2, 0.001, 0.0004, 0] });
      assert.deepEqual(doubts(found), ["distortion-unused"], name);
    }
    // A region, a quaternion and zeros are not lenses.
    for (const other of [{ roi: [0, 0, 640, 480] }, { attitude: [0.5, 0.5, 0.5, 0.5] }, { kd: [0, 0, 0, 0, 0] }])
      assert.deepEqual(doubts(await json({ K: intrinsicRows, ...other })), []);
  });

  test("a camera whose lens is not supported is named beside what is read", async () => {
    const mei = `model_type: MEI\ncamera_name: camera\nmirror_parameters: {xi: 1.9}\nprojection_parameters: {gamma1: 700, gamma2: 700, u0: 370, v0: 240}\nextrinsic_rotation: ${JSON.stringify(rows)}\nextrinsic_translation: ${JSON.stringify(translation)}\n`;
    const found = await read("vins.yaml", mei);
    assert.equal(found.poses.length, 1);
    assert.match(found.warnings.find(({ code }) => code === "camera-left-out")?.message ?? "", /MEI/);
  });
});

test("rotations and translations as matrices, and SUSTechPOINTS' extrinsic by rows", async () => {
  const asMatrix = (values, count, cols) => `  rows: ${count}\n  cols: ${cols}\n  data: [${values.join(", ")}]\n`;
  const pose = `rotation_matrix:\n${asMatrix(rotation, 3, 3)}translation_matrix:\n${asMatrix(translation, 3, 1)}`;
  samePose(only((await read("pose.yaml", pose)).poses));
  samePose(only((await json({ extrinsic: matrix.flat(), intrinsic: intrinsicRows.flat() })).poses));
});

test("an array of two maps is not read as its first one", async () => {
  const header = "{'descr': '<u2', 'fortran_order': False, 'shape': (2, 48, 64), }".padEnd(117) + "\n";
  const bytes = Buffer.concat([
    Buffer.from("\x93NUMPY\x01\x00", "latin1"),
    Buffer.from([118, 0]),
    Buffer.from(header, "latin1"),
    Buffer.alloc(2 * 2 * 48 * 64, 1),
  ]);
  await refusedFile(read("depth.npy", new Uint8Array(bytes), { unit: 0.001 }), "depth.npy", /stack of 2 pictures/);
});

describe("YAML that other programs accept", () => {
  test("lists without a blank before them, and lists that go on at the column of their name", async () => {
    const D = [0.1, -0.2, 0.001, 0.002, 0.3];
    const k = `K: !!opencv-matrix\n   rows: 3\n   cols: 3\n   dt: d\n   data:[ ${intrinsicRows.flat().join(", ")} ]\n`;
    const d = `D: !!opencv-matrix\n   rows: 1\n   cols: 5\n   dt: d\n   data:[ ${D.slice(0, 3).join(", ")},\n${D.slice(3).join(", ")} ]\n`;
    const found = await read("cam.yaml", `%YAML:1.0\n---\n${k}${d}size:2\n`);
    assert.deepEqual([lens(only(found.cameras)), codes(found)], [["brown", ...D], []]);
    assert.ok(found.says.startsWith("YAML"), found.says);
  });

  test("damaged YAML that was read line by line is a doubt", async () => {
    const found = await read("cam.yaml", "%YAML:1.0\n---\nfx: 500\nfy: 500\ncx: 320\ncy: 240\n  ]: [\n");
    assert.deepEqual([found.cameras.length, doubts(found)], [1, ["read-by-lines"]]);
  });
});

test("scans of seven and eight floats to a point", async () => {
  for (const floats of [7, 8]) {
    const count = 3000;
    const values = new Float32Array(floats * count);
    for (let at = 0; at < count; at++) {
      const turn = 0.01 + (2 * Math.PI * at) / 300;
      values.set([5 * Math.cos(turn), 5 * Math.sin(turn), 0.1 * Math.floor(at / 300) - 0.5], floats * at);
      for (let other = 3; other < floats; other++) values[floats * at + other] = ((at * 7 + other * 13) % 50) - 25;
    }
    const found = await read("scan.bin", new Uint8Array(values.buffer));
    assert.equal(found.scan.points.length, 3 * count, `${floats}`);
  }
});
