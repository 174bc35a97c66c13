// Frames of a LiDAR and a camera in published folders, with their calibration: which file is the scan, which the picture, and
// P_camera = R P_lidar + t.
import { existsSync, readFileSync, readdirSync } from "node:fs";
import { basename, join } from "node:path";

const text = (path) => readFileSync(path, "utf8");
const numbers = (line) => line.trim().split(/\s+/).map(Number);
/** Lines of `key: numbers`. */
const table = (path) =>
  Object.fromEntries(
    text(path)
      .split("\n")
      .flatMap((line) => {
        const [, key, values] = /^(\w+):(.*)$/.exec(line) ?? [];
        return key === undefined ? [] : [[key, numbers(values)]];
      }),
  );
const product = (a, b) =>
  Array.from({ length: 9 }, (_, at) =>
    [0, 1, 2].reduce((sum, k) => sum + a[3 * Math.floor(at / 3) + k] * b[3 * k + (at % 3)], 0),
  );
const times = (a, v) => [0, 1, 2].map((row) => [0, 1, 2].reduce((sum, k) => sum + a[3 * row + k] * v[k], 0));
/** Rotation and translation of a matrix with three or four rows. */
const motion = (rows) => ({
  rotation: rows.slice(0, 3).flatMap((row) => row.slice(0, 3)),
  translation: rows.slice(0, 3).map((row) => row[3]),
});
const inRows = (values) => [0, 4, 8].map((from) => values.slice(from, from + 4));

const entries = (folder) => readdirSync(folder, { withFileTypes: true });
const filesOf = (folder, pattern) =>
  entries(folder)
    .filter((entry) => entry.isFile() && pattern.test(entry.name))
    .map(({ name }) => name)
    .sort();
const PICTURE = /\.(?:png|jpe?g)$/i;
const SCAN = /\.(?:pcd|ply|bin|las|laz)$/i;

/** KITTI object detection: the left colour camera is P2, whose fourth column is an additional shift. */
function kittiCamera(path) {
  const { P2, R0_rect, Tr_velo_to_cam } = table(path);
  const lidar = motion(inRows(Tr_velo_to_cam));
  const [fx, , cx, x, , fy, cy, y, , , , z] = P2;
  const shift = [(x - cx * z) / fx, (y - cy * z) / fy, z];
  return {
    camera: { fx, fy, cx, cy },
    rotation: product(R0_rect, lidar.rotation),
    translation: times(R0_rect, lidar.translation).map((value, axis) => value + shift[axis]),
  };
}

function kitti(folder) {
  const at = (name) => join(folder, name);
  if (!["velodyne", "image_2", "calib"].every((name) => existsSync(at(name)))) return [];
  return filesOf(at("velodyne"), SCAN).flatMap((scan) => {
    const stem = scan.replace(SCAN, "");
    const calibration = join(at("calib"), `${stem}.txt`);
    const picture = filesOf(at("image_2"), PICTURE).find((name) => name.replace(PICTURE, "") === stem);
    if (picture === undefined || !existsSync(calibration)) return [];
    return [
      {
        name: stem,
        scan: join(at("velodyne"), scan),
        picture: join(at("image_2"), picture),
        ...kittiCamera(calibration),
      },
    ];
  });
}

/** nuScenes: a K and a lidar2cam for each camera; pictures have the camera's name. */
function nuscenes(folder) {
  const [scan] = filesOf(folder, SCAN);
  const found = filesOf(folder, /\.json$/i).map((name) => JSON.parse(text(join(folder, name))));
  return found.flatMap((cameras) =>
    Object.entries(cameras).flatMap(([name, { K, lidar2cam } = {}]) => {
      const picture = filesOf(folder, PICTURE).find((file) => file.replace(PICTURE, "") === name);
      if (!K || !lidar2cam || !scan || picture === undefined) return [];
      const camera = { fx: K[0][0], fy: K[1][1], cx: K[0][2], cy: K[1][2] };
      return [{ name, scan: join(folder, scan), picture: join(folder, picture), camera, ...motion(lidar2cam) }];
    }),
  );
}

const opencv = (K, D) => ({ fx: K[0], fy: K[4], cx: K[2], cy: K[5], distortion: [...D, 0, 0, 0, 0, 0].slice(0, 5) });

/** OpenCalib: K, D and T in lines of text, or the first matrices below `cam_K`, `cam_dist` and `sensor_calib` in JSON. */
function opencalib(folder) {
  const [[scan], [picture]] = [filesOf(folder, SCAN), filesOf(folder, PICTURE)];
  if (scan === undefined || picture === undefined) return [];
  const paths = { name: basename(folder), scan: join(folder, scan), picture: join(folder, picture) };
  for (const file of filesOf(folder, /\.txt$/i)) {
    const { K, D, T } = table(join(folder, file));
    if (K?.length === 9 && T?.length >= 12) return [{ ...paths, camera: opencv(K, D ?? []), ...motion(inRows(T)) }];
  }
  const parameters = filesOf(folder, /\.json$/i).flatMap((file) =>
    Object.values(JSON.parse(text(join(folder, file)))).flatMap((each) => each?.param ?? []),
  );
  const [intrinsic, extrinsic] = ["cam_K", "sensor_calib"].map((key) => parameters.find((each) => key in each));
  if (!intrinsic || !extrinsic) return [];
  const camera = opencv(intrinsic.cam_K.data.flat(), intrinsic.cam_dist?.data.flat() ?? []);
  return [{ ...paths, camera, ...motion(extrinsic.sensor_calib.data) }];
}

/** All frames below a folder. */
export function framesBelow(folder) {
  const own = [kitti, nuscenes, opencalib].map((find) => find(folder)).find((frames) => frames.length > 0) ?? [];
  if (own.length > 0) return own;
  return entries(folder)
    .filter((entry) => entry.isDirectory())
    .flatMap(({ name }) =>
      framesBelow(join(folder, name)).map((frame) => ({ ...frame, name: `${name}/${frame.name}` })),
    );
}
