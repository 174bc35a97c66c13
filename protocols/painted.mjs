// Renders of objects with varying albedo: two to eight colours in stripes or patches, nothing known.
import { drawScene } from "./anywhere.mjs";
import { chance } from "./numbers.mjs";
import { measuredRows, randomRow } from "./counts.mjs";
import { FROM_ANYWHERE, requestOf } from "./scenes.mjs";
import { judged, optionsOf, withRun } from "./runs.mjs";

const SCENES = 60;
const QUICK_SCENES = 2;
/** Number of albedos of an object, their darkest channel, and the width of a stripe in pixels. */
const PAINTS = [2, 8];
const DARKEST = 0.15;
const STRIPES = [5, 20];
/** Share of the objects with stripes; the others have patches. */
const STRIPED = 0.4;

export const painted = {
  name: "painted",
  title:
    "Renders with varying albedo: random scenes at 96x96, two to eight colours in stripes or patches, nothing known",
  cells: (kit, quick) =>
    Array.from({ length: quick ? QUICK_SCENES : SCENES }, (_, index) => ({
      id: `painted/${index + 1}`,
      kind: "painted",
      row: { scene: index + 1 },
      kit,
      seed: index + 1,
      options: FROM_ANYWHERE,
    })),
  rows: (results) => randomRow(measuredRows(results)),
};

/** Multiplies linear RGB colours by varying albedo, in place, for an image of this width; `striped` undefined chooses at random. */
export function paint(colours, width, dice, striped) {
  const palette = Array.from({ length: PAINTS[0] + dice.below(PAINTS[1] - PAINTS[0] + 1) }, () =>
    [0, 1, 2].map(() => dice.uniform(DARKEST, 1)),
  );
  const [angle, stripe, chosen] = [dice.uniform(0, 2 * Math.PI), dice.uniform(...STRIPES), dice.uniform() < STRIPED];
  for (let index = 0; index < colours.length / 3; index++) {
    const [column, row] = [index % width, Math.floor(index / width)];
    const along = Math.floor((column * Math.cos(angle) + row * Math.sin(angle)) / stripe);
    const across = Math.floor((row * Math.cos(angle) - column * Math.sin(angle)) / (1.3 * stripe));
    const number = (striped ?? chosen) ? along : 7 * along + 3 * across;
    const hue = palette[((number % palette.length) + palette.length) % palette.length];
    for (let channel = 0; channel < 3; channel++) colours[3 * index + channel] *= hue[channel];
  }
}

export async function measurePainted(cell, api, library) {
  const dice = chance(cell.seed);
  const scene = { ...drawScene(dice, cell.kit, library.gaussian), seed: cell.seed };
  const made = api.sample(requestOf(scene, library));
  const data = made.image.data.slice();
  paint(data, scene.size, dice);
  const pair = { image: { ...made.image, data }, depth: made.depth };
  const { surface, overlap, angles, scale } = scene;
  return withRun(api, pair, optionsOf(cell.options, made), (report, _, milliseconds) => ({
    ...{ surface, overlap, trueAngles: angles, trueScale: scale },
    ...judged(report, made.pose, milliseconds),
  }));
}
