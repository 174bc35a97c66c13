// Renders with the flaws of a camera's lens and sensor: vignetting, noise that grows with the signal, one colour per pixel.
import { drawScene } from "./anywhere.mjs";
import { chance } from "./numbers.mjs";
import { measuredRows, rowByKind } from "./counts.mjs";
import { FROM_ANYWHERE, requestOf } from "./scenes.mjs";
import { judged, optionsOf, withRun } from "./runs.mjs";

const SCENES = 60;
const QUICK_SCENES = 3;
/** Half the diagonal field of view of a phone's camera, degrees. */
const HALF_FIELD = 35;
/** Sigmas of shot noise at full signal and of read noise, shares of full signal: a small sensor indoors. */
const SHOT = 0.02;
const READING = 0.004;

/** Vignetting: cos^4 of the angle to the axis. */
function vignetted({ width, height, data }) {
  const slope = Math.tan((Math.PI / 180) * HALF_FIELD) / Math.hypot(width / 2, height / 2);
  return data.map((value, index) => {
    const pixel = Math.floor(index / 3);
    const off = slope * Math.hypot((pixel % width) - (width - 1) / 2, Math.floor(pixel / width) - (height - 1) / 2);
    return value / (1 + off * off) ** 2;
  });
}

/** Adds shot noise, whose variance is proportional to the signal, and read noise, which is constant. */
function grained({ data }, dice) {
  const full = data.reduce((most, value) => Math.max(most, value), 0);
  return data.map((value) =>
    Math.max(0, value + full * (SHOT * Math.sqrt(Math.max(value, 0) / full) + READING) * dice.gaussian()),
  );
}

/** A Bayer pattern: each pixel measures red, green or blue; the other two are weighted means of neighbours, with nearer ones counted twice. */
function mosaicked({ width, height, data }) {
  const measured = (column, row) => (column % 2 === row % 2 ? 2 * (row % 2) : 1);
  return data.map((value, index) => {
    const [pixel, channel] = [Math.floor(index / 3), index % 3];
    let [sum, weights] = [0, 0];
    for (let k = 0; k < 9; k++) {
      const [right, down] = [(k % 3) - 1, Math.floor(k / 3) - 1];
      const [column, row] = [(pixel % width) + right, Math.floor(pixel / width) + down];
      const isInside = column >= 0 && row >= 0 && column < width && row < height;
      if (!isInside || measured(column, row) !== channel) continue;
      const weight = (2 - Math.abs(right)) * (2 - Math.abs(down));
      sum += weight * data[3 * (row * width + column) + channel];
      weights += weight;
    }
    return weights > 0 ? sum / weights : value;
  });
}

const FLAWS = { vignetting: vignetted, "shot noise": grained, "colour filters": mosaicked };
const NAMES = Object.keys(FLAWS);

export const cameras = {
  name: "cameras",
  title: "Renders with the faults of cameras: random scenes at 96x96, nothing known",
  notes: [
    `vignetting: cos^4, ${HALF_FIELD} degrees at the corner; shot noise: ${100 * SHOT} % at full signal, ${100 * READING} % of reading; colour filters: Bayer's, bilinear`,
  ],
  cells: (kit, quick) =>
    Array.from({ length: quick ? QUICK_SCENES : SCENES }, (_, index) => ({
      id: `cameras/${index + 1}`,
      kind: "camera",
      row: { scene: index + 1, flaw: NAMES[index % NAMES.length] },
      kit,
      seed: index + 1,
      options: FROM_ANYWHERE,
    })),
  /** One row for all cells, and one for each kind. */
  rows: (results) => rowByKind(measuredRows(results), [{ key: "flaw", values: NAMES }]),
};

export async function measureCamera(cell, api, library) {
  const dice = chance(cell.seed);
  const scene = { ...drawScene(dice, cell.kit, library.gaussian), seed: cell.seed };
  const made = api.sample(requestOf(scene, library));
  const pair = { image: { ...made.image, data: FLAWS[cell.row.flaw](made.image, dice) }, depth: made.depth };
  const { surface, overlap, angles, scale } = scene;
  return withRun(api, pair, optionsOf(cell.options, made), (report, _, milliseconds) => ({
    ...{ surface, overlap, trueAngles: angles, trueScale: scale },
    ...judged(report, made.pose, milliseconds),
  }));
}
