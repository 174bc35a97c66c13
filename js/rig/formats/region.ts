/**
 * ROS's CameraInfo describes the whole sensor; its pictures show only the region of interest, with pixels binned. By its definition, the
 * region's corner is subtracted from the principal point, and the intrinsics are then divided by the binning.
 */
import { scaledCamera } from "../scale.js";
import type { RawCamera } from "./cameras.js";
import { member } from "./names.js";
import { type Node, isNode, numberOf } from "./numbers.js";

/** The camera of the pictures that remain after the region of interest and binning are applied. */
export function ofRegion(raw: RawCamera, node: Node): RawCamera {
  const roi = member(node, "roi");
  const inRegion = (key: string) => (isNode(roi) ? (numberOf(member(roi, key)) ?? 0) : 0);
  const binned = (key: string) => Math.max(1, numberOf(member(node, key)) ?? 1);
  const [x, y, bx, by] = [inRegion("xoffset"), inRegion("yoffset"), binned("binningx"), binned("binningy")];
  const width = inRegion("width") || raw.width;
  const height = inRegion("height") || raw.height;
  if (width === undefined || height === undefined || (raw.width === undefined && !isNode(roi))) return raw;
  // Some drivers give the size and the intrinsics of the region itself.
  if (raw.width !== undefined && raw.height !== undefined && (x + width > raw.width || y + height > raw.height))
    return raw;
  if (x === 0 && y === 0 && bx === 1 && by === 1 && width === raw.width && height === raw.height) return raw;
  const [fx = NaN, fy = fx] = raw.focal;
  const [cx = NaN, cy = NaN] = raw.centre;
  const size: [number, number] = [Math.floor(width / bx), Math.floor(height / by)];
  const whole: [number, number] = [size[0] * bx, size[1] * by];
  const camera = scaledCamera({ fx, fy, cx: cx - x, cy: cy - y }, whole, size);
  return { ...raw, focal: [camera.fx, camera.fy], centre: [camera.cx, camera.cy], width: size[0], height: size[1] };
}
