/** Members of one object that belong together by their names: "Camera.fx" and "Camera.fy", "cam_fx" and "cam_d0", "rot0" to "rot8". */
import { type Node, type Numbers, isNode, matrixOf, numberOf } from "./numbers.js";

/** Largest number of groups of one object. */
const MOST = 300;
/** Lengths of the lists in cameras and motions. */
const LENGTHS = new Set([3, 4, 5, 8, 9, 12, 14, 16]);

/** The members of a group, which are those whose names `part` accepts; the rest of the name is the key. */
function taken(node: Node, keys: string[], part: (key: string) => string | undefined): Node {
  const group: Node = {};
  for (const key of keys) {
    const name = part(key);
    if (name !== undefined && name !== "__proto__") group[name] = node[key];
  }
  return group;
}

const behind = (start: string) => (key: string) => (key.startsWith(start) ? key.slice(start.length) : undefined);
const before = (end: string) => (key: string) => (key.endsWith(end) ? key.slice(0, -end.length) : undefined);

const DOTTED = /^(\w{1,40})\.(\w{1,40})$/;
const isObject = (value: unknown): boolean => isNode(value) && matrixOf(value) === undefined;

/** Whether a member is read only as part of its group: "IMU.T_b_c1" of ORB-SLAM. */
export const isOfGroup = (node: Node, key: string): boolean => DOTTED.test(key) && !isObject(node[key]);

/** Coefficients by plain names, which belong to the only camera with a prefix: "k1" beside "cam_fx" (vikit, FAST-LIVO2). */
function plainLens(node: Node, keys: string[]): Node {
  const cameras = keys.filter((key) => /(?:^|_)fx(?:_|$)/i.test(key));
  return cameras.length === 1 ? taken(node, keys, (key) => (/^[kp]\d$/i.test(key) ? key : undefined)) : {};
}

/** The members of each camera by its name, from "Camera.fx" (ORB-SLAM), "cam_fx" (vikit) or "fx_rgb". */
export function grouped(node: Node, keys: string[]): Map<string, Node> {
  const groups = new Map<string, Node>();
  for (const key of keys) {
    if (groups.size > MOST) break;
    const [, group, name] = DOTTED.exec(key) ?? [];
    if (group !== undefined && name !== undefined && isOfGroup(node, key))
      groups.set(group, { ...groups.get(group), [name]: node[key] });
  }
  for (const key of keys) {
    if (groups.size > MOST) break;
    const [, first] = /^(\w{1,30})_fx$/i.exec(key) ?? [];
    const [, last] = /^fx_(\w{1,30})$/i.exec(key) ?? [];
    if (first !== undefined) groups.set(first, { ...plainLens(node, keys), ...taken(node, keys, behind(`${first}_`)) });
    else if (last !== undefined) groups.set(last, taken(node, keys, before(`_${last}`)));
  }
  return groups;
}

/** The object with a list "rot" for its numbers "rot0" to "rot8". */
export function withLists(node: Node): Node {
  const lists = new Map<string, Map<number, number>>();
  const keys = Object.keys(node);
  const starts = keys.flatMap((key) => /^(\w{1,30}_)fx$/i.exec(key)?.[1] ?? []);
  for (const key of keys) {
    if (starts.some((start) => key.startsWith(start))) continue;
    const [, stem = "", digits] = /^([A-Za-z_]{1,30}?)_?(\d{1,2})$/.exec(key) ?? [];
    const value = digits === undefined ? undefined : numberOf(node[key]);
    if (value === undefined) continue;
    const list = lists.get(stem) ?? new Map<number, number>();
    lists.set(stem, list.set(Number(digits), value));
  }
  const whole: Record<string, Numbers> = {};
  for (const [stem, list] of lists) {
    const values = Array.from({ length: list.size }, (_, at) => list.get(at));
    // A single number is allowed, because a lens may have one coefficient.
    const isLength = LENGTHS.has(list.size) || stem === "d";
    const isWhole = isLength && values.every((value) => value !== undefined);
    if (isWhole && !Object.hasOwn(node, stem)) whole[stem] = values as Numbers;
  }
  return Object.keys(whole).length === 0 ? node : { ...node, ...whole };
}
