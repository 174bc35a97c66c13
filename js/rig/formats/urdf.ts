/**
 * Robot descriptions, URDF and xacro: a joint's origin carries points of the child link into the parent link, by a translation and by roll,
 * pitch and yaw about fixed axes. Properties and their arithmetic are evaluated. Macros are not evaluated, and joints that depend on
 * their parameters are left out with a warning.
 */
import { badFile } from "../../errors.js";
import type { NamedPose } from "../types.js";
import { evaluate } from "./expression.js";
import { Findings } from "./findings.js";
import { wayBetween } from "./frames.js";
import { type Numbers, numberOf } from "./numbers.js";
import { ofYawPitchRoll } from "./poses.js";
import type { Element } from "./xml.js";

const MOST_JOINTS = 5000;
const MOST_NESTED = 10;
const MOVING = /^(?:revolute|continuous|prismatic|planar|floating)$/;

function* all(element: Element): Generator<Element> {
  for (const child of element.children) {
    yield child;
    yield* all(child);
  }
}

export const isUrdf = (root: Element): boolean => root.children.some(({ tag }) => tag === "robot");

/** The value of a property by its name, which may be an expression of other properties. */
function properties(root: Element): (name: string) => number | undefined {
  const texts = new Map<string, string>();
  for (const { tag, attributes } of all(root))
    if (/^(?:xacro:)?(?:property|arg)$/.test(tag) && attributes.name !== undefined)
      texts.set(attributes.name, attributes.value ?? attributes.default ?? "");
  let depth = 0;
  const valueOf = (name: string): number | undefined => {
    const text = texts.get(name);
    if (text === undefined || depth > MOST_NESTED) return undefined;
    depth++;
    const value = numberOf(text) ?? evaluate(text.replace(/^\$\{(.*)\}$/s, "$1"), valueOf);
    depth--;
    return value;
  };
  return valueOf;
}

/** Three numbers or expressions; undefined where a name in them has no value. */
function triple(text: string | undefined, valueOf: (name: string) => number | undefined): Numbers | undefined {
  if (text === undefined) return [0, 0, 0];
  const values = (text.match(/\$\{[^}]*\}|\$\([^)]*\)|\S+/g) ?? []).map((part) => {
    const [, inner, name] = /^\$\{(.*)\}$/s.exec(part) ?? /^\$\((?:arg\s+)?()(.*)\)$/s.exec(part) ?? [];
    if (inner) return evaluate(inner, valueOf);
    return name ? valueOf(name.trim()) : numberOf(part);
  });
  return values.length === 3 && values.every((value) => value !== undefined) ? values : undefined;
}

export function readUrdf(root: Element): Findings {
  const found = new Findings();
  const valueOf = properties(root);
  const missing: string[] = [];
  /** Joints that move, by their child links. */
  const moving = new Map<string, string>();
  let count = 0;
  for (const joint of all(root)) {
    if (joint.tag !== "joint" || !joint.children.some(({ tag }) => tag === "parent")) continue;
    if (++count > MOST_JOINTS) throw badFile(`it has more than ${MOST_JOINTS} joints`);
    const child = (tag: string) => joint.children.find((each) => each.tag === tag);
    const link = (tag: string) => (child(tag)?.attributes.link ?? "").replace(/\$[{(](?:arg )?([^})]*)[})]/g, "$1");
    const [from, to] = [link("child"), link("parent")];
    const origin = child("origin");
    const hidden = joint.children.some(({ tag }) => tag.includes("insert_block")) && origin === undefined;
    const [xyz, rpy] = [triple(origin?.attributes.xyz, valueOf), triple(origin?.attributes.rpy, valueOf)];
    const name = joint.attributes.name ?? `${from} in ${to}`;
    if (MOVING.test(joint.attributes.type ?? "")) moving.set(from, name);
    if (hidden || xyz === undefined || rpy === undefined) missing.push(name);
    else found.pose(ofYawPitchRoll(rpy.slice().reverse()), xyz, { name, from, to });
  }
  if (missing.length > 0)
    found.warn(
      "pose-left-out",
      `The origin of ${missing.length === 1 ? "the joint" : `${missing.length} joints, such as`} "${missing[0]?.slice(0, 60)}" depends on a macro's parameters and was left out. Expand the file with xacro first.`,
    );
  if (found.poses.length === 0)
    throw badFile(
      missing.length > 0
        ? "it is a robot description (URDF), and the origins of its joints depend on a macro's parameters; expand it with xacro first"
        : "it is a robot description (URDF) without a joint",
    );
  const links = found.poses.slice();
  toCameras(found);
  const joints = betweenOf(links, found.poses[0]).flatMap((link) => moving.get(link) ?? []);
  if (joints.length > 0)
    found.warn(
      "pose-assumed",
      `The joint ${joints
        .slice(0, 4)
        .map((name) => `"${name.slice(0, 60)}"`)
        .join(
          ", ",
        )} between the sensors moves. Its zero position was used, because the file does not give another one. Give the pose at the position of the pictures.`,
    );
  return found;
}

/** The child links of the joints between the two frames of a pose. */
function betweenOf(links: readonly NamedPose[], pose: NamedPose | undefined): string[] {
  const parents = new Map(links.map(({ from = "", to = "" }) => [from, to]));
  const upwards = (link = "") => {
    const way: string[] = [];
    for (let at = link; parents.has(at) && !way.includes(at); at = parents.get(at) ?? "") way.push(at);
    return way;
  };
  const [one, other] = [upwards(pose?.from), upwards(pose?.to)];
  return [...one.filter((link) => !other.includes(link)), ...other.filter((link) => !one.includes(link))];
}

/** Puts the pose between the cameras first. */
export function toCameras(found: Findings): void {
  const way = wayBetween(found.poses);
  if (way === undefined) return;
  found.poses.unshift(way.pose);
  found.warnings.push(...way.warnings);
}
