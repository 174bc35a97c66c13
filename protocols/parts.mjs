// Two pinhole cameras, an object whose albedo varies smoothly, and a depth map that shows a part of it from nearer; nothing known.
import { measuredRows, rowByKind } from "./counts.mjs";
import { chance } from "./numbers.mjs";
import { drawPair, run } from "./measure-perspective.mjs";
import { PINHOLE } from "./perspectives.mjs";
import { FROM_ANYWHERE } from "./scenes.mjs";
import { paintSoftly } from "./soft.mjs";

const KINDS = ["whole depth map", "part of it"];
const SCENES = 60;
const QUICK_SCENES = 2;
/** How many times nearer the depth camera may be. */
const NEARER = [1, 1.5];
/** Share of the depth map's columns that is kept, centred, in all but every third scene. */
const PART = [0.45, 0.95];

export const parts = {
  name: "parts",
  title:
    "Two pinhole cameras, smooth albedo, nothing known: 160x120, the depth map whole or cut to 45 to 95 % of its columns, from up to 1.5 times nearer",
  cells: (kit, quick) =>
    Array.from({ length: quick ? QUICK_SCENES : SCENES }, (_, index) => ({
      id: `parts/${index + 1}`,
      kind: "parts",
      row: { scene: index + 1, kind: KINDS[index % 3 === 2 ? 0 : 1] },
      kit,
      seed: index + 1,
      ...PINHOLE,
      nearer: NEARER,
      part: index % 3 === 2 ? null : PART,
      options: FROM_ANYWHERE,
    })),
  /** One row for all scenes, and one for each kind. */
  rows: (results) => rowByKind(measuredRows(results), [{ key: "kind", values: KINDS }]),
};

/** The mask without the columns outside the centred share of those that have depth. */
function cut({ width, mask }, share) {
  const columns = mask.flatMap((inside, index) => (inside ? [index % width] : []));
  const [first, last] = columns.reduce(([low, high], at) => [Math.min(low, at), Math.max(high, at)], [width, 0]);
  const [middle, half] = [(first + last) / 2, (share * (last - first + 1)) / 2];
  return Uint8Array.from(mask, (inside, index) => Number(inside && Math.abs((index % width) - middle) <= half));
}

export function measureParts(cell, api, library) {
  const dice = chance(cell.seed);
  const { image, depth, truth } = drawPair(cell, api, library, dice);
  paintSoftly(image.data, image.width, image.mask, dice);
  const mask = cell.part ? cut({ width: depth.width, mask: [...depth.mask] }, dice.uniform(...cell.part)) : depth.mask;
  return run(cell, api, { image, depth: { ...depth, mask }, truth });
}
