/** The layout of each table on the page: the choices above the grid, its rows and columns, and the number in a cell. */

import { cellsOf, paperDegrees, tableNamed, type Cell, type Result } from "./protocol";

export interface Axis {
  label: string;
  of(cell: Cell): string | number;
  /** The text of a header. */
  name(value: string | number): string;
}

/** A key of the rows that is chosen above the grid, because the grid has only two directions. */
export interface Choice {
  key: string;
  label: string;
  name(value: string | number): string;
}

export interface Panel {
  name: string;
  tab: string;
  title: string;
  /** An explanation of what is measured, for a visitor who has not read the paper. */
  words: string;
  choices: readonly Choice[];
  down: Axis;
  across: Axis;
  /** The name of a single cell, if its place in the grid says too little. */
  where?(cell: Cell): string;
  /** The unit of the numbers, and what they measure. */
  unit: string;
  quantity: string;
  value(result: Result): number | undefined;
  /** The paper's own figure for a cell. */
  paper?(cell: Cell): number | undefined;
  /** The curves below the grid: its rows, or each cell's iterations. */
  curves?: "across" | "iterations";
  cells: readonly Cell[];
}

const isNumber = (value: unknown): value is number => typeof value === "number" && Number.isFinite(value);
const plain = (value: string | number): string => String(value);

const byKey = (label: string, key: string, name = plain): Axis => ({
  label,
  of: ({ row }) => {
    const value = row[key];
    return isNumber(value) ? value : String(value);
  },
  name,
});

const degrees = ({ degrees }: Result): number | undefined => degrees;
const paperOfTable2 = ({ row }: Cell): number | undefined =>
  isNumber(row.paper) ? paperDegrees(row.paper) : undefined;
/** The last line of a result that has more than one. */
const atTheEnd = ({ iterations }: Result): number | undefined => {
  const last: unknown = Array.isArray(iterations) ? iterations.at(-1) : undefined;
  return typeof last === "object" && last !== null && "degrees" in last && isNumber(last.degrees)
    ? last.degrees
    : undefined;
};

const beta = byKey("β", "beta", (value) => `${value}°`);
const overlap = byKey("overlap", "overlap");
const light: Choice = { key: "lightName", label: "Light", name: plain };
const side: Choice = { key: "size", label: "Size", name: (value) => `${value} × ${value}` };
const COLUMNS = 10;

type Layout = Omit<Panel, "title" | "cells" | "value" | "unit" | "quantity" | "choices"> &
  Partial<Pick<Panel, "value" | "unit" | "quantity" | "choices">>;

/** Titles are the protocol's; they begin with the name that the tab already shows. */
function panel(layout: Layout): Panel {
  const title = tableNamed(layout.name).title.replace(/^[^:]+?: /, "");
  return {
    value: degrees,
    unit: "°",
    quantity: "error of the rotation",
    choices: [],
    ...layout,
    title,
    cells: cellsOf(layout.name),
  };
}

export const panels: readonly Panel[] = [
  panel({
    name: "table1",
    tab: "Table 1",
    words:
      "The paper rotates its bust by 20 degrees and solves for scale and angles. Shown for both signs, because conventions differ, and both for exact points (2A) and for views rendered as a camera sees them (2B).",
    down: byKey("protocol", "protocol"),
    across: byKey("β", "sign", (sign) => (Number(sign) > 0 ? "+20°" : "−20°")),
    paper: ({ row }) =>
      typeof row.paper === "object" && row.paper !== null && "degrees" in row.paper && isNumber(row.paper.degrees)
        ? row.paper.degrees
        : undefined,
  }),
  panel({
    name: "table2A",
    tab: "Table 2A",
    words:
      "The same points in both views (the overlap is the paper's P_w), without occlusion, resampling or noise. An exact answer exists, and the remaining error should be rounding.",
    down: beta,
    across: overlap,
    paper: paperOfTable2,
  }),
  panel({
    name: "table2B",
    tab: "Table 2B",
    words:
      "Both views rendered as cameras see them, with one per cent noise on the colours. The initial pose is unknown; the light is given or estimated.",
    choices: [side, { key: "light", label: "Light is", name: plain }, light],
    down: beta,
    across: overlap,
    paper: paperOfTable2,
  }),
  panel({
    name: "figure4",
    tab: "Figure 4",
    words:
      "The runs of Table 1, iteration by iteration: with the search over poses, and with the paper's stages from the paper's initial pose.",
    down: byKey("run", "run"),
    across: byKey("protocol", "protocol"),
    value: atTheEnd,
    quantity: "error of the rotation at the end",
    curves: "iterations",
  }),
  panel({
    name: "figure5",
    tab: "Figure 5",
    words:
      "Error of the normals from shading when the true normal is given for a share P_er of the pixels. Pose and light are known. Solved pixel by pixel, as in the paper, or for the whole surface.",
    choices: [side, light],
    down: byKey("shading", "shading"),
    across: byKey("share", "fraction"),
    quantity: "mean error of the normals",
    curves: "across",
  }),
  panel({
    name: "figure6",
    tab: "Figure 6",
    words:
      "One row of Table 2: the error falls as the views overlap more. The cells are those of Tables 2A and 2B (128 × 128, colourful light, known); a cell that has run there is also done here.",
    down: { label: "protocol", of: ({ id }) => (id.startsWith("table2A/") ? "2A" : "2B"), name: plain },
    across: overlap,
    paper: paperOfTable2,
    curves: "across",
  }),
  panel({
    name: "refinement",
    tab: "Refinement",
    words:
      "A depth map with half a pixel of noise and with holes, refined by the colours. Five draws of the noise for each light, with the pose given and with the pose estimated.",
    down: { label: "light, pose", of: ({ row }) => `${row.lightName}, ${row.pose}`, name: plain },
    across: byKey("draw", "seed"),
    where: ({ row }) => `${row.lightName} light, pose ${row.pose}, draw ${row.seed}`,
    value: ({ after }) => (isNumber(after) ? after : undefined),
    unit: " px",
    quantity: "remaining error of the depth",
  }),
  panel({
    name: "random",
    tab: "Random",
    words:
      "Surface, light, pose and scale drawn at random, with nothing known. All 300 take about 15 minutes; a single row of ten is already informative.",
    down: {
      label: "scenes",
      of: ({ row }) => COLUMNS * Math.floor((Number(row.scene) - 1) / COLUMNS) + 1,
      name: (first) => `${first}–${Number(first) + COLUMNS - 1}`,
    },
    where: ({ row }) => `scene ${row.scene}`,
    across: { label: "", of: ({ row }) => ((Number(row.scene) - 1) % COLUMNS) + 1, name: plain },
  }),
  panel({
    name: "exposure",
    tab: "Exposure",
    words:
      "The exposure is the photographer's choice and must not affect the result. Random scenes with all colours made darker or brighter.",
    down: byKey("scene", "scene"),
    across: { label: "colours", of: ({ exposure = 1 }) => exposure, name: (factor) => `× ${factor}` },
  }),
  panel({
    name: "ablation",
    tab: "Ablation",
    words: "What each part of the method contributes: the first random scenes, solved without it.",
    down: byKey("scene", "scene"),
    across: { label: "without", of: ({ row }) => String(row.without ?? "nothing"), name: plain },
  }),
];

/** Tables that need third-party recordings, which the page does not have. */
export const elsewhere: readonly string[] = ["table3", "figure7", "sensors", "photographs", "albedo", "rgbd"].map(
  (name) => tableNamed(name).title,
);
