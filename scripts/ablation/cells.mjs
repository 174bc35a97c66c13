// The cells of the tables that every variant runs, by name.
import { TABLES } from "../../protocols/index.mjs";
import { PAINTED } from "../../protocols/scenes.mjs";

const numbers = (count) => Array.from({ length: count }, (_, index) => index + 1);

/** Lines of a set, each with its cells. */
const SETS = [
  {
    set: "photographs",
    lines: PAINTED.map((name) => ({ name, ids: [20, 40].map((beta) => `photographs/${name}/lab_diffuse/${beta}`) })),
    quick: 2,
  },
  {
    set: "renders of them",
    lines: PAINTED.map((name) => ({ name: `${name}, render`, ids: [`photographs/${name}/render/40`] })),
    quick: 0,
  },
  {
    set: "painted renders",
    lines: numbers(8).map((scene) => ({ name: `painted ${scene}`, ids: [`painted/${scene}`] })),
    quick: 1,
  },
  {
    set: "plain renders",
    lines: numbers(8).map((scene) => ({ name: `random ${scene}`, ids: [`random/${scene}`] })),
    quick: 1,
  },
  {
    // Even cells of `stress`; constants were set on the odd ones.
    set: "noisy depth",
    lines: [
      ...[2, 4, 6].map((scene) => ({ name: `stress ${scene}`, ids: [`stress/${scene}`] })),
      ...[1, 2].map((scene) => ({ name: `pinhole ${scene}`, ids: [`pinhole/${scene}/search`] })),
    ],
    quick: 0,
  },
];

/** The sets with their lines; without the data beside the project, only those of built-in scenes. */
export const sets = (quick, complete) =>
  SETS.map(({ set, lines, quick: few }) => ({ set, lines: quick ? lines.slice(0, few) : lines }))
    .map(({ set, lines }) => ({
      set,
      lines: complete ? lines : lines.filter(({ ids }) => /^(painted|random|pinhole)/.test(ids[0])),
    }))
    .filter(({ lines }) => lines.length > 0);

/** The cells as a separate table, which runs like the others. */
export const table = (chosen) => ({
  name: "parts",
  cells(kit) {
    const ids = chosen.flatMap(({ lines }) => lines.flatMap((line) => line.ids));
    const cells = new Map(TABLES.flatMap((one) => one.cells(kit, false)).map((cell) => [cell.id, cell]));
    const missing = ids.find((id) => !cells.has(id));
    if (missing) throw new Error(`no table has the cell ${missing}`);
    return ids.map((id) => cells.get(id));
  },
  rows: (results) =>
    results.map(({ cell, result: { degrees, status, rivals, milliseconds } }) => ({
      id: cell.id,
      degrees,
      status,
      rivals,
      milliseconds,
    })),
});
