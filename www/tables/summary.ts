/** The summary of the finished cells: the rows and aims of the command, computed by the command's modules. */

import { short } from "../draw/numbers";
import { make } from "../dom";
import type { Panel } from "./panels";
import { rowsTable } from "./rows";
import { aimsOf, isFlagged, isFound, median, worst, type Aim, type Done } from "./protocol";

const number = (value: unknown): string => (typeof value === "number" && Number.isFinite(value) ? short(value) : "–");

export function summary(panel: Panel, done: Done): HTMLElement[] {
  if (done.length === 0) return [];
  return [overview(panel, done), ...rowsTable(panel.name, done), ...aims(panel, done)];
}

function overview(panel: Panel, done: Done): HTMLElement {
  const values = done.flatMap(({ result }) => panel.value(result) ?? []);
  const posed = done.filter(({ result }) => "rivals" in result).map(({ result }) => result);
  const words = [
    `Of ${done.length} done: median ${number(median(values))}${panel.unit}, worst ${number(worst(values))}${panel.unit}`,
    ...(posed.length > 0
      ? [
          `${posed.filter(isFound).length} of ${posed.length} poses found within 3°`,
          `${posed.filter(isFlagged).length} flagged as uncertain`,
        ]
      : []),
  ];
  return make("p", {}, `${words.join("; ")}.`);
}

/** The aims refer to whole tables, so each states the number of rows behind its figure. */
function aims(panel: Panel, done: Done): HTMLElement[] {
  const list = aimsOf(panel.name, done).filter(({ rows }) => rows > 0);
  if (list.length === 0) return [];
  const row = ({ what, measured, sense, limit, rows, ok }: Aim) =>
    make(
      "tr",
      {},
      make("th", { scope: "row" }, what),
      make("td", {}, String(rows)),
      make("td", {}, number(measured)),
      make("td", {}, `${sense === "<=" ? "≤" : "≥"} ${limit}`),
      make("td", { class: ok === false ? "missed" : "" }, ok === null ? "–" : ok ? "✓ reached" : "✗ missed"),
    );
  const head = ["Aim", "Rows", "Measured", "Limit", ""].map((word) => make("th", { scope: "col" }, word));
  return [
    make(
      "details",
      { class: "aims" },
      make("summary", {}, "The project's aims for this table"),
      make(
        "p",
        { class: "soft" },
        "The aims are set for the paper's surface and for complete tables. Here they are computed from the finished cells, on the built-in bust.",
      ),
      make(
        "div",
        { class: "wide-box", tabindex: 0, role: "region", "aria-label": "Aims" },
        make(
          "table",
          { class: "rows" },
          make("thead", {}, make("tr", {}, ...head)),
          make("tbody", {}, ...list.map(row)),
        ),
      ),
    ),
  ];
}
