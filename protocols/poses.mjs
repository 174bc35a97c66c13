// Tables 1 and 2 and Figure 6: each cell has one pose to find.
import { BETAS, COLOURFUL, FROM_ANYWHERE, NOISE, OVERLAPS, PAPER_TABLE_1, paperTable2 } from "./scenes.mjs";
import { paperError } from "./rotations.mjs";
import { seedOf } from "./numbers.mjs";

/** Side of a view in the paper. */
const SMALL = 32;
const SIZES = [128, 64];
/** The light is known, as the paper requires. */
const TOLD = { ...FROM_ANYWHERE, light: "known", scale: 1 };

/** Both readings of the paper's protocol: "2A" the bare grid, "2B" what a camera sees. */
function table1Cell({ main }, protocol, sign) {
  const view = protocol === "2A" ? { protocol: "grid" } : { size: SMALL };
  return {
    id: `table1/${protocol}/${sign}`,
    kind: "pose",
    row: { protocol, sign, paper: { ...PAPER_TABLE_1, beta: sign * PAPER_TABLE_1.beta } },
    scene: { surface: main, light: COLOURFUL, ...view, angles: { beta: 20 * sign } },
    // The paper also solves for the scale.
    options: { ...TOLD, scale: "free" },
  };
}

export const table1 = {
  name: "table1",
  title: "Table 1: 32x32, beta = 20 degrees, light known, initial pose unknown",
  cells: (kit) => ["2A", "2B"].flatMap((protocol) => [1, -1].map((sign) => table1Cell(kit, protocol, sign))),
};

function table2ACell({ main }, beta, overlap) {
  return {
    id: `table2A/${beta}/${overlap}`,
    kind: "pose",
    row: { beta, overlap, size: SMALL, light: "known", lightName: COLOURFUL, paper: paperTable2(beta, overlap) },
    scene: { surface: main, light: COLOURFUL, protocol: "grid", angles: { beta }, overlap },
    options: TOLD,
  };
}

const QUICK_2A = [
  [20, 0.125],
  [20, 1],
  [60, 0.375],
  [60, 0.75],
  [90, 0.25],
  [90, 1],
];
const everywhere = BETAS.flatMap((beta) => OVERLAPS.map((overlap) => [beta, overlap]));

export const table2A = {
  name: "table2A",
  title: "Table 2A, the paper's easy reading: 32x32 bare grid, no occlusion, light known, initial pose unknown",
  cells: (kit, quick) => (quick ? QUICK_2A : everywhere).map(([beta, overlap]) => table2ACell(kit, beta, overlap)),
};

function table2BCell({ main }, size, lightName, light, beta, overlap) {
  const id = `table2B/${size}/${lightName}/${light}/${beta}/${overlap}`;
  return {
    id,
    kind: "pose",
    bound: true,
    row: { beta, overlap, size, light, lightName, paper: paperTable2(beta, overlap) },
    scene: { surface: main, light: lightName, size, angles: { beta }, overlap, noise: NOISE, seed: seedOf(id) },
    options: { ...TOLD, light: light === "known" ? "known" : "estimate" },
  };
}

const lightsOf = (kit) => [COLOURFUL, ...kit.naturals];

/** A corner of the table at 64x64: light known and unknown, easy and natural, small and large tilt. */
const quick2B = (kit) =>
  [COLOURFUL, kit.naturals[0]].flatMap((lightName) =>
    ["known", "unknown"].flatMap((light) =>
      [20, 60].map((beta) => table2BCell(kit, 64, lightName, light, beta, beta === 20 ? 1 : 0.5)),
    ),
  );

const full2B = (kit) =>
  SIZES.flatMap((size) =>
    lightsOf(kit).flatMap((lightName) =>
      ["known", "unknown"].flatMap((light) =>
        everywhere.map(([beta, overlap]) => table2BCell(kit, size, lightName, light, beta, overlap)),
      ),
    ),
  );

export const table2B = {
  name: "table2B",
  title: "Table 2B, what a camera sees: rendered with occlusion, sigma = 0.01 on log S, initial pose unknown",
  notes: [
    "degrees; paper: its one figure for all of this; bound: Cramer-Rao, one sigma; ? flagged, ! wrong and not flagged",
    "Open3D is the baseline: FPFH, RANSAC, point-to-plane ICP to the surface from shading; it can't start where the light is unknown",
  ],
  cells: (kit, quick) => (quick ? quick2B(kit) : full2B(kit)),
};

/** Figure 6 is a row of Table 2, in the paper's reading and beside it as a camera sees the scene. */
const FIGURE_6_BETA = 40;

export const figure6 = {
  name: "figure6",
  title: `Figure 6: error against overlap at beta = ${FIGURE_6_BETA}`,
  // The same cells as in Table 2, so that they run only once.
  cells: (kit, quick) =>
    (quick ? [0.25, 1] : OVERLAPS).flatMap((overlap) => [
      table2ACell(kit, FIGURE_6_BETA, overlap),
      ...(quick ? [] : [table2BCell(kit, 128, COLOURFUL, "known", FIGURE_6_BETA, overlap)]),
    ]),
  rows: (results) => {
    const camera = results.filter(({ cell }) => cell.id.startsWith("table2B/"));
    return results
      .filter(({ cell }) => cell.id.startsWith("table2A/"))
      .map(({ cell: { row }, result }) => {
        const seen = camera.find((other) => other.cell.row.overlap === row.overlap);
        return {
          overlap: row.overlap,
          error: result.error,
          paper: row.paper,
          rendered: seen ? paperError(seen.result.degrees) : null,
          status: result.status,
        };
      });
  },
};
