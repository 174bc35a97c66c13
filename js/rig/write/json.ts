/** Extrinsics as Open3D's PinholeCameraParameters and as librealsense's structures, both in JSON. */
import { fault } from "./built.js";
import { list } from "./numbers.js";
import { type Camera, type Rig, padded, reaches, rows } from "./rig.js";

/** The entries column by column. */
const columns = (matrix: readonly (readonly number[])[]): number[] =>
  (matrix[0] ?? []).flatMap((_, column) => matrix.map((row) => row[column] ?? NaN));

function open3dIntrinsic(camera: Camera | undefined, notes: string[]): string[] {
  if (camera === undefined) {
    throw fault(
      "missing",
      "context.colour",
      "is required, since Open3D reads no extrinsics without the camera's intrinsics",
    );
  }
  const { fx, fy, cx, cy, size, distortion } = camera;
  const [width, height] = size ?? [0, 0];
  if (size === undefined) notes.push("the colour camera's size is not known: the file says 0");
  if (reaches(distortion, 0))
    notes.push("the colour camera's distortion is left out: Open3D takes pictures whose distortion was removed");
  return [
    `    "height": ${height},`,
    `    "intrinsic_matrix": [${list([fx, 0, 0, 0, fy, 0, cx, cy, 1])}],`,
    `    "width": ${width}`,
  ];
}

/** The extrinsic maps the world, which here is the depth camera's frame, into the camera's frame, and is stored column by column. */
export function open3dJson(rig: Rig, notes: string[]): string {
  return [
    "{",
    '  "class_name": "PinholeCameraParameters",',
    `  "extrinsic": [${list(columns(rows(rig)))}],`,
    '  "intrinsic": {',
    ...open3dIntrinsic(rig.colour, notes),
    "  },",
    '  "version_major": 1,',
    '  "version_minor": 0',
    "}",
    "",
  ].join("\n");
}

/** librealsense's names of its models, and its five coefficients; undefined if it has no such model. */
function realsenseDistortion({ model, distortion }: Camera): { model: string; coeffs: number[] } | undefined {
  if (model === "fisheye") return { model: "Kannala Brandt4", coeffs: padded(distortion, 5) };
  if (reaches(distortion, 5)) return undefined;
  return { model: reaches(distortion, 0) ? "Brown Conrady" : "None", coeffs: padded(distortion, 5) };
}

/** Intrinsics and distortion are written together or not at all: without a distortion, readers assume that the camera has none. */
function realsenseCamera(camera: Camera | undefined, key: string, name: string, notes: string[]): string[] {
  if (camera === undefined) {
    notes.push(`the ${name} camera's intrinsics are not known`);
    return [];
  }
  const { fx, fy, cx, cy, size } = camera;
  const distortion = realsenseDistortion(camera);
  if (distortion === undefined) {
    notes.push(
      `the ${name} camera's intrinsics are left out: librealsense has only k1 k2 p1 p2 k3, and this lens has more coefficients`,
    );
    return [];
  }
  if (size === undefined) notes.push(`the ${name} camera's size is not known`);
  const lines = [
    ...(size ? [`    "width": ${size[0]}`, `    "height": ${size[1]}`] : []),
    ...Object.entries({ ppx: cx, ppy: cy, fx, fy }).map(([member, value]) => `    "${member}": ${list([value])}`),
    `    "model": "${distortion.model}"`,
    `    "coeffs": [${list(distortion.coeffs)}]`,
  ];
  return [`  "${key}": {`, lines.join(",\n"), "  },"];
}

/** The form of `rs2_extrinsics`: the rotation column by column, the translation in metres, from the depth to the colour stream. */
export function realsenseJson(rig: Rig, notes: string[]): string {
  const rotation = [0, 3, 6, 1, 4, 7, 2, 5, 8].map((at) => rig.rotation[at] ?? NaN);
  return [
    "{",
    ...realsenseCamera(rig.depth, "depth", "depth", notes),
    ...realsenseCamera(rig.colour, "color", "colour", notes),
    '  "depth_to_color": {',
    `    "rotation": [${list(rotation)}],`,
    `    "translation": [${list(rig.translation)}]`,
    "  }",
    "}",
    "",
  ].join("\n");
}
