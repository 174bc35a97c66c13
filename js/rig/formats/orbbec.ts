/**
 * Files of Orbbec's SDK and viewer: the intrinsics of both cameras, and a transform from the depth camera to the colour camera in
 * millimetres, in JSON ("rgbIntrinsic", "transform") or in sections ("ColorIntrinsic", "D2CTransformParam").
 */
import type { Context } from "./context.js";
import { type Node, isNode, matrixOf } from "./numbers.js";

const COLOUR = /^(?:rgb|colou?r)_?intrinsics?$/i;
const DEPTH = /^depth_?intrinsics?$/i;
const TRANSFORM = /^(?:transform|d2c_?transform(?:_?param)?|d2c_?extrinsics?|extrinsics?)$/i;
/** Longest translation in metres; a longer one is in the SDK's millimetres, because the cameras of a product are not a metre apart. */
const LONGEST = 1;

/** The frames and the unit of a member that is Orbbec's transform. */
export function orbbecContext(node: Node, key: string): Context | undefined {
  if (!TRANSFORM.test(key)) return undefined;
  const keys = Object.keys(node);
  if (!keys.some((each) => COLOUR.test(each)) || !keys.some((each) => DEPTH.test(each))) return undefined;
  const value = node[key];
  if (!isNode(value)) return undefined;
  const listed = matrixOf(value.trans ?? value.translation)?.values;
  const shift = listed ?? ["trans0", "trans1", "trans2"].map((each) => Number(value[each]));
  const isLong = Math.hypot(...shift) > LONGEST;
  return { from: "depth", to: "color", ...(isLong && { unit: 1e-3 }) };
}
