/**
 * The calibration of an Azure Kinect: the JSON of the device, which an .mkv recording has as an attachment, and the print of the SDK's
 * example.
 *
 * The JSON's numbers are fractions of the whole sensor. The images of a mode are a crop of the sensor, which may be binned, so that one
 * set of numbers gives a camera for each mode; the size of the images selects one. As in the SDK, pixel centres have integer coordinates.
 */
import { badFile } from "../../errors.js";
import { BROWN_NAMES, type RawCamera } from "./cameras.js";
import { Findings, flat } from "./findings.js";
import { isNode, type Node, type Numbers, nodesOf, numberOf } from "./numbers.js";
import { chained, inverseOf, poseOf, rotationOf } from "./poses.js";

/** Each mode, from the SDK: the size of the binned sensor, the first pixel of the crop, and the size of the images. */
type Mode = [binned: [number, number], crop: [number, number], size: [number, number]];
const COLOUR: Mode[] = [
  [
    [1280, 960],
    [0, 120],
    [1280, 720],
  ],
  [
    [1920, 1440],
    [0, 180],
    [1920, 1080],
  ],
  [
    [2560, 1920],
    [0, 240],
    [2560, 1440],
  ],
  [
    [2048, 1536],
    [0, 0],
    [2048, 1536],
  ],
  [
    [3840, 2880],
    [0, 360],
    [3840, 2160],
  ],
  [
    [4096, 3072],
    [0, 0],
    [4096, 3072],
  ],
];
const DEPTH: Mode[] = [
  [
    [1024, 1024],
    [192, 180],
    [640, 576],
  ],
  [
    [512, 512],
    [96, 90],
    [320, 288],
  ],
  [
    [1024, 1024],
    [0, 0],
    [1024, 1024],
  ],
  [
    [512, 512],
    [0, 0],
    [512, 512],
  ],
];

const information = (root: Node): Node => (isNode(root.CalibrationInformation) ? root.CalibrationInformation : root);

export const isAzureKinect = (root: Node): boolean =>
  nodesOf(information(root).Cameras).some(
    (camera) => isNode(camera.Intrinsics) && "ModelParameters" in camera.Intrinsics,
  );

const isDepth = (camera: Node): boolean => /depth|D\d$/i.test(`${camera.Purpose ?? camera.Location ?? ""}`);

/** The lens of the parameters cx cy fx fy, k1 to k6, the centre of distortion, p2 p1. */
function lensOf(p: Numbers): Numbers {
  if (p[10] !== 0 || p[11] !== 0)
    throw badFile("its centre of distortion is not its principal point, which is not supported");
  return [4, 5, 13, 12, 6, 7, 8, 9].map((at) => p[at] ?? 0);
}

function camerasOf(found: Findings, camera: Node): void {
  const name = isDepth(camera) ? "depth" : "color";
  const intrinsics = isNode(camera.Intrinsics) ? camera.Intrinsics : {};
  const p = (Array.isArray(intrinsics.ModelParameters) ? intrinsics.ModelParameters : []).map(
    (v) => numberOf(v) ?? NaN,
  );
  const model = String(intrinsics.ModelType ?? "").replace(/^CALIBRATION_LensDistortionModel/, "");
  if (!/^(BrownConrady|Rational6KT|)$/.test(model)) {
    found.warn(
      "camera-left-out",
      `The camera "${name}" was left out: its lens model ${model.slice(0, 40)} is not supported.`,
    );
    return;
  }
  if (model === "Rational6KT" && (p[12] !== 0 || p[13] !== 0))
    found.warn(
      "lens-approximated",
      `The camera "${name}" has the lens Rational6KT, whose tangential part is read as Brown's.`,
    );
  for (const [binned, crop, [width, height]] of name === "depth" ? DEPTH : COLOUR) {
    const at = (index: number, axis: 0 | 1) => (p[index] ?? NaN) * binned[axis];
    found.camera(
      {
        ...{ name, focal: [at(2, 0), at(3, 1)], centre: [at(0, 0) - crop[0] - 0.5, at(1, 1) - crop[1] - 0.5] },
        ...{ distortion: p.length >= 14 ? lensOf(p) : [], width, height },
      },
      name === "depth" ? "depth" : "colour",
    );
  }
}

/** The pose from the common frame, that of the depth camera, into this camera. */
function placeOf(found: Findings, camera: Node) {
  const rt = isNode(camera.Rt) ? camera.Rt : {};
  const [r, t] = [flat(rt.Rotation, 9), flat(rt.Translation, 3)];
  return r && t && poseOf(rotationOf(r, found.warnings), t);
}

export function readAzureKinect(root: Node): Findings {
  const found = new Findings();
  const cameras = nodesOf(information(root).Cameras);
  for (const camera of cameras) camerasOf(found, camera);
  const [depth, colour] = [cameras.find(isDepth), cameras.find((each) => !isDepth(each))];
  const [a, b] = [depth && placeOf(found, depth), colour && placeOf(found, colour)];
  if (a && b) found.poses.push({ name: "depth to color", from: "depth", to: "color", pose: chained(b, inverseOf(a)) });
  if (nodesOf(information(root).InertialSensors).length > 0)
    found.warn("pose-left-out", "The poses of the gyroscope and the accelerometer were left out.");
  return found;
}

const LINE =
  /^\s*(resolution width|resolution height|principal point [xy]|focal length [xy]|k[1-6]|tangential distortion coefficient [xy]|center of distortion in Z=1 plane, [xy])\s*:\s*(\S+)\s*$/i;

export const isAzurePrint = (text: string): boolean =>
  /^[ \t]*principal point x[ \t]*:/im.test(text) && /^[ \t]*focal length x[ \t]*:/im.test(text);

/** Names of the print that differ from OpenCV's. */
const PRINTED: Record<string, string> = {
  p1: "tangential distortion coefficient x",
  p2: "tangential distortion coefficient y",
};

/** The print of the SDK's example `calibration_info`, which has the depth camera in the mode of the device. */
export function readAzurePrint(text: string): Findings {
  const found = new Findings();
  let values = new Map<string, number>();
  let name: "depth" | "color" = "depth";
  const take = () => {
    const n = (key: string) => values.get(key) ?? NaN;
    const raw: RawCamera = {
      ...{ name, focal: [n("focal length x"), n("focal length y")] },
      ...{ centre: [n("principal point x"), n("principal point y")] },
      distortion: BROWN_NAMES.map((key) => values.get(PRINTED[key] ?? key) ?? 0),
      ...{ width: values.get("resolution width"), height: values.get("resolution height") },
    };
    if (values.has("focal length x")) found.camera(raw, name === "depth" ? "depth" : "colour");
    values = new Map();
  };
  for (const line of text.split(/\r?\n/)) {
    const [, key = "", value] = LINE.exec(line) ?? [];
    const number = numberOf(value);
    if (key === "" || number === undefined) {
      // Programs that print both cameras write a line of words before each.
      const said = /colou?r|rgb/i.test(line) ? "color" : /depth/i.test(line) ? "depth" : undefined;
      if (said === undefined || number !== undefined) continue;
      take();
      name = said;
      continue;
    }
    if (values.has(key.toLowerCase())) take();
    values.set(key.toLowerCase(), number);
  }
  take();
  return found;
}
