/** The rows of a table as the command writes them, if they contain more than the grid can show. */

import { short } from "../draw/numbers";
import { make } from "../dom";
import { rowsOf, type Cell, type Done, type Row } from "./protocol";

type Column = readonly [key: string, heading: string];

const share: readonly Column[] = [
  ["cases", "scenes"],
  ["found", "found"],
  ["ambiguousOrLost", "flagged"],
];

const columns: Record<string, readonly Column[]> = {
  table1: [
    ["protocol", "protocol"],
    ["sign", "sign"],
    ["scale", "s"],
    ["alpha", "α"],
    ["beta", "β"],
    ["gamma", "γ"],
    ["iterations", "iterations"],
    ["degrees", "degrees"],
  ],
  refinement: [
    ["lightName", "light"],
    ["pose", "pose"],
    ["before", "px before"],
    ["after", "after"],
    ["holes", "in former holes"],
    ["gain", "gain"],
    ["degrees", "degrees"],
  ],
  random: [
    ...share,
    ["flaggedThoughFound", "found but flagged"],
    ["confidentlyWrong", "wrong, not flagged"],
    ["medianDegrees", "median degrees"],
    ["coverage1", "within 1 σ"],
    ["coverage3", "within 3 σ"],
  ],
  exposure: [
    ["scene", "scene"],
    ["factor", "colours ×"],
    ["degreesMoved", "degrees moved"],
    ["degrees", "degrees off"],
    ["status", "status"],
  ],
  ablation: [
    ["without", "without"],
    ["cases", "scenes"],
    ["found", "found"],
    ["confidentlyWrong", "wrong, not flagged"],
    ["medianDegrees", "median degrees"],
  ],
};

function shown(value: unknown): string {
  if (typeof value === "number") return (Number.isInteger(value) ? String(value) : short(value)).replace(/^-/, "−");
  return typeof value === "string" ? value : "–";
}

/** The paper's figures as a first line, if the cells have them. */
function paperRow(name: string, [first]: readonly { cell: Cell }[]): Row[] {
  const paper = first?.cell.row.paper;
  return name === "table1" && typeof paper === "object" && paper !== null
    ? [{ ...paper, protocol: "the paper", sign: first?.cell.row.sign }]
    : [];
}

export function rowsTable(name: string, done: Done): HTMLElement[] {
  const wanted = columns[name];
  if (!wanted || done.length === 0) return [];
  const rows = [...paperRow(name, done), ...[rowsOf(name, done)].flat()];
  const head = make("tr", {}, ...wanted.map(([, heading]) => make("th", { scope: "col" }, heading)));
  const body = rows.map((row) => make("tr", {}, ...wanted.map(([key]) => make("td", {}, shown(row[key])))));
  return [
    make(
      "div",
      { class: "wide-box", tabindex: 0, role: "region", "aria-label": "Rows" },
      make("table", { class: "rows" }, make("thead", {}, head), make("tbody", {}, ...body)),
    ),
  ];
}
