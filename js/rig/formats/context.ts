/** Frames and units of a motion, as the objects around it specify them. */
import type { Frames } from "./ends.js";
import { angleOf, lengthOf, member } from "./names.js";
import { type Node, isNode } from "./numbers.js";

/** The frames and the units that the objects around a motion specify. */
export interface Context extends Frames {
  /** Metres per unit. */
  unit?: number;
  angle?: "degrees" | "radians";
}

/** The context with the units that members of an object specify for the others. */
export function contextOf(node: Node, frames: Context): Context {
  const said = member(node, "unit", "units", "lengthunit", "lengthunits", "translationunit", "translationunits");
  const turned = member(node, "angleunit", "angleunits", "rotationunit", "rotationunits", "unit", "units");
  const word = (value: unknown, ...names: string[]) => {
    const each = isNode(value) ? member(value, ...names) : value;
    return typeof each === "string" ? each : "";
  };
  const unit = lengthOf(word(said, "translation", "length", "position", "t"));
  const angle = angleOf(word(turned, "rotation", "angle", "angles", "r"));
  return { ...frames, ...(unit !== undefined && { unit }), ...(angle !== undefined && { angle }) };
}
