// Runs of other tables, repeated without one per cent of the depth pixels, with a shifted mask, and without a row of the image.
import { random } from "./anywhere.mjs";
import { painted } from "./painted.mjs";
import { pinhole, rgbd } from "./perspectives.mjs";
import { photographs } from "./reals.mjs";
import { statue } from "./statue.mjs";

/** The cells of each kind: those that fit, every n-th of them, up to a maximum. */
const KINDS = [
  { kind: "random", table: random, fits: () => true, every: 25, most: 12 },
  { kind: "painted", table: painted, fits: () => true, every: 10, most: 6 },
  {
    kind: "photographs",
    table: photographs,
    fits: ({ row }) => row.image === "lab_diffuse" && row.beta === 20,
    every: 1,
    most: 10,
  },
  { kind: "rgbd", table: rgbd, fits: ({ off }) => Boolean(off), every: 3, most: 12 },
  { kind: "statue", table: statue, fits: ({ row }) => row.start === "off", every: 1, most: 24 },
  { kind: "pinhole", table: pinhole, fits: ({ off }) => Boolean(off), every: 8, most: 12 },
];

const cellOf = (kind, of) => ({ id: `perturbation/${of.id}`, kind: "perturbed", row: { kind, of: of.id }, of });

export const perturbation = {
  name: "perturbation",
  title:
    "Perturbation: whether a pose moves by less than its sigma without one per cent of the depth pixels, with the mask shifted by a pixel, and without a row of the image",
  cells: (things, quick) =>
    (quick ? KINDS.slice(0, 1) : KINDS).flatMap(({ kind, table, fits, every, most }) =>
      table
        .cells(things, false)
        .filter(fits)
        .filter((_, index) => index % every === 0)
        .slice(0, quick ? 1 : most)
        .map((of) => cellOf(kind, of)),
    ),
  /** One row for each change of a cell. */
  rows: (results) => results.flatMap(({ cell, result }) => result.moves.map((move) => ({ ...cell.row, ...move }))),
};
