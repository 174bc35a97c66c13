/** Extrinsics as a 4x4 matrix in text, and as a line for ROS 2. */
import { isOfScan } from "../formats/poses.js";
import { fault } from "./built.js";
import { real } from "./numbers.js";
import { type Rig, type RigContext, rows } from "./rig.js";

/** Four rows of four numbers and nothing else, which `numpy.loadtxt` and most programs can read. */
export const matrixText = (rig: Rig): string =>
  rows(rig)
    .map((values) => `${values.map(real).join(" ")}\n`)
    .join("");

/**
 * The unit quaternion x y z w of a rotation, w not negative (Shepperd 1978). Dividing by the largest of the four keeps the digits of half
 * turns as well.
 */
export function quaternion(r: readonly number[]): [x: number, y: number, z: number, w: number] {
  const [xx = NaN, xy = NaN, xz = NaN, yx = NaN, yy = NaN, yz = NaN, zx = NaN, zy = NaN, zz = NaN] = r;
  const squares = [1 + xx - yy - zz, 1 - xx + yy - zz, 1 - xx - yy + zz, 1 + xx + yy + zz];
  // Four times the products of x, y, z and w with each of them, row by row.
  const products = [
    [squares[0], xy + yx, xz + zx, zy - yz],
    [xy + yx, squares[1], yz + zy, xz - zx],
    [xz + zx, yz + zy, squares[2], yx - xy],
    [zy - yz, xz - zx, yx - xy, squares[3]],
  ];
  const largest = squares.indexOf(Math.max(...squares));
  const [x = NaN, y = NaN, z = NaN, w = NaN] = products[largest] ?? [];
  const length = Math.hypot(x, y, z, w) * (w < 0 ? -1 : 1);
  return [x / length, y / length, z / length, w / length];
}

/** Names that a shell passes on unchanged and that tf2 accepts, without a slash at the front. */
const FRAME = /^[A-Za-z0-9_][A-Za-z0-9_/.-]*$/;

function frame(name: string, field: string): string {
  if (typeof name === "string" && FRAME.test(name)) return name;
  throw fault("range", field, 'is not a name of a ROS frame, which has letters, digits, "_", "/", "." and "-"');
}

/** tf2 stores the pose of the child in the parent, P_parent = R P_child + t, so the colour camera is the parent. */
export function ros2Line(rig: Rig, { frames }: RigContext): string {
  const parent = frame(frames?.colour ?? "camera_color_optical_frame", "context.frames.colour");
  const isLidar = frames?.depth === undefined && isOfScan(rig);
  const child = frame(frames?.depth ?? (isLidar ? "lidar" : "camera_depth_optical_frame"), "context.frames.depth");
  if (parent === child) throw fault("range", "context.frames", "both cameras have the same frame");
  const [x = 0, y = 0, z = 0] = rig.translation;
  const [qx, qy, qz, qw] = quaternion(rig.rotation);
  const values = Object.entries({ x, y, z, qx, qy, qz, qw }).map(([name, value]) => `--${name} ${real(value)}`);
  return [
    `# The transform of the child frame (${isLidar ? "LiDAR, with the axes of its points" : "depth camera"}) in the parent frame (colour camera): P_parent = R P_child + t, metres.`,
    `# A frame has one parent: if a driver already publishes this transform, change it there instead of adding another.`,
    `ros2 run tf2_ros static_transform_publisher ${values.join(" ")} --frame-id ${parent} --child-frame-id ${child}`,
    "",
  ].join("\n");
}
