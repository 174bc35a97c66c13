/**
 * Calibrations of the Waymo Open Dataset, whose protocol buffers come as JSON or text. Its cameras look along x with z up, as the vehicle
 * does, and are turned to look along z with y down.
 */
import { badFile } from "../../errors.js";
import type { NamedPose } from "../types.js";
import { Findings, flat } from "./findings.js";
import { asOptical, hasBodyAxes } from "./frames.js";
import { isNode, type Node, nodesOf, numberOf } from "./numbers.js";
import { parted } from "./poses.js";

const contextOf = (root: Node): Node => {
  const context = Array.isArray(root.context) ? root.context[0] : root.context;
  return isNode(context) ? context : root;
};
const cameras = (root: Node): Node[] =>
  nodesOf(contextOf(root).cameraCalibrations ?? contextOf(root).camera_calibrations);
const lasers = (root: Node): Node[] => nodesOf(contextOf(root).laserCalibrations ?? contextOf(root).laser_calibrations);
/** The value of a member. In protobuf's text every member is read as a list, because any may be repeated. */
const single = (value: unknown): unknown => (Array.isArray(value) && value.length === 1 ? value[0] : value);
const transform = (each: Node) => {
  const extrinsic = single(each.extrinsic);
  return flat(isNode(extrinsic) ? extrinsic.transform : undefined, 16);
};

const HEAD = /(?:^|\n)[ \t]*(?:camera_calibrations|laser_calibrations)[ \t]*\{/;
export const isWaymoText = (text: string): boolean => HEAD.test(text);

/** Largest number of nested blocks; a calibration has four. */
const MOST_OPEN = 16;

/** Protobuf's text format: "name: value" lines and "name { .. }" blocks, which may be repeated. */
export function readWaymoText(text: string): Findings {
  const root: Node = {};
  const open: Node[] = [root];
  const add = (key: string, value: unknown) => {
    const node = open.at(-1) as Node;
    const known = node[key];
    if (Array.isArray(known)) known.push(value);
    else node[key] = [value];
  };
  for (const [, key = "", value = "", block, close] of text.matchAll(
    /(\w+)\s*:\s*("[^"\n]*"|[^\s{}]+)|(\w+)\s*\{|(\})/g,
  )) {
    if (close) open.splice(Math.max(1, open.length - 1));
    else if (block) {
      const inner: Node = {};
      add(block, inner);
      if (open.length >= MOST_OPEN) throw badFile("it is nested deeper than any calibration of Waymo's");
      open.push(inner);
    } else add(key, numberOf(value) ?? value.replace(/"/g, ""));
  }
  return readWaymo(root);
}

export const isWaymo = (root: Node): boolean =>
  [...cameras(root), ...lasers(root)].some(
    (each) => transform(each) !== undefined || flat(each.intrinsic, 9) !== undefined,
  );

export function readWaymo(root: Node): Findings {
  const found = new Findings();
  const eyes: NamedPose[] = [];
  for (const each of cameras(root)) {
    const name = `camera ${single(each.name) ?? ""}`.trim();
    const [fx = NaN, fy = NaN, cx = NaN, cy = NaN, k1 = 0, k2 = 0, p1 = 0, p2 = 0, k3 = 0] =
      flat(each.intrinsic, 9) ?? [];
    found.camera({
      ...{ name, focal: [fx, fy], centre: [cx, cy], distortion: [k1, k2, p1, p2, k3] },
      ...{ width: numberOf(single(each.width)), height: numberOf(single(each.height)) },
    });
    const pose = posed(found, each, name);
    if (pose === undefined) continue;
    if (hasBodyAxes(pose.pose)) pose.pose = asOptical(pose.pose);
    eyes.push(pose);
  }
  const lidars = lasers(root).map((each) => posed(found, each, `lidar ${single(each.name) ?? ""}`.trim()));
  if (lidars.length === 1 && eyes.length === 1) found.relate(lidars[0], eyes[0]);
  return found;
}

function posed(found: Findings, each: Node, from: string) {
  const m = transform(each);
  return m && found.pose(...parted(m), { name: `vehicle from ${from}`, from, to: "vehicle" });
}
