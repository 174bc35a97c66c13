/**
 * Cameras of the BOP benchmark: camera.json of a data set, scene_camera.json of a scene. `depth_scale` times a stored depth is in
 * millimetres, and depth maps are registered to the colour images.
 */
import { Findings, flat } from "./findings.js";
import { isNode, type Node, numberOf } from "./numbers.js";

const MILLIMETRE = 0.001;
/** What cameras of one scene may differ by, as a share of the focal length, to be one. */
const ALIKE = 1e-6;

/** Other programs give metres per unit, or units per metre, under the same name: these are much less or much more. */
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
  const first = (all[0] as [string, Node])[1];
  const isOfBop = images.length > 0 || isPerMillimetre(numberOf(first.depth_scale) ?? 1);
  const units = new Set<number>();
  const seen: string[] = [];
  for (const [name, node] of all) {
    const n = (key: string) => numberOf(node[key]) ?? NaN;
    const k = flat(node.cam_K, 9) ?? [n("fx"), 0, n("cx"), 0, n("fy"), n("cy"), 0, 0, 1];
    const scale = numberOf(node.depth_scale);
    if (scale !== undefined && scale > 0) units.add(scale);
    const [fx = NaN, skew = 0, cx = NaN, , fy = NaN, cy = NaN] = k;
    const digits = (value: number) => Math.round(value / ALIKE / (fx || 1));
    const key = [fx, fy, cx, cy].map(digits).join();
    if (seen.includes(key)) continue;
    seen.push(key);
    found.camera(
      {
        ...{ name: seen.length === 1 ? "camera" : name, focal: [fx, fy], centre: [cx, cy], skew },
        ...{
          width: numberOf(node.width) ?? numberOf(root.width),
          height: numberOf(node.height) ?? numberOf(root.height),
        },
      },
      isOfBop ? "both" : undefined,
    );
  }
  const scale = numberOf(first.depth_scale);
  if (scale !== undefined && scale > 0)
    found.depthUnit = isPerMillimetre(scale) ? scale * MILLIMETRE : scale < 1 ? scale : 1 / scale;
  if (units.size > 1)
    found.warn(
      "units-differ",
      `Its depth_scale differs between images (${[...units].slice(0, 4).join(", ")}); the first is used for all.`,
    );
  if (seen.length > 1)
    found.warn(
      "intrinsics-vary",
      `Its images have ${seen.length} different cameras; a frame has that of the first, unless its name is that of another.`,
    );
  const shown = images.filter(([, node]) => "cam_R_w2c" in node).length;
  if (shown > 0)
    found.warn(
      "pose-left-out",
      `The ${shown} poses of the world in the camera were left out: they relate no two cameras.`,
    );
  return found.done("a camera of the BOP benchmark");
}
