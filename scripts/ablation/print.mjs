// The contribution of each part, as text and as a table of docs/lab/results.md.
import { columns, fixed, mark } from "../tables/columns.mjs";
import { isConfidentlyWrong, isFound } from "../../protocols/counts.mjs";
import { median, worst } from "../../protocols/numbers.mjs";

/** Change of a cell above which a part counts as helpful or harmful, degrees: a tenth of the limit for a found pose. */
const MATTERS = 0.3;

const degreesOf = (row) => (row ? `${fixed(row.degrees, row.degrees < 9.95 ? 1 : 0)}${mark(row)}` : "-");
const known = (rows) => rows.filter((row) => typeof row?.degrees === "number");
const medianOf = (rows) => median(known(rows).map(({ degrees }) => degrees));
const ratio = (rows, is) => `${known(rows).filter(is).length} of ${known(rows).length}`;

/** Rows of a variant by their cell. */
const byId = ({ rows }) => new Map(rows.map((row) => [row.id, row]));

/** The lines below a set: label, and the text for a variant's rows. */
const FOOT = [
  ["median", (rows) => fixed(medianOf(rows), 2)],
  ["worst", (rows) => fixed(worst(known(rows).map(({ degrees }) => degrees)), 1)],
  ["under 3 degrees", (rows) => ratio(rows, isFound)],
  ["confidently wrong", (rows) => ratio(rows, isConfidentlyWrong)],
];

const whole = (show) => (rows) => (known(rows).length === rows.length ? show(rows) : "-");

const kilobytes = (bytes) => (bytes / 1000).toFixed(1).replace(/^-(?=0\.0$)/, "");

/** The lines and footers of each set, and the sizes, with one column for each variant. */
export function rowsOf(sets, variants) {
  const found = variants.map(byId);
  const of = (lines) => found.map((rows) => lines.flatMap(({ ids }) => ids.map((id) => rows.get(id))));
  const blocks = sets.map(({ set, lines }) => ({
    set,
    lines: lines.map(({ name, ids }) => [
      name,
      ...found.map((rows) => ids.map((id) => degreesOf(rows.get(id))).join(" ")),
    ]),
    foot: FOOT.map(([word, show]) => [`${set}: ${word}`, ...of(lines).map(whole(show))]),
  }));
  const [all] = variants;
  const sizes = [
    ".wasm gzipped, kB",
    ...variants.map(({ gzipped }, at) => (at === 0 ? kilobytes(gzipped) : kilobytes(gzipped - all.gzipped))),
  ];
  return {
    head: ["degrees, without:", ...variants.map(({ part }, at) => (at === 0 ? "(all parts)" : part))],
    blocks,
    sizes,
  };
}

/** Numbers of cells that a part makes worse and better. Cells whose pose is wrong with and without the part are not counted. */
export function effects(all, { part, rows }) {
  const off = new Map(rows.map((row) => [row.id, row]));
  const pairs = known(all.rows).map((row) => ({ id: row.id, on: row, off: off.get(row.id) }));
  const both = pairs.filter(({ on, off }) => known([off]).length > 0 && (isFound(on) || isFound(off)));
  const worse = both.filter((pair) => pair.on.degrees > pair.off.degrees + MATTERS);
  const better = both.filter((pair) => pair.off.degrees > pair.on.degrees + MATTERS);
  return { part, worse, better };
}

const moved = ({ id, on, off }) => `${id} ${degreesOf(off)} -> ${degreesOf(on)}`;

export function text(sets, variants) {
  const { head, blocks, sizes } = rowsOf(sets, variants);
  const [all, ...others] = variants;
  const lists = others
    .map((variant) => effects(all, variant))
    .flatMap(({ part, worse, better }) => [
      `  ${part}: better ${better.length}, worse ${worse.length}${worse.length > 0 ? ":" : ""}`,
      ...worse.map((pair) => `    ${moved(pair)}`),
    ]);
  return [
    "Degrees off: with all parts, and with one part off each; ? flagged, ! over 3 degrees and not flagged",
    ...columns([head, ...blocks.flatMap(({ lines, foot }) => [...lines, ...foot, head.map(() => "")]), sizes]),
    "",
    `Worse with the part than without, by over ${MATTERS} degrees (without -> with)`,
    ...lists,
  ];
}

/** The table as Markdown: photographs line by line, the other sets by their footers. */
export function markdown(sets, variants) {
  const { head, blocks, sizes } = rowsOf(sets, variants);
  const [all, ...others] = variants;
  const line = (cells) => `| ${cells.join(" | ")} |`;
  const lines = blocks.flatMap(({ set, lines, foot }) => [
    ...(set === "photographs" ? lines : []),
    ...foot.slice(0, set === "photographs" ? FOOT.length : 3),
  ]);
  const lists = others
    .map((variant) => effects(all, variant))
    .map(
      ({ part, worse, better }) =>
        `- ${part}: better ${better.length}; worse ${worse.length === 0 ? "none" : worse.map(moved).join(", ")}`,
    );
  return [
    ...[line(head), `|---|${variants.map(() => "---").join("|")}|`, ...[...lines, sizes].map(line)],
    ...[
      "",
      `Cells that a part makes better or worse by over ${MATTERS} degrees (without the part -> with it):`,
      "",
      ...lists,
    ],
  ];
}
