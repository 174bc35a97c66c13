/**
 * Cameras of the BOP benchmark: camera.json of a dataset, scene_camera.json of a scene. `depth_scale` is in millimetres per stored unit, and
 * depth maps are registered to the colour images.
 */
import { type RawCamera, ofMatrix } from "./cameras.js";
import { Findings, flat } from "./findings.js";
import { isNode, type Node, matrixOf, numberOf } from "./numbers.js";

const MILLIMETRE = 0.001;
/** Largest difference between intrinsics of the same camera in two images, pixels. */
const ALIKE = 1e-4;

/** Other programs use the same name for metres per unit or units per metre, which are much smaller or larger. */
const isPerMillimetre = (scale: number): boolean => scale >= 0.01 && scale < 100;

const perImage = (root: Node): [string, Node][] =>
  Object.entries(root).filter(
    (entry): entry is [string, Node] => isNode(entry[1]) && flat(entry[1].cam_K, 9) !== undefined,
  );

export const isBop = (root: Node): boolean =>
  ("depth_scale" in root && "fx" in root && "cx" in root) ||
  perImage(root).length > 0 ||
  flat(root.cam_K, 9) !== undefined;

export function readBop(root: Node): Findings {
  const found = new Findings();
  const images = perImage(root);
  const all: [string | undefined, Node][] = images.length > 0 ? images : [[undefined, root]];
  const first = all[0]?.[1] ?? root;
  const scale = numberOf(first.depth_scale);
  // DAIR-V2X has the lens of its camera as "cam_D"; BOP's pictures have none.
  const isRegistered = images.length > 0 || isPerMillimetre(scale ?? 1);
  const takes = isRegistered && first.cam_D === undefined ? "both" : undefined;
  const cameras = all.map(([name, node]) => cameraOf(node, root, name));
  const isOne = cameras.every(({ focal, centre }) =>
    [...focal, ...centre].every((value, at) => {
      const own = [...(cameras[0]?.focal ?? []), ...(cameras[0]?.centre ?? [])][at] ?? NaN;
      return Math.abs(value - own) < ALIKE;
    }),
  );
  for (const raw of isOne ? cameras.slice(0, 1) : cameras)
    found.camera(isOne ? { ...raw, name: "camera" } : raw, takes);
  if (scale !== undefined && scale > 0)
    found.depthUnit = isPerMillimetre(scale) ? scale * MILLIMETRE : scale < 1 ? scale : 1 / scale;
  else if (scale !== undefined)
    found.warn("unit-guessed", `Its depth_scale of ${scale} is not a unit and was not used.`);
  if (images.some(([, { depth_scale }]) => (numberOf(depth_scale) ?? scale) !== scale))
    found.warn(
      "units-differ",
      `The depth_scale differs between images. That of the first image, ${scale}, is used for all.`,
    );
  const posed = images.filter(([, node]) => "cam_R_w2c" in node).length;
  if (posed > 0)
    found.warn(
      "pose-left-out",
      `The file has ${posed} poses of the world in the camera, which are not extrinsics between two cameras and were left out.`,
    );
  return found;
}

function cameraOf(node: Node, root: Node, name: string | undefined): RawCamera {
  const n = (key: string) => numberOf(node[key]) ?? NaN;
  const k = flat(node.cam_K, 9) ?? [n("fx"), 0, n("cx"), 0, n("fy"), n("cy"), 0, 0, 1];
  const side = (key: string) => numberOf(node[key]) ?? numberOf(root[key]);
  const distortion = matrixOf(node.cam_D ?? root.cam_D)?.values;
  return { name, ...ofMatrix(k), distortion, width: side("width"), height: side("height") };
}
