/** Which colour image and which depth map belong together, according to their names. */

import type { Frame, Item, RigState } from "./state";

/** The part of a name that does not state its role: "depth/0001.png" and "rgb/0001.jpg" are both "0001". */
export function keyOf(name: string): string {
  return name
    .toLowerCase()
    .replace(/\.[a-z0-9]+$/, "")
    .replace(/colou?r|rgb|image|img|depth|disparity|mask|raw|registered|aligned|mm|crop/g, "")
    .split(/[^a-z0-9]+/)
    .filter(Boolean)
    .join(" ");
}

/** The existing frames with new files paired: by matching names first, otherwise in the order of their names. */
export function pairUp(rig: RigState): Frame[] {
  const frames = rig.frames.map((frame) => frame);
  const used = (role: "colour" | "depth" | "mask") => new Set(frames.map((frame) => frame[role]));
  const left = (role: "colour" | "depth" | "mask") =>
    rig.of(role).filter(({ id, aside }) => !aside && !used(role).has(id));

  for (const role of ["colour", "depth"] as const) {
    const other = role === "colour" ? "depth" : "colour";
    for (const item of left(role)) {
      const frame = frames.find(
        (each) => each[role] === undefined && keyOf(rig.item(each[other])?.name ?? "") === keyOf(item.name),
      );
      if (frame) frame[role] = item.id;
    }
  }
  const colours = left("colour");
  for (const depth of left("depth")) {
    const i = colours.findIndex((colour) => keyOf(colour.name) === keyOf(depth.name));
    if (i < 0) continue;
    const [colour] = colours.splice(i, 1);
    frames.push(fresh(rig, frames, colour, depth));
  }
  const byName = (a: Item, b: Item) => a.name.localeCompare(b.name, undefined, { numeric: true });
  const lonely = (role: "colour" | "depth") => frames.filter((frame) => frame[role] === undefined);
  const restDepths = left("depth").sort(byName);
  for (const colour of left("colour").sort(byName)) {
    const waiting = lonely("colour")[0];
    if (waiting) waiting.colour = colour.id;
    else frames.push(fresh(rig, frames, colour, restDepths.shift()));
  }
  for (const depth of restDepths) {
    const waiting = lonely("depth")[0];
    if (waiting) waiting.depth = depth.id;
    else frames.push(fresh(rig, frames, undefined, depth));
  }
  for (const mask of left("mask")) {
    const frame =
      frames.find((each) => each.mask === undefined && keyOf(rig.item(each.colour)?.name ?? "") === keyOf(mask.name)) ??
      (frames.length === 1 && frames[0]?.mask === undefined ? frames[0] : undefined);
    if (frame) frame.mask = mask.id;
  }
  return frames;
}

function fresh(rig: RigState, frames: readonly Frame[], colour: Item | undefined, depth: Item | undefined): Frame {
  const number = 1 + Math.max(0, ...frames.map(({ name }) => Number(/^frame (\d+)$/.exec(name)?.[1] ?? 0)));
  return {
    id: rig.freshId(),
    name: `frame ${number}`,
    ...(colour ? { colour: colour.id } : {}),
    ...(depth ? { depth: depth.id } : {}),
  };
}
