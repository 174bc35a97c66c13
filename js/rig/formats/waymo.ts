/**
 * Calibrations of the Waymo Open Dataset, its protocol buffers as JSON. A camera's frame there looks along x with z up, as the vehicle's
 * does; here it is turned to look along z with y down.
 */
import type { NamedPose } from "../types.js";
import { Findings, flat, parted } from "./findings.js";
import { isNode, type Node, numberOf } from "./numbers.js";
import { chained, poseOf } from "./poses.js";

/** From x right, y down, z forward to x forward, y left, z up. */
const OPTICAL = poseOf([0, 0, 1, -1, 0, 0, 0, -1, 0], [0, 0, 0]);

const listOf = (value: unknown): Node[] => (Array.isArray(value) ? value.filter(isNode) : []);
const contextOf = (root: Node): Node => (isNode(root.context) ? root.context : root);
const cameras = (root: Node): Node[] =>
  listOf(contextOf(root).cameraCalibrations ?? contextOf(root).camera_calibrations);
const lasers = (root: Node): Node[] => listOf(contextOf(root).laserCalibrations ?? contextOf(root).laser_calibrations);
const transform = (each: Node) => flat(isNode(each.extrinsic) ? each.extrinsic.transform : undefined, 16);

export const isWaymo = (root: Node): boolean =>
  [...cameras(root), ...lasers(root)].some(
    (each) => transform(each) !== undefined || flat(each.intrinsic, 9) !== undefined,
  );

export function readWaymo(root: Node): Findings {
  const found = new Findings();
  const eyes: NamedPose[] = [];
  for (const each of cameras(root)) {
    const name = `camera ${each.name ?? ""}`.trim();
    const [fx = NaN, fy = NaN, cx = NaN, cy = NaN, k1 = 0, k2 = 0, p1 = 0, p2 = 0, k3 = 0] =
      flat(each.intrinsic, 9) ?? [];
    found.camera({
      ...{ name, focal: [fx, fy], centre: [cx, cy], distortion: [k1, k2, p1, p2, k3] },
      ...{ width: numberOf(each.width), height: numberOf(each.height) },
    });
    const pose = posed(found, each, name);
    if (pose === undefined) continue;
    pose.pose = chained(pose.pose, OPTICAL);
    eyes.push(pose);
  }
  const lidars = lasers(root).map((each) => posed(found, each, `lidar ${each.name ?? ""}`.trim()));
  if (lidars.length === 1 && eyes.length === 1) found.relate(lidars[0], eyes[0]);
  return found.done("a calibration of Waymo's dataset");
}

function posed(found: Findings, each: Node, from: string) {
  const m = transform(each);
  return m && found.pose(...parted(m), { name: `vehicle from ${from}`, from, to: "vehicle" });
}
