// Nothing hangs on a pixel: runs of other tables again with one per cent of the depth left out, the mask a pixel aside, or a row cut off.
import { random } from "./anywhere.mjs";
import { painted } from "./painted.mjs";
import { pinhole, rgbd } from "./perspectives.mjs";
import { photographs } from "./reals.mjs";
import { statue } from "./statue.mjs";

export const CHANGES = ["points", "mask", "row"];
/** What each kind takes: every so many-th of the cells that fit, and so many at most. */
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

const cellOf = (kind, of, change) => ({
  id: `perturbation/${of.id}/${change}`,
  kind: "perturbed",
  row: { kind, of: of.id, change },
  of,
  change,
});

export const perturbation = {
  name: "perturbation",
  title:
    "Perturbation: whether a pose moves by less than its sigma when one per cent of the depth pixels is left out, the mask moves by a pixel, or the image loses a row",
  cells: (things, quick) =>
    (quick ? KINDS.slice(0, 1) : KINDS).flatMap(({ kind, table, fits, every, most }) =>
      table
        .cells(things, false)
        .filter(fits)
        .filter((_, index) => index % every === 0)
        .slice(0, quick ? 1 : most)
        .flatMap((of) => CHANGES.map((change) => cellOf(kind, of, change))),
    ),
};
