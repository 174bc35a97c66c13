/** Extrinsics in the formats of OpenCV's FileStorage and Kalibr's chain of cameras, both YAML. */
import { list } from "./numbers.js";
import { type Camera, type Rig, padded, reaches, rows } from "./rig.js";

const SAYS = "P_colour = R P_depth + t, metres.";

function matrix(name: string, height: number, width: number, values: readonly number[]): string[] {
  return [
    `${name}: !!opencv-matrix`,
    `   rows: ${height}`,
    `   cols: ${width}`,
    "   dt: d",
    `   data: [ ${list(values)} ]`,
  ];
}

/** The names are those of OpenCV's calibration sample. OpenCV omits the model, so it has ROS's words. */
function opencvCamera(camera: Camera | undefined, name: string): string[] {
  if (camera === undefined) return [];
  const { fx, fy, cx, cy, distortion, model, size } = camera;
  const coefficients = distortion.length > 0 ? distortion : padded([], 5);
  const lines = [
    ...(size ? [`image_width: ${size[0]}`, `image_height: ${size[1]}`] : []),
    ...matrix("camera_matrix", 3, 3, [fx, 0, cx, 0, fy, cy, 0, 0, 1]),
    `distortion_model: "${model === "fisheye" ? model : coefficients.length === 8 ? "rational_polynomial" : "plumb_bob"}"`,
    ...matrix("distortion_coefficients", 1, coefficients.length, coefficients),
  ];
  return [`${name}:`, ...lines.map((line) => `   ${line}`)];
}

/** The form of `cv::stereoCalibrate` for a first and a second camera: R and T map points of the first one into the second one's frame. */
export function opencvYaml(rig: Rig): string {
  return [
    "%YAML:1.0",
    "---",
    `# ${SAYS} For cv::stereoCalibrate, the depth camera is the first camera and the colour camera the second.`,
    ...matrix("R", 3, 3, rig.rotation),
    ...matrix("T", 3, 1, rig.translation),
    ...opencvCamera(rig.depth, "depth"),
    ...opencvCamera(rig.colour, "colour"),
    "",
  ].join("\n");
}

/** Kalibr's words for a distortion, and its numbers; undefined if Kalibr has no such model. */
function kalibrDistortion({ model, distortion }: Camera): { word: string; coefficients: number[] } | undefined {
  if (model === "fisheye") return { word: "equidistant", coefficients: distortion };
  if (reaches(distortion, 4)) return undefined;
  return { word: "radtan", coefficients: padded(distortion, 4) };
}

/** Intrinsics and distortion are written together or not at all: without a distortion, readers assume that the camera has none. */
function kalibrCamera(camera: Camera | undefined, name: string, notes: string[]): string[] {
  const leftOut = (why: string): string[] => {
    notes.push(why);
    return [`  # ${why}`];
  };
  if (camera === undefined) return leftOut(`the ${name} camera's intrinsics are not known`);
  const distortion = kalibrDistortion(camera);
  const { fx, fy, cx, cy, size } = camera;
  if (distortion === undefined) {
    return leftOut(
      `the ${name} camera's intrinsics are left out: Kalibr's radtan has only k1 k2 p1 p2, and this lens has more coefficients`,
    );
  }
  return [
    "  camera_model: pinhole",
    `  distortion_coeffs: [${list(distortion.coefficients)}]`,
    `  distortion_model: ${distortion.word}`,
    `  intrinsics: [${list([fx, fy, cx, cy])}]`,
    ...(size ? [`  resolution: [${size.join(", ")}]`] : leftOut(`the ${name} camera's resolution is not known`)),
  ];
}

/** T_cn_cnm1 of the second camera maps points of the first one into its frame. */
export function kalibrYaml(rig: Rig, notes: string[]): string {
  return [
    `# ${SAYS} cam0 is the depth camera, cam1 the colour camera, and T_cn_cnm1 is (R t).`,
    "cam0:",
    "  cam_overlaps: [1]",
    ...kalibrCamera(rig.depth, "depth", notes),
    "  rostopic: /depth/image_raw",
    "cam1:",
    "  T_cn_cnm1:",
    ...rows(rig).map((values) => `  - [${list(values)}]`),
    "  cam_overlaps: [0]",
    ...kalibrCamera(rig.colour, "colour", notes),
    "  rostopic: /color/image_raw",
    "",
  ].join("\n");
}
