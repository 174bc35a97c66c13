// Figures 4 and 5 and the refinement: the errors of normals and depth.
import { COLOURFUL, FROM_ANYWHERE, NOISE } from "./scenes.mjs";
import { mean } from "./numbers.mjs";

const KNOWN = { ...FROM_ANYWHERE, light: "known", scale: 1 };

/** Table 1's run, and the paper's own stages on the same views from the paper's initial pose. */
const RUNS = [
  { run: "search", protocol: "2A", options: KNOWN },
  { run: "search", protocol: "2B", options: KNOWN },
  { run: "paper", protocol: "2B", options: { ...KNOWN, start: "identity", registration: "icp", shading: "pixel" } },
];

export const figure4 = {
  name: "figure4",
  title: "Figure 4: Table 1's run, iteration by iteration",
  cells: ({ main }) =>
    RUNS.map(({ run, protocol, options }) => ({
      id: `figure4/${run}/${protocol}`,
      kind: "iterations",
      row: { run, protocol },
      scene: {
        surface: main,
        light: COLOURFUL,
        ...(protocol === "2A" ? { protocol: "grid" } : { size: 32 }),
        angles: { beta: 20 },
      },
      options,
    })),
  rows: (results) =>
    results.flatMap(({ cell, result }) =>
      (result.iterations ?? []).map((iteration) => ({ ...cell.row, ...iteration })),
    ),
};

/** Shares of the pixels with the true normal: the paper's P_er. */
const FRACTIONS = [0, 0.2, 0.4, 0.6, 0.8, 1];
const SHADING_NOISE = 0.02;

const figure5Cell = (surface, size, lightName, shading, fraction) => ({
  id: `figure5/${size}/${lightName}/${shading}/${fraction}`,
  kind: "shading",
  row: { size, lightName, shading, fraction },
  // One scene, one noise and one order of the pixels for each size and light, so that only the fraction changes.
  scene: { surface, light: lightName, size, angles: {}, noise: SHADING_NOISE, seed: 5 },
  fraction,
  options: { ...KNOWN, registration: "fixed", shading },
});

export const figure5 = {
  name: "figure5",
  title:
    "Figure 5: error of the normals against the share of pixels with a true prior; pose and light known, sigma = 0.02",
  cells: ({ main, naturals }, quick) =>
    (quick ? [32] : [32, 64]).flatMap((size) =>
      (quick ? naturals.slice(0, 1) : naturals).flatMap((lightName) =>
        ["pixel", "surface"].flatMap((shading) =>
          FRACTIONS.map((fraction) => figure5Cell(main, size, lightName, shading, fraction)),
        ),
      ),
    ),
};

/** Seeds to average over (docs/lab/protocols.md), because a single draw shows its noise as much as the method. */
const REFINEMENT_SEEDS = [1, 2, 3, 4, 5];
const DEPTH_NOISE = 0.5;
const HOLES = 0.1;

const refinementCell = (surface, lightName, pose, seed) => ({
  id: `refinement/${lightName}/${pose}/${seed}`,
  kind: "refinement",
  row: { lightName, pose, seed },
  scene: {
    surface,
    light: lightName,
    size: 64,
    angles: {},
    depthNoise: DEPTH_NOISE,
    holes: HOLES,
    noise: 2 * NOISE,
    seed,
  },
  options: pose === "fixed" ? { ...KNOWN, start: "truth", registration: "fixed" } : KNOWN,
});

export const refinement = {
  name: "refinement",
  title: "Refinement: 64x64, 0.5 px noise and 10 % holes in the depth, sigma = 0.02 on log S, light known",
  cells: ({ main, naturals }, quick) =>
    [COLOURFUL, ...(quick ? naturals.slice(0, 1) : naturals)].flatMap((lightName) =>
      ["fixed", "estimated"].flatMap((pose) =>
        (quick ? [1] : REFINEMENT_SEEDS).map((seed) => refinementCell(main, lightName, pose, seed)),
      ),
    ),
  /** Root mean squares over all seeds, for each light with the pose known or estimated. */
  rows: (results) => {
    const groups = grouped(results, ({ cell }) => `${cell.row.lightName}/${cell.row.pose}`);
    return [...groups.values()].map((members) => {
      const [
        {
          cell: { row },
        },
      ] = members;
      const over = (key) => Math.sqrt(mean(members.map(({ result }) => result[key] ** 2)));
      const [before, after, holes] = [over("before"), over("after"), over("holes")];
      const degrees = mean(members.map(({ result }) => result.degrees));
      const statuses = members.map(({ result }) => result.status);
      return {
        lightName: row.lightName,
        pose: row.pose,
        before,
        after,
        holes,
        gain: before / after,
        degrees,
        statuses,
      };
    });
  },
};

/** Like `Map.groupBy`, which Node 20 lacks. */
function grouped(items, keyOf) {
  const groups = new Map();
  for (const item of items) groups.set(keyOf(item), [...(groups.get(keyOf(item)) ?? []), item]);
  return groups;
}
