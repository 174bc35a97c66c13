/**
 * Intrinsics of a Kinect v2: as its SDK names them, as libfreenect2 keeps those of its colour camera, and the constant that iai_kinect2 adds
 * to depths.
 */
import { badFile } from "../../errors.js";
import { Findings } from "./findings.js";
import { type Node, numberOf } from "./numbers.js";

/** Depth and infrared pictures of the Kinect v2. */
const SIZE = { width: 512, height: 424 };
const RADIAL = ["RadialDistortionSecondOrder", "RadialDistortionFourthOrder", "RadialDistortionSixthOrder"];

const isSdk = (root: Node): boolean => "FocalLengthX" in root && "PrincipalPointX" in root;
const isFreenect = (root: Node): boolean => "mx_x3y0" in root && "fx" in root;
const isShift = (root: Node): boolean => Object.keys(root).length === 1 && numberOf(root.depthShift) !== undefined;

export const isKinect2 = (root: Node): boolean => isSdk(root) || isFreenect(root) || isShift(root);

export function readKinect2(root: Node): Findings {
  const found = new Findings();
  const n = (key: string) => numberOf(root[key]) ?? NaN;
  if (isShift(root))
    throw badFile(
      `it is iai_kinect2's depthShift of ${n("depthShift")} mm, which kinect2_bridge adds to the depths that it publishes; nothing is added here`,
    );
  if (isFreenect(root)) {
    found.camera(
      { name: "color", focal: [n("fx"), n("fy")], centre: [n("cx"), n("cy")], width: 1920, height: 1080 },
      "colour",
    );
    found.warn(
      "pose-left-out",
      "The polynomials mx_.. and my_.. that carry depths to colours were left out: they are no pose.",
    );
  } else {
    const [k1 = 0, k2 = 0, k3 = 0] = RADIAL.map((key) => numberOf(root[key]) ?? 0);
    found.camera(
      {
        ...{ name: "depth", focal: [n("FocalLengthX"), n("FocalLengthY")] },
        ...{ centre: [n("PrincipalPointX"), n("PrincipalPointY")], distortion: [k1, k2, 0, 0, k3], ...SIZE },
      },
      "depth",
    );
  }
  return found.done("a Kinect v2's intrinsics");
}
