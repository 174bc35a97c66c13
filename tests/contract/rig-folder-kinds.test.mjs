// Folders in the layouts of products: third folders, time stamps as names, units in texts, raw depth maps, and messages about other files.
import assert from "node:assert/strict";
import { describe, test } from "node:test";
import { readRigFolder } from "../../pkg/rig.js";
import { close, text } from "./rig-support.mjs";
import { npy, png } from "./support.mjs";

const [W, H] = [48, 36];
const pixels = (value) => Array.from({ length: H }, (_, y) => Array.from({ length: W }, (_, x) => value(x, y)).flat());
const grey = (depth, value) => png({ width: W, height: H, depth, colourType: 0, rows: pixels(value) });
/** Smooth 16-bit depths, identified by their first value. */
const depth = (first = 1000, across = 7, down = 1) =>
  grey(16, (x, y) => {
    const value = first + across * x + down * y;
    return [value >> 8, value & 255];
  });
const colour = (mark = 0, width = W, height = H) =>
  png({
    ...{ width, height, depth: 8, colourType: 2 },
    rows: Array.from({ length: height }, (_, y) =>
      Array.from({ length: width }, (_, x) => [
        x + y === 0 ? mark : (3 * x) & 255,
        (5 * y) & 255,
        (x * y) & 255,
      ]).flat(),
    ),
  });
const infrared = () => grey(8, (x, y) => [(5 * x + 3 * y) & 255]);
const folder = (files, options) =>
  readRigFolder(
    Object.entries(files).map(([name, bytes]) => ({ name, bytes: typeof bytes === "string" ? text(bytes) : bytes })),
    options,
  );
/** The first value of each frame's colour image and depth map, which identifies their files. */
const marks = ({ frames }) => frames.map(({ image, depth }) => [image.data[0], depth.data[0]]);
const says = ({ warnings }, code, pattern, isDoubt) => {
  const found = warnings.find((each) => each.code === code && pattern.test(each.message));
  assert.ok(found, JSON.stringify(warnings));
  if (isDoubt !== undefined) assert.equal(found.isDoubt, isDoubt);
};
const saysNot = ({ warnings }, code) =>
  assert.ok(!warnings.some((each) => each.code === code), JSON.stringify(warnings));
const refused = (files, pattern) => assert.rejects(folder(files), { code: "file", message: pattern });

describe("a third folder", () => {
  const others = {
    confidence: infrared(),
    ir: infrared(),
    infrared: depth(20_000),
    semantic: infrared(),
    instance: depth(3),
    normals: colour(9),
    depth_vis: colour(9),
    pose_vis: infrared(),
    disparity: infrared(),
  };
  for (const [name, other] of Object.entries(others))
    for (const colours of ["rgb", "images", "frames"])
      test(`${colours}, depth and ${name}`, async () => {
        const found = await folder({
          [`${colours}/0000.png`]: colour(1),
          "depth/0000.png": depth(1001),
          [`${name}/0000.png`]: other,
          [`${colours}/0001.png`]: colour(2),
          "depth/0001.png": depth(1002),
          [`${name}/0001.png`]: other,
        });
        assert.deepEqual(marks(found), [
          [1, 1001],
          [2, 1002],
        ]);
        says(found, "file-left-out", new RegExp(`^${name}/0000.png: its name says`), false);
      });

  test("infrared is the image where there is no colour; of two the left one", async () => {
    const found = await folder({ "ir_left/0.png": infrared(), "depth/0.png": depth(), "ir_right/0.png": depth(9) });
    assert.deepEqual(marks(found), [[0, 1000]]);
    says(found, "file-alone", /^ir_right\/0.png/);
  });

  test("cameras that are numbered, in folders side by side", async () => {
    const numbered = { "image_2/0.png": colour(2), "image_3/0.png": colour(3) };
    assert.deepEqual(marks(await folder({ ...numbered, "depth_3/0.png": depth() })), [[3, 1000]]);
    assert.deepEqual(marks(await folder({ ...numbered, "depth/0.png": depth() })), [[2, 1000]]);
    const both = {
      "cam0/0.png": colour(1),
      "cam1/0.png": colour(2),
      "depth0/0.png": depth(),
      "depth1/0.png": depth(1100),
    };
    assert.deepEqual(marks(await folder(both)), [
      [1, 1000],
      [2, 1100],
    ]);
  });

  test("several scenes, each with a third folder", async () => {
    const scene = (name, mark) => ({
      [`${name}/rgb/0.png`]: colour(mark),
      [`${name}/depth/0.png`]: depth(1000 + mark),
      [`${name}/else/0.png`]: colour(9),
    });
    const found = await folder({ ...scene("a", 1), ...scene("b", 2) });
    assert.deepEqual(marks(found), [
      [1, 1001],
      [2, 1002],
    ]);
  });

  test("scenes in folders side by side, without a folder for depths, with a mask each", async () => {
    const mask = (lit) => grey(8, (x) => [x >= lit ? 255 : 0]);
    const scene = (name, mark) => ({
      [`${name}/rgb.png`]: colour(mark),
      [`${name}/depth.png`]: depth(1000 + mark),
      [`${name}/mask.png`]: mask(mark),
    });
    const found = await folder({ ...scene("bear", 1), ...scene("ox", 2) });
    assert.deepEqual(marks(found), [
      [1, 1001],
      [2, 1002],
    ]);
    assert.deepEqual(
      found.frames.map(({ image }) => image.mask.indexOf(255)),
      [1, 2],
    );
    saysNot(found, "names-ambiguous");
  });

  test("a depth map and what was made of it", async () => {
    const found = await folder({ "rgb/0.png": colour(), "depth/0.png": depth(), "depth_filled/0.png": depth(1200) });
    assert.deepEqual(marks(found), [[0, 1000]]);
    says(found, "names-ambiguous", /^depth_filled\/0.png: another depth map, depth\/0.png, has the same name/, false);
  });
});

test("plural names", async () => {
  for (const [one, other] of [
    ["images/0.png", "depths/0.png"],
    ["colors/0.png", "depth_maps/0.png"],
    ["0_colors.png", "0_depths.png"],
    ["0_image.png", "0_depthmap.png"],
  ])
    assert.deepEqual(marks(await folder({ [one]: colour(5), [other]: depth() })), [[5, 1000]], other);
});

test("names that are alike but for the word of what they hold", async () => {
  for (const [one, other] of [
    ["results/frame000000.png", "results/depth000000.png"],
    ["rgb_0000.png", "distance_to_image_plane_0000.png"],
    ["frame_0000.png", "depth_raw_0000.png"],
  ]) {
    const second = [one, other].map((name) => name.replace(/0(?=\.png)/, "1"));
    const found = await folder({
      [one]: colour(5),
      [other]: depth(),
      [second[0]]: colour(6),
      [second[1]]: depth(1100),
    });
    assert.deepEqual(
      marks(found),
      [
        [5, 1000],
        [6, 1100],
      ],
      other,
    );
    saysNot(found, "pairs-by-order");
  }
});

describe("time stamps as names", () => {
  const at = (stamps, of) => Object.fromEntries(stamps.map((stamp, index) => [of(stamp), index]));
  const files = (colours, depths) => ({
    ...Object.fromEntries(Object.entries(at(colours, (t) => `color/${t}.png`)).map(([name, k]) => [name, colour(k)])),
    ...Object.fromEntries(
      Object.entries(at(depths, (t) => `depth/${t}.png`)).map(([name, k]) => [name, depth(1000 + k)]),
    ),
  });
  const clocks = { seconds: [1e9, 6], milliseconds: [1e6, 0], microseconds: [1e3, 0], nanoseconds: [1, 0] };
  for (const [name, [tick, digits]] of Object.entries(clocks))
    test(`in ${name}, with a map more`, async () => {
      const stamp = (ns) =>
        digits > 0
          ? `${ns / 1_000_000_000n}.${String(ns % 1_000_000_000n)
              .padStart(9, "0")
              .slice(0, digits)}`
          : String(ns / BigInt(tick));
      const start = 1712345678900000000n;
      const times = (offsets) => offsets.map((ms) => stamp(start + BigInt(ms) * 1_000_000n));
      const found = await folder(files(times([0, 33, 67]), times([5, 38, 72, 105])));
      assert.deepEqual(marks(found), [
        [0, 1000],
        [1, 1001],
        [2, 1002],
      ]);
      says(found, "file-alone", /time stamp/, false);
      saysNot(found, "pairs-by-order");
    });

  test("frames taken seconds apart are paired with a doubt; none that is near is an error", async () => {
    const found = await folder(files(["1650000000.100", "1650000010.100"], ["1650000000.900", "1650000010.800"]));
    assert.equal(found.frames.length, 2);
    says(found, "pairs-by-order", /up to 800 ms apart/, true);
    await refused(
      files(["1650000000.100", "1650000010.100"], ["1650000005.000", "1650000006.000"]),
      /time stamps of their names are more than 250 ms apart/,
    );
  });

  test("numbers of frames are no time stamps", async () => {
    const found = await folder(files(["000001", "000002"], ["000001", "000002"]));
    assert.match(found.frames[0].name, /^1$/);
    assert.deepEqual(marks(found).length, 2);
  });
});

describe("the unit of depth in a text beside the maps", () => {
  const pair = { "rgb/0.png": colour(), "depth/0.png": depth(3001) };
  const units = {
    "ORB-SLAM's YAML": ["a.yaml", "%YAML:1.0\nDepthMapFactor: 2000.0\n", 1 / 2000],
    "ORB-SLAM3's YAML": ["a.yaml", '%YAML:1.0\nRGBD.DepthMapFactor: 1000.0\nCamera.type: "PinHole"\n', 0.001],
    "NICE-SLAM's YAML": ["a.yaml", "cam:\n  png_depth_scale: 6553.5 #for depth image in png format\n", 1 / 6553.5],
    "ScanNet's text": ["scene.txt", "m_depthShift = 4000\n", 1 / 4000],
    "GraspNet's JSON": ["meta.json", '{"factor_depth": [[1000.0]]}', 0.001],
    "BOP's JSON": ["scene_camera.json", '{"0": {"cam_K": [50, 0, 24, 0, 50, 18, 0, 0, 1], "depth_scale": 0.1}}', 1e-4],
    "RealSense's scale": ["a.json", '{"depth_scale": 0.0002500000118743628}', 0.0002500000118743628],
    "Open3D's scale": ["config.json", '{"depth_scale": 5000.0, "depth_max": 3.0}', 1 / 5000],
    "nerfstudio's factor": ["transforms.json", '{"depth_unit_scale_factor": 0.001, "w": 48}', 0.001],
    "librealsense's micrometres": ["preset.json", '{"param-depthunits": "100"}', 1e-4],
    "XML of OpenCV": ["a.xml", "<opencv_storage><DepthMapFactor>5000.</DepthMapFactor></opencv_storage>", 1 / 5000],
    "a word": ["a.yaml", "depth_unit: mm\n", 0.001],
  };
  for (const [name, [file, content, unit]] of Object.entries(units))
    test(name, async () => {
      const found = await folder({ ...pair, [file]: content });
      close([found.frames[0].depth.unit], [unit], 1e-9);
      saysNot(found, "unit-guessed");
      saysNot(found, "file-left-out");
    });

  test("what is given goes before it; two that differ are not used; floats are metres", async () => {
    const given = await folder({ ...pair, "a.yaml": "DepthMapFactor: 2000\n" }, { unit: 0.002 });
    assert.equal(given.frames[0].depth.unit, 0.002);
    const two = await folder({ ...pair, "a.yaml": "depth_scale: 1000\n", "b.yaml": "depth_factor: 5000\n" });
    says(two, "units-differ", /a.yaml 1 mm, b.yaml 0.2 mm/, true);
    says(two, "unit-guessed", /./, true);
    const data = new Float32Array(W * H).map((_, index) => 1 + index / 9000);
    const metres = npy({ descr: "<f4", shape: [H, W], data });
    const floats = await folder({ "rgb/0.png": colour(), "depth/0.npy": metres, "a.yaml": "depth_scale: 1000\n" });
    assert.equal(floats.frames[0].depth.unit, 1);
    const levels = npy({ descr: "<u2", shape: [H, W], data: new Uint16Array(W * H).map((_, index) => 5000 + index) });
    const whole = await folder({ "rgb/0.png": colour(), "depth/0.npy": levels, "a.yaml": "depth_scale: 5000\n" });
    assert.equal(whole.frames[0].depth.unit, 1 / 5000);
  });

  test("TUM's lists mean TUM's unit unless a text says another one or the values are not TUM's", async () => {
    const lists = { "rgb.txt": "1.0 rgb/0.png\n", "depth.txt": "1.0 depth/0.png\n" };
    const own = await folder({ ...pair, ...lists, "a.yaml": "RGBD.DepthMapFactor: 1000.0\n" });
    assert.equal(own.frames[0].depth.unit, 0.001);
    saysNot(own, "unit-guessed");
    const doubtful = await folder({ ...pair, ...lists });
    assert.equal(doubtful.frames[0].depth.unit, 0.0002);
    says(doubtful, "unit-guessed", /TUM's 5000 units per metre were guessed/, true);
    const fives = await folder({ "rgb/0.png": colour(), "depth/0.png": depth(5000, 5, 5), ...lists });
    saysNot(fives, "unit-guessed");
  });

  test("a list of associations, in either order", async () => {
    for (const line of ["1.00 rgb/0.png 1.01 depth/0.png", "1.01 depth/0.png 1.00 rgb/0.png"]) {
      const found = await folder({ ...pair, "rgb/9.png": colour(), "associations.txt": `${line}\n` });
      assert.deepEqual(marks(found), [[0, 3001]], line);
    }
  });
});

describe("depth maps that are no pictures", () => {
  const levels = new Uint16Array(W * H).map((_, index) => 1000 + index);
  const raw = new Uint8Array(levels.buffer);

  test("raw ones by the size in the text beside them, or the given one", async () => {
    const metadata = `Stream,Depth\nFormat,Z16\nResolution x,${W}\nResolution y,${H}\n\nIntrinsic:,\nFx,50.5\nFy,50.25\nPPx,24.5\nPPy,17.5\nDistorsion,Brown Conrady\n`;
    const viewer = {
      "snap_Color.png": colour(),
      "snap_Depth.png": colour(3),
      "snap_Depth.raw": raw,
      "snap_Depth_metadata.csv": metadata,
    };
    const found = await folder(viewer);
    assert.deepEqual(marks(found), [[0, 1000]]);
    const { fx, fy, cx, cy } = found.frames[0].depth.camera;
    assert.deepEqual([fx, fy, cx, cy], [50.5, 50.25, 24.5, 17.5]);
    says(found, "file-left-out", /snap_Depth.png: it is a colour picture/);
    const given = await folder({ "0_color.png": colour(), "0_depth.raw": raw }, { size: [W, H] });
    assert.deepEqual(marks(given), [[0, 1000]]);
    await refused(
      { "0_color.png": colour(), "0_depth.raw": raw },
      /0_depth.raw: .*raw data without a header, give its size/,
    );
  });

  test("tables", async () => {
    const rows = Array.from({ length: H }, (_, y) => [...levels.slice(y * W, (y + 1) * W)].join(","));
    assert.deepEqual(marks(await folder({ "0_color.png": colour(), "0_depth.csv": rows.join("\n") })), [[0, 1000]]);
  });

  test("COLMAP's, by the names of the images", async () => {
    const map = (channels) =>
      new Uint8Array([
        ...text(`${W}&${H}&${channels}&`),
        ...new Uint8Array(new Float32Array(channels * W * H).fill(2).buffer),
      ]);
    const found = await folder({
      "images/1.png": colour(4),
      "stereo/depth_maps/1.png.geometric.bin": map(1),
      "stereo/depth_maps/1.png.photometric.bin": map(1),
      "stereo/normal_maps/1.png.geometric.bin": map(3),
    });
    assert.deepEqual(marks(found), [[4, 2]]);
    says(found, "unit-guessed", /COLMAP/, true);
  });

  test("a LiDAR's scan is sorted into rows and columns, and points that are all one are named", async () => {
    const points = new Float32Array(4 * 900).map((_, at) => (at % 4 === 3 ? 0.5 : 9 * Math.sin(at * 1.7)));
    const found = await folder({ "image_2/0.png": colour(), "velodyne/0.bin": new Uint8Array(points.buffer) });
    assert.ok(found.frames[0].depth.points.length > 0);
    says(found, "points-sorted", /velodyne\/0.bin/);
    const ply = `ply\nformat ascii 1.0\nelement vertex 50\nproperty float x\nproperty float y\nproperty float z\nend_header\n${"1 2 3\n".repeat(50)}`;
    await refused({ "bag0.png": infrared(), "bag0.ply": ply, "bag0_lidar_intensities.png": infrared() }, /bag0.ply: /);
  });

  test("a film in the place of colour images, and a disparity map in that of depths", async () => {
    const film = new Uint8Array([0, 0, 0, 24, ...text("ftypmp42"), 0, 0]);
    await refused({ "depth/0.png": depth(), "rgb.mp4": film }, /rgb.mp4: it is a video; save its frames/);
    const pfm = new Uint8Array([...text("Pf\n2 2\n-1\n"), ...new Uint8Array(new Float32Array([9, 9, 9, 9]).buffer)]);
    await refused(
      { "im0.png": colour(), "im1.png": colour(1), "disp0.pfm": pfm },
      /disp0.pfm: .*disparities.*baseline/,
    );
  });

  test("Middlebury's cameras", async () => {
    const calib =
      "cam0=[4000.5 0 1300.25; 0 4000.5 950; 0 0 1]\ncam1=[4000.5 0 1400.25; 0 4000.5 950; 0 0 1]\ndoffs=100\nbaseline=200\nwidth=2800\nheight=1900\n";
    const { cameras, poses } = await folder({ "calib.txt": calib });
    assert.deepEqual(
      cameras.map(({ name, camera, width, height }) => [name, camera.fx, camera.cx, width, height]),
      [
        ["cam0", 4000.5, 1300.25, 2800, 1900],
        ["cam1", 4000.5, 1400.25, 2800, 1900],
      ],
    );
    assert.deepEqual(poses[0].pose.translation, [-0.2, 0, 0]);
  });
});

describe("intrinsics of another size", () => {
  const pair = { "rgb/0.png": colour(0, 96, 72), "depth/0.png": depth() };

  test("one camera for an image and a smaller registered depth map is scaled", async () => {
    const found = await folder({ ...pair, "K.txt": "120 0 47.5\n0 120 35.5\n0 0 1\n" });
    const [image, map] = [found.frames[0].image.camera, found.frames[0].depth.camera];
    assert.deepEqual([image.fx, image.cx, map.fx, map.cx, map.cy], [120, 47.5, 60, 23.5, 17.5]);
    says(found, "camera-shared", /scaled from 96x72 to .*48x36/, true);
  });

  test("a file for each frame is that frame's camera", async () => {
    const camera = (fx) => JSON.stringify({ fx, fy: fx, cx: 47.5, cy: 35.5, width: 96, height: 72 });
    const found = await folder({
      "keyframes/images/1.png": colour(1, 96, 72),
      "keyframes/depth/1.png": depth(),
      "keyframes/confidence/1.png": infrared(),
      "keyframes/cameras/1.json": camera(120),
      "keyframes/images/2.png": colour(2, 96, 72),
      "keyframes/depth/2.png": depth(),
      "keyframes/confidence/2.png": infrared(),
      "keyframes/cameras/2.json": camera(121),
    });
    assert.deepEqual(
      found.frames.map(({ image, depth }) => [image.camera.fx, depth.camera.fx]),
      [
        [120, 60],
        [121, 60.5],
      ],
    );
  });

  test("those that say their size are scaled, those that do not are doubted", async () => {
    const sized = await folder({
      ...pair,
      "rgb.json": '{"fx": 480, "fy": 480, "cx": 191.5, "cy": 143.5, "width": 384, "height": 288}',
      "depth_K.txt": "60 0 23.5\n0 60 17.5\n0 0 1\n",
    });
    assert.deepEqual([sized.frames[0].image.camera.fx, sized.frames[0].image.camera.cx], [120, 47.5]);
    says(sized, "camera-size", /scaled/, true);
    for (const centre of [190, 20]) {
      const rgb = `{"fx": 120, "fy": 120, "cx": ${centre}, "cy": ${0.75 * centre}}`;
      const found = await folder({ ...pair, "rgb.json": rgb, "depth_K.txt": "60 0 23.5\n0 60 17.5\n0 0 1\n" });
      says(found, "principal-point", centre > 96 ? /outside the picture/ : /far from the centre/, true);
    }
  });

  test("depth maps that are called aligned have the colour camera", async () => {
    const cameras = JSON.stringify({
      color: { fx: 61, fy: 61, cx: 24, cy: 18, width: W, height: H },
      depth: { fx: 50, fy: 50, cx: 24, cy: 18, width: W, height: H },
    });
    for (const name of ["aligned_depth_0.png", "aligned_depth_to_color/0.png", "0_depth_registered.png"]) {
      const found = await folder({ "color_0.png": colour(), [name]: depth(), "k.json": cameras });
      assert.equal(found.frames[0].depth.camera.fx, 61, name);
      says(found, "camera-shared", /aligned.*identity/, true);
    }
    const plain = await folder({ "color_0.png": colour(), "depth_0.png": depth(), "k.json": cameras });
    assert.equal(plain.frames[0].depth.camera.fx, 50);
  });
});

test("a lens whose name lists its coefficients is used, and no more is said of it", async () => {
  const camera = { fx: 50, fy: 50, cx: 24, cy: 18, dist_k1k2p1p2k3: [0.1, -0.2, 0.001, 0.002, 0.3] };
  const found = await folder({ "calib.json": JSON.stringify({ rgb: camera, depth: { ...camera, fx: 51, fy: 51 } }) });
  assert.deepEqual([...found.cameras[0].camera.distortion], camera.dist_k1k2p1p2k3);
  assert.deepEqual(found.warnings, []);
});
