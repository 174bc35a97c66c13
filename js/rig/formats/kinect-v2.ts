/** Intrinsics of a Kinect v2 under the names of its SDK and of libfreenect2, and the constant that iai_kinect2 adds to depths. */
import { badFile } from "../../errors.js";
import { Findings } from "./findings.js";
import { type Node, numberOf, numbersAt } from "./numbers.js";

/** The size of the depth and infrared images, pixels. */
const SIZE = { width: 512, height: 424 };
const RADIAL = ["RadialDistortionSecondOrder", "RadialDistortionFourthOrder", "RadialDistortionSixthOrder"];

const isSdk = (root: Node): boolean => "FocalLengthX" in root && "PrincipalPointX" in root;
const isFreenect = (root: Node): boolean => "mx_x3y0" in root && "fx" in root;
const isShift = (root: Node): boolean => Object.keys(root).length === 1 && numberOf(root.depthShift) !== undefined;

export const isKinect2 = (root: Node): boolean => isSdk(root) || isFreenect(root) || isShift(root);

export function readKinect2(root: Node): Findings {
  const found = new Findings();
  const all = (...keys: string[]) => numbersAt(root, keys);
  if (isShift(root))
    throw badFile(
      `it is iai_kinect2's depthShift of ${all("depthShift")[0]} mm, which kinect2_bridge adds to the depths that it publishes; it is not added here`,
    );
  if (isFreenect(root)) {
    found.camera(
      { name: "color", focal: all("fx", "fy"), centre: all("cx", "cy"), width: 1920, height: 1080 },
      "colour",
    );
    found.warn(
      "pose-left-out",
      "The polynomials mx_.. and my_.., which map depth pixels to colour pixels, are not a pose and were left out.",
    );
  } else {
    const [k1 = 0, k2 = 0, k3 = 0] = RADIAL.map((key) => numberOf(root[key]) ?? 0);
    found.camera(
      {
        ...{ name: "depth", focal: all("FocalLengthX", "FocalLengthY") },
        ...{ centre: all("PrincipalPointX", "PrincipalPointY"), distortion: [k1, k2, 0, 0, k3], ...SIZE },
      },
      "depth",
    );
  }
  return found;
}
