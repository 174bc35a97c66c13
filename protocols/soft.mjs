// Renders of objects whose albedo varies smoothly: noise fields of several scales, linear gradients, or both; nothing known.
import { drawScene } from "./anywhere.mjs";
import { measuredRows, rowByKind } from "./counts.mjs";
import { chance } from "./numbers.mjs";
import { judged, optionsOf, withRun } from "./runs.mjs";
import { FROM_ANYWHERE, requestOf } from "./scenes.mjs";

const SCENES = 100;
const QUICK_SCENES = 2;
/** Constants are set on odd scenes. */
const HALVES = ["held out", "tuned"];
/** What the albedo consists of, and the share of scenes with each. */
const MIXES = [
  { field: 1, ramp: 0, share: 0.5 },
  { field: 0, ramp: 1, share: 0.15 },
  { field: 1, ramp: 0.7, share: 0.35 },
];
/** Wavelengths of a noise field in pixels: each scene draws an octave or more within this range. */
const WAVELENGTHS = [8, 64];
const LEAST_BAND = 2;
/** Number of plane waves that make a field. */
const WAVES = 24;
/** Standard deviation of the log albedo over the object and the channels. */
const SPREAD = [0.15, 0.5];

export const soft = {
  name: "soft",
  title:
    "Renders with smooth albedo: random scenes at 96x96, noise fields of 8 to 64 pixels and gradients, grey to independent channels",
  cells: (kit, quick) =>
    Array.from({ length: quick ? QUICK_SCENES : SCENES }, (_, index) => ({
      id: `soft/${index + 1}`,
      kind: "soft",
      row: { scene: index + 1, half: HALVES[(index + 1) % 2] },
      kit,
      seed: index + 1,
      options: FROM_ANYWHERE,
    })),
  /** One row for all scenes, and one for each half. */
  rows: (results) => rowByKind(measuredRows(results), [{ key: "half", values: HALVES }]),
};

const logUniform = (dice, low, high) => low * (high / low) ** dice.uniform();

/** A sum of plane waves within a band, as a function of column and row. Long waves are as strong as short ones. */
function noiseField(dice, [shortest, longest]) {
  const waves = Array.from({ length: WAVES }, () => {
    const [angle, length] = [dice.uniform(0, 2 * Math.PI), logUniform(dice, shortest, longest)];
    const step = (2 * Math.PI) / length;
    return [step * Math.cos(angle), step * Math.sin(angle), dice.uniform(0, 2 * Math.PI)];
  });
  const scale = Math.sqrt(2 / WAVES);
  return (column, row) => scale * waves.reduce((sum, [x, y, phase]) => sum + Math.cos(x * column + y * row + phase), 0);
}

/** A linear gradient with a standard deviation of about one over the image. */
function ramp(dice, width) {
  const angle = dice.uniform(0, 2 * Math.PI);
  const slope = Math.sqrt(12) / width;
  const middle = (width - 1) / 2;
  return (column, row) => slope * ((column - middle) * Math.cos(angle) + (row - middle) * Math.sin(angle));
}

/** One function of the pixel for each channel; `grey` is the correlation of the channels. */
function channelsOf(draw, grey) {
  const [common, ...own] = [draw(), draw(), draw(), draw()];
  const [shared, separate] = [Math.sqrt(grey), Math.sqrt(1 - grey)];
  return own.map((field) => (column, row) => shared * common(column, row) + separate * field(column, row));
}

function drawMix(dice) {
  let left = dice.uniform();
  return MIXES.find(({ share }) => (left -= share) < 0) ?? MIXES[0];
}

/** Multiplies linear RGB colours by smooth albedo, in place, for an image of this width with this mask. */
export function paintSoftly(colours, width, mask, dice) {
  const mix = drawMix(dice);
  const shortest = logUniform(dice, WAVELENGTHS[0], WAVELENGTHS[1] / LEAST_BAND);
  const band = [shortest, logUniform(dice, LEAST_BAND * shortest, WAVELENGTHS[1])];
  const [grey, spread] = [dice.uniform(), dice.uniform(...SPREAD)];
  const fields = channelsOf(() => noiseField(dice, band), grey);
  const ramps = channelsOf(() => ramp(dice, width), grey);
  const pixels = [...mask.keys()].filter((index) => mask[index]);
  const log = pixels.map((index) => {
    const [column, row] = [index % width, Math.floor(index / width)];
    return [0, 1, 2].map(
      (channel) => mix.field * fields[channel](column, row) + mix.ramp * ramps[channel](column, row),
    );
  });
  const means = [0, 1, 2].map((channel) => log.reduce((sum, values) => sum + values[channel], 0) / log.length);
  const offs = log.map((values) => values.map((value, channel) => value - means[channel]));
  const squares = offs.flat().reduce((sum, off) => sum + off * off, 0);
  const gain = spread / Math.sqrt(squares / (3 * log.length));
  for (const [place, index] of pixels.entries()) {
    for (let channel = 0; channel < 3; channel++) colours[3 * index + channel] *= Math.exp(gain * offs[place][channel]);
  }
}

export async function measureSoft(cell, api, library) {
  const dice = chance(cell.seed);
  const scene = { ...drawScene(dice, cell.kit, library.gaussian), seed: cell.seed };
  const made = api.sample(requestOf(scene, library));
  const data = made.image.data.slice();
  paintSoftly(data, scene.size, made.image.mask, dice);
  const pair = { image: { ...made.image, data }, depth: made.depth };
  const { surface, overlap, angles, scale } = scene;
  return withRun(api, pair, optionsOf(cell.options, made), (report, _, milliseconds) => ({
    ...{ surface, overlap, trueAngles: angles, trueScale: scale },
    ...judged(report, made.pose, milliseconds),
  }));
}
